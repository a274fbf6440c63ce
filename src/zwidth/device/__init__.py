"""What the hand holds: inertia, friction, encoder, sampling, amplifier."""

from zwidth.device import catalogue
from zwidth.device.device import Device

__all__ = ["Device", "catalogue"]
