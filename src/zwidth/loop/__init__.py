"""The loop, closed in time: sampling, hold, delay and the exact motion between force changes."""

from zwidth.lazy import attach

__getattr__, __dir__, __all__ = attach(__name__)
