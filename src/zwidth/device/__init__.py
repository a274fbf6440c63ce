"""What the hand holds: inertia, friction, encoder, sampling, amplifier."""

from zwidth.device import catalogue
from zwidth.device.actuator import ActuatorCheck, actuator_checks
from zwidth.device.device import Device
from zwidth.device.friction import FrictionCurve, FrictionModel

__all__ = ["ActuatorCheck", "Device", "FrictionCurve", "FrictionModel", "actuator_checks", "catalogue"]
