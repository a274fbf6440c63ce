"""Devices with several joints: how the joints move the point that the hand holds."""

from zwidth.device.arm.arm import Arm, Sites
from zwidth.device.arm.builtin import BUILT_IN, built_in
from zwidth.device.arm.chain import PlanarChain
from zwidth.device.arm.described import DescribedArm, read_arm
from zwidth.device.arm.legs import Leg, LeggedArm

__all__ = [
    "BUILT_IN",
    "Arm",
    "DescribedArm",
    "Leg",
    "LeggedArm",
    "PlanarChain",
    "Sites",
    "built_in",
    "read_arm",
]
