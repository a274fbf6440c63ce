"""What the hand holds: inertia, friction, encoder, sampling, amplifier."""

from zwidth.model.device import catalogue
from zwidth.model.device.amplifier import ActuatorCheck, actuator_checks
from zwidth.model.device.device import Device
from zwidth.model.device.friction import FrictionCurve, FrictionModel

__all__ = ["ActuatorCheck", "Device", "FrictionCurve", "FrictionModel", "actuator_checks", "catalogue"]
