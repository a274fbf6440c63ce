"""The verdict on an arm as plain data, every key with its unit."""

from __future__ import annotations

from math import isfinite
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from zwidth.passivity.arms.region import Workspace


def workspace_document(space: Workspace) -> dict[str, Any]:
    """The verdict without the map, which is as large as the grid."""
    data, motion, certificate = space.data, space.motion, space.certificate
    return {
        "outcome": space.outcome,
        "claim": space.claim,
        "arm": space.arm.name,
        "region": data.attrs["region"],
        "sample_period_s": space.sample_period,
        "delay_samples": space.delay_samples,
        "smallest_margin_N_s_per_m": float(data["margin"].min()),
        "largest_stiffness_N_per_m": _finite(space.largest_stiffness),
        "addition_to_all_N_m_s_per_rad": space.addition_to_all,
        "addition_to_one_N_m_s_per_rad": [_finite(v) for v in space.additions],
        "proved_part": float(data["proved"].mean()),
        "motion": None
        if motion is None
        else {
            "energy_J": motion.energy,
            "joints_rad": motion.joints.tolist(),
            "positions_m": motion.positions.tolist(),
        },
        "certificate": None if certificate is None else certificate.to_dict(),
    }


def _finite(value: float) -> float | None:
    return value if isfinite(value) else None
