"""What the hand holds: inertia, friction, encoder, sampling, amplifier."""

from zwidth.device.device import Device

__all__ = ["Device"]
