"""Scenes and devices in several processes: what each runs, what carries the waves, what is seen of it."""

from zwidth.lazy import attach

__getattr__, __dir__, __all__ = attach(__name__)
