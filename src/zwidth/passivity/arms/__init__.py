"""Devices with several joints: what damping a wall needs, what damping the joints give."""

from zwidth.passivity.arms.encoders import EncoderSteps
from zwidth.passivity.arms.joints import (
    end_effector_damping,
    end_effector_friction,
    end_effector_inertia,
    end_effector_resolution,
    joint_margin,
    sampled_jacobian_damping,
)
from zwidth.passivity.arms.least import least_additions
from zwidth.passivity.arms.motion import ArmMotion
from zwidth.passivity.arms.need import WallNeed, damping_at, wall_need
from zwidth.passivity.arms.region import workspace
from zwidth.passivity.arms.verdict import Workspace

__all__ = [
    "ArmMotion",
    "EncoderSteps",
    "WallNeed",
    "Workspace",
    "damping_at",
    "end_effector_damping",
    "end_effector_friction",
    "end_effector_inertia",
    "end_effector_resolution",
    "joint_margin",
    "least_additions",
    "sampled_jacobian_damping",
    "wall_need",
    "workspace",
]
