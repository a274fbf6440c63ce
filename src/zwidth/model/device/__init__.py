"""What the hand holds: inertia, friction, encoder, sampling, amplifier."""

from zwidth.model.device import catalogue
from zwidth.model.device.amplifier import ActuatorCheck, actuator_checks
from zwidth.model.device.device import Device, in_one, require_rigid
from zwidth.model.device.friction import FrictionCurve, FrictionModel
from zwidth.model.device.transmission import Transmission

__all__ = [
    "ActuatorCheck",
    "Device",
    "FrictionCurve",
    "FrictionModel",
    "Transmission",
    "actuator_checks",
    "catalogue",
    "in_one",
    "require_rigid",
]
