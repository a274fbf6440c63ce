"""Devices with several joints: how the joints move the point, or the frame, that the hand holds."""

from zwidth.device.arm.arm import Arm, Sites
from zwidth.device.arm.builtin import BUILT_IN, built_in
from zwidth.device.arm.chain import PlanarChain
from zwidth.device.arm.described import DescribedArm
from zwidth.device.arm.legs import Leg, LeggedArm
from zwidth.device.arm.posed import PosedArm
from zwidth.device.arm.reading import read_arm

__all__ = [
    "BUILT_IN",
    "Arm",
    "DescribedArm",
    "Leg",
    "LeggedArm",
    "PlanarChain",
    "PosedArm",
    "Sites",
    "built_in",
    "read_arm",
]
