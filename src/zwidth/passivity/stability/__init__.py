"""Stable with which hands: a hand that is known, slopes within a sector, hands of bounded activity."""

from zwidth.lazy import attach

__getattr__, __dir__, __all__ = attach(__name__)
