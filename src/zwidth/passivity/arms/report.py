"""The verdict on an arm as plain data, every key with its unit."""

from __future__ import annotations

from math import isfinite
from typing import TYPE_CHECKING, Any

import numpy as np

from zwidth.passivity.arms.need import wall_matrices

if TYPE_CHECKING:
    from zwidth.passivity.arms.encoders import EncoderSteps
    from zwidth.passivity.arms.motion import ArmMotion
    from zwidth.passivity.arms.region import Workspace


def workspace_document(space: Workspace) -> dict[str, Any]:
    """The verdict without the map, which is as large as the grid."""
    data, motion, certificate, steps = space.data, space.motion, space.certificate, space.encoder_steps
    margin = float(data["margin"].min()) if "margin" in data else None
    largest = space.largest_stiffness
    return {
        "outcome": space.outcome,
        "claim": space.claim,
        "scope": space.scope.to_dict(),
        "arm": space.arm.name,
        "joint_damping_N_m_s_rad": np.asarray(space.arm.damping).tolist(),
        "region": space.region,
        "wall": _wall(space),
        "torque": space.torque,
        "encoder": space.encoder,
        "largest_forces_N": list(space.largest_forces[:1]),
        "largest_moments_N_m": list(space.largest_forces[1:]),
        "can_be_refuted": space.can_be_refuted,
        "sample_period_s": space.sample_period,
        "delay_samples": space.delay_samples,
        "smallest_margin_N_s_per_m": margin,
        "smallest_margin_in_joints_N_m_s_per_rad": float(data["margin_in_joints"].min()),
        "stiffness_factor": _finite(space.stiffness_factor),
        "largest_stiffness_N_per_m": None if largest is None else _finite(largest),
        "encoder_steps": None if steps is None else _steps(steps, space.arm.turns),
        "addition_to_all_N_m_s_per_rad": space.addition_to_all,
        "addition_to_one_N_m_s_per_rad": [_finite(v) for v in space.additions],
        "least_additions_N_m_s_per_rad": list(space.least_additions),
        "proved_part": float(data["proved"].mean()),
        "motion": None if motion is None else _motion(motion, space.arm.turns),
        "certificate": None if certificate is None else certificate.to_dict(),
    }


def _wall(space: Workspace) -> dict[str, Any]:
    k, b = wall_matrices(space.wall, space.coordinates)
    keys = ("stiffness_N_m_rad", "virtual_damping_N_m_s_rad") if space.arm.turns else (
        "stiffness_N_per_m", "virtual_damping_N_s_per_m"
    )  # fmt: skip
    return dict(zip(keys, (k.tolist(), b.tolist()), strict=True))


def _steps(steps: EncoderSteps, turns: int) -> dict[str, Any]:
    moment = {"friction_per_moment": list(steps.friction_per_moment)} if turns else {}
    return {
        "friction_N_m": list(steps.friction),
        "friction_per_force_m": list(steps.friction_per_force),
        **moment,
        "covered_force_N": steps.covered[0] if steps.covered else None,
        **({"covered_moment_N_m": steps.covered[1] if steps.covered else None} if turns else {}),
        "refuted_force_N": steps.refuted,
        "motion": None if steps.motion is None else _motion(steps.motion, turns),
    }


def _motion(motion: ArmMotion, turns: int) -> dict[str, Any]:
    point = motion.positions.shape[-1] - turns
    document = {
        "energy_J": motion.energy,
        "encoder": motion.encoder,
        "largest_force_N": motion.largest_force,
        "joints_rad": motion.joints.tolist(),
        "positions_m": motion.positions[:, :point].tolist(),
        "wall_rest_m": motion.rest[:point].tolist(),
    }
    if not turns:
        return document
    rotations = {"rotations_rad": motion.positions[:, point:].tolist()}
    return {**document, **rotations, "wall_rest_rotation_rad": motion.rest[point:].tolist()}


def _finite(value: float) -> float | None:
    return value if isfinite(value) else None
