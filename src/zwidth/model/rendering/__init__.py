"""The laws between the hand and what it meets: virtual coupling, and laws in a chain."""

from zwidth.lazy import attach

__getattr__, __dir__, __all__ = attach(__name__)
