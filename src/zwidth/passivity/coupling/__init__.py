"""Virtual coupling as a two-port, and loop transformations."""

from zwidth.lazy import attach

__getattr__, __dir__, __all__ = attach(__name__)
