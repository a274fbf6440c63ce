"""The verdict on an arm as plain data, every key with its unit."""

from __future__ import annotations

from math import isfinite
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from zwidth.passivity.arms.region import Workspace
    from zwidth.passivity.arms.replay import ArmMotion


def workspace_document(space: Workspace) -> dict[str, Any]:
    """The verdict without the map, which is as large as the grid."""
    data, motion, certificate = space.data, space.motion, space.certificate
    margin = float(data["margin"].min()) if "margin" in data else None
    largest = space.largest_stiffness
    return {
        "outcome": space.outcome,
        "claim": space.claim,
        "arm": space.arm.name,
        "region": data.attrs["region"],
        "sample_period_s": space.sample_period,
        "delay_samples": space.delay_samples,
        "smallest_margin_N_s_per_m": margin,
        "smallest_margin_in_joints_N_m_s_per_rad": float(data["margin_in_joints"].min()),
        "stiffness_factor": _finite(space.stiffness_factor),
        "largest_stiffness_N_per_m": None if largest is None else _finite(largest),
        "encoder_friction_N_m": [_finite(v) for v in space.encoder_friction],
        "addition_to_all_N_m_s_per_rad": space.addition_to_all,
        "addition_to_one_N_m_s_per_rad": [_finite(v) for v in space.additions],
        "least_additions_N_m_s_per_rad": list(space.least_additions),
        "proved_part": float(data["proved"].mean()),
        "motion": None if motion is None else _motion(motion, space.arm.turns),
        "certificate": None if certificate is None else certificate.to_dict(),
    }


def _motion(motion: ArmMotion, turns: int) -> dict[str, Any]:
    point = motion.positions.shape[-1] - turns
    document = {
        "energy_J": motion.energy,
        "joints_rad": motion.joints.tolist(),
        "positions_m": motion.positions[:, :point].tolist(),
    }
    return {**document, "rotations_rad": motion.positions[:, point:].tolist()} if turns else document


def _finite(value: float) -> float | None:
    return value if isfinite(value) else None
