"""A served loop in a file: written while it runs, read back, whole or cut off, and simulated again."""

from zwidth.lazy import attach

__getattr__, __dir__, __all__ = attach(__name__)
