"""How the joints of a device move the point, or the frame, that the hand holds."""

from zwidth.model.arms.kinematics.arm import Arm, Sites
from zwidth.model.arms.kinematics.builtin import BUILT_IN, built_in
from zwidth.model.arms.kinematics.chain import PlanarChain
from zwidth.model.arms.kinematics.described import DescribedArm
from zwidth.model.arms.kinematics.legs import Leg, LeggedArm
from zwidth.model.arms.kinematics.posed import PosedArm
from zwidth.model.arms.kinematics.reading import read_arm

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
