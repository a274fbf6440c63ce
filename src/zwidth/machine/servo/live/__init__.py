"""A served loop while it runs: in the terminal, in the browser, in Foxglove."""

from zwidth.lazy import attach

__getattr__, __dir__, __all__ = attach(__name__)
