"""Virtual worlds of masses, springs, dampers, contacts and levers that never give out energy of their own."""

from zwidth.lazy import attach

__getattr__, __dir__, __all__ = attach(__name__)
