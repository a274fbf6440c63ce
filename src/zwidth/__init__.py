"""Which virtual walls a haptic device can render without generating energy, proved."""

from zwidth.device import Device, FrictionCurve, FrictionModel, catalogue
from zwidth.device.rotary import rotary
from zwidth.environment import (
    BackwardDifference,
    GeneralizedMaxwell,
    Maxwell,
    OnePole,
    StandardLinearSolid,
    VelocityFilter,
    Wall,
    Window,
)
from zwidth.errors import InputError
from zwidth.quantity import Exact, Interval

__all__ = [
    "BackwardDifference",
    "Device",
    "Exact",
    "FrictionCurve",
    "FrictionModel",
    "GeneralizedMaxwell",
    "InputError",
    "Interval",
    "Maxwell",
    "OnePole",
    "StandardLinearSolid",
    "VelocityFilter",
    "Wall",
    "Window",
    "catalogue",
    "rotary",
]
