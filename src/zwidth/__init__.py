"""Which virtual walls a haptic device can render without generating energy, proved."""

from zwidth.device import Device, FrictionCurve, FrictionModel, catalogue
from zwidth.device.rotary import rotary
from zwidth.environment import (
    BackwardDifference,
    ContinuousTransferFunction,
    GeneralizedMaxwell,
    Maxwell,
    OnePole,
    PulseTransferFunction,
    StandardLinearSolid,
    VelocityFilter,
    Wall,
    Window,
)
from zwidth.errors import InputError
from zwidth.passivity import Certificate, Verdict, Witness, check, closed_forms, quantization
from zwidth.quantity import Exact, Interval
from zwidth.rendering import VirtualCoupling

__all__ = [
    "BackwardDifference",
    "Certificate",
    "ContinuousTransferFunction",
    "Device",
    "Exact",
    "FrictionCurve",
    "FrictionModel",
    "GeneralizedMaxwell",
    "InputError",
    "Interval",
    "Maxwell",
    "OnePole",
    "PulseTransferFunction",
    "StandardLinearSolid",
    "VelocityFilter",
    "Verdict",
    "VirtualCoupling",
    "Wall",
    "Window",
    "Witness",
    "catalogue",
    "check",
    "closed_forms",
    "quantization",
    "rotary",
]
