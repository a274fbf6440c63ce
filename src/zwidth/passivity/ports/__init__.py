"""Passivity of ports, of one axis and of several: certificates, motions, indices."""

from zwidth.lazy import attach

__getattr__, __dir__, __all__ = attach(__name__)
