"""Devices with several joints: how they move the hand, what a wall asks of the joints, and encoders."""

from zwidth.lazy import attach

__getattr__, __dir__, __all__ = attach(__name__)
