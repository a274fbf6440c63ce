"""Loops in time beyond `zwidth.simulate`: pairs, admittance, many at once, a device of software."""

from zwidth.lazy import attach

__getattr__, __dir__, __all__ = attach(__name__)
