"""Ports between a device and a link that delays, loses and reorders packets."""

from zwidth.lazy import attach

__getattr__, __dir__, __all__ = attach(__name__)
