"""The operator: the hand that moves the device."""

from zwidth.lazy import attach

__getattr__, __dir__, __all__ = attach(__name__)
