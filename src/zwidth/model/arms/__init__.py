"""Devices with several joints: how they move the hand, what a wall asks of the joints, and encoders."""

from zwidth.model.arms.encoders import EncoderSteps
from zwidth.model.arms.joints import (
    end_effector_damping,
    end_effector_friction,
    end_effector_inertia,
    end_effector_resolution,
    joint_margin,
    sampled_jacobian_damping,
)
from zwidth.model.arms.kinematics import (
    BUILT_IN,
    Arm,
    DescribedArm,
    Leg,
    LeggedArm,
    PlanarChain,
    PosedArm,
    Sites,
    built_in,
    read_arm,
)
from zwidth.model.arms.least import least_additions
from zwidth.model.arms.matrix_wall import MatrixWall
from zwidth.model.arms.motion import ArmMotion
from zwidth.model.arms.need import WallNeed, damping_at, wall_need

__all__ = [
    "BUILT_IN",
    "Arm",
    "ArmMotion",
    "DescribedArm",
    "EncoderSteps",
    "Leg",
    "LeggedArm",
    "MatrixWall",
    "PlanarChain",
    "PosedArm",
    "Sites",
    "WallNeed",
    "built_in",
    "damping_at",
    "end_effector_damping",
    "end_effector_friction",
    "end_effector_inertia",
    "end_effector_resolution",
    "joint_margin",
    "least_additions",
    "read_arm",
    "sampled_jacobian_damping",
    "wall_need",
]
