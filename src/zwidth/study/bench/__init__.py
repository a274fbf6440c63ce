"""Rendering laws on one bench: the same touches, the same adversary, the same scores."""

from zwidth.lazy import attach

__getattr__, __dir__, __all__ = attach(__name__)
