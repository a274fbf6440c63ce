"""Which virtual walls a haptic device can render without generating energy, proved."""

from zwidth.device import Device
from zwidth.environment import BackwardDifference, OnePole, VelocityFilter, Wall, Window
from zwidth.errors import InputError
from zwidth.quantity import Exact, Interval

__all__ = [
    "BackwardDifference",
    "Device",
    "Exact",
    "InputError",
    "Interval",
    "OnePole",
    "VelocityFilter",
    "Wall",
    "Window",
]
