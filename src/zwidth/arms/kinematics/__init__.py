"""How the joints of a device move the point, or the frame, that the hand holds."""

from zwidth.arms.kinematics.arm import Arm, Sites
from zwidth.arms.kinematics.builtin import BUILT_IN, built_in
from zwidth.arms.kinematics.chain import PlanarChain
from zwidth.arms.kinematics.described import DescribedArm
from zwidth.arms.kinematics.legs import Leg, LeggedArm
from zwidth.arms.kinematics.posed import PosedArm
from zwidth.arms.kinematics.reading import read_arm

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
