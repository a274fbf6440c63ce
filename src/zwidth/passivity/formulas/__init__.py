"""Closed forms: bounds of springs, counts and delays, and the (β, σ) plane."""

from zwidth.lazy import attach

__getattr__, __dir__, __all__ = attach(__name__)
