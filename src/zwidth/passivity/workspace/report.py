"""What a verdict on an arm holds, part by part as plain data, every key with its unit."""

from __future__ import annotations

from math import isfinite
from typing import Any

from zwidth.model.arms import Arm, DescribedArm
from zwidth.model.arms.arm import ArmMotion
from zwidth.model.arms.encoders import EncoderSteps
from zwidth.model.arms.wall import MatrixWall, wall_matrices
from zwidth.model.environment.wall import Wall
from zwidth.passivity.workspace.additions import Additions


def arm_document(arm: Arm) -> dict[str, Any]:
    """Its name, and what is to be known of damping that a description gave."""
    source = arm.damping_source if isinstance(arm, DescribedArm) else ""
    return {"arm": arm.name, **({"joint_damping_source": source} if source else {})}


def wall_document(wall: Wall | MatrixWall, coordinates: int, turns: int) -> dict[str, Any]:
    """Its matrices; of a hand with turns each has two units."""
    k, b = wall_matrices(wall, coordinates)
    keys = ("stiffness_N_m_rad", "virtual_damping_N_m_s_rad") if turns else (
        "stiffness_N_per_m", "virtual_damping_N_s_per_m"
    )  # fmt: skip
    return dict(zip(keys, (k.tolist(), b.tolist()), strict=True))


def steps_document(steps: EncoderSteps, turns: int) -> dict[str, Any]:
    """What encoder steps ask of Coulomb friction, and the motion across their edges."""
    moment = {"friction_per_moment": list(steps.friction_per_moment)} if turns else {}
    return {
        "friction_N_m": list(steps.friction),
        "friction_per_force_m": list(steps.friction_per_force),
        **moment,
        "covered_force_N": steps.covered[0] if steps.covered else None,
        **({"covered_moment_N_m": steps.covered[1] if steps.covered else None} if turns else {}),
        "refuted_force_N": steps.refuted,
        "motion": None if steps.motion is None else motion_document(steps.motion, turns),
    }


def additions_document(added: Additions) -> dict[str, Any]:
    """What damping would do, and what of it fails at a point; None where none does."""
    return {
        "addition_to_all_N_m_s_per_rad": added.to_all.enough[0],
        "addition_to_one_N_m_s_per_rad": [finite(one.enough[i]) for i, one in enumerate(added.alone)],
        "least_additions_N_m_s_per_rad": list(added.least.enough),
        "too_little": {
            "to_all_N_m_s_per_rad": added.to_all.fails[0],
            "to_one_N_m_s_per_rad": [finite(one.fails[i]) for i, one in enumerate(added.alone)],
            "least_N_m_s_per_rad": list(added.least.fails),
        },
    }


def motion_document(motion: ArmMotion, turns: int) -> dict[str, Any]:
    """A motion with its energy; of a hand with turns its rotations apart from its positions."""
    point = motion.positions.shape[-1] - turns
    document = {
        "energy_J": motion.energy,
        "encoder": motion.encoder,
        "imposed_by": motion.imposed_by,
        "largest_force_N": motion.largest_force,
        "joints_rad": motion.joints.tolist(),
        "positions_m": motion.positions[:, :point].tolist(),
        "wall_rest_m": motion.rest[:point].tolist(),
    }
    if not turns:
        return document
    rotations = {"rotations_rad": motion.positions[:, point:].tolist()}
    return {**document, **rotations, "wall_rest_rotation_rad": motion.rest[point:].tolist()}


def finite(value: float) -> float | None:
    """None of ∞, which JSON has not."""
    return value if isfinite(value) else None
