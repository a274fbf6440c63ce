"""What a controller asks of the joints that computes their torques once a sample and holds them.

    c = ½ (h F + h_e M) T

with the curvatures h of the point and h_e of the turn, and the largest force F and moment M of the
wall; `sampled_jacobian_damping` is one of the two.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from zwidth.device.arm import Arm
from zwidth.errors import InputError
from zwidth.passivity.arms.joints import sampled_jacobian_damping


def held_torque_damping(
    arm: Arm, period: float, samples: int, largest: float | Sequence[float] | None
) -> float:
    """c, to be taken from every joint; 0 where the torque follows the arm [N·m·s/rad].

    Parameters
    ----------
    arm
        With a known curvature.
    period
        T [s].
    samples
        Of delay: the bound is for none.
    largest
        F [N], in pose F and M [N], [N·m]; None: the torque follows the arm.
    """
    if largest is None:
        return 0.0
    curvatures = (arm.curvature, arm.turning_curvature) if arm.turns else (arm.curvature,)
    try:
        forces = np.atleast_1d(np.asarray(largest, dtype=np.float64))
    except (TypeError, ValueError):
        forces = np.empty(0)
    if forces.shape != (len(curvatures),) or not ((forces >= 0) & (forces < np.inf)).all():
        also = " and the largest moment, ≥ 0 N·m" if arm.turns else ""
        raise InputError(f"torque_held_up_to is the largest force of the wall, ≥ 0 N{also}; got {largest!r}")
    if None in curvatures or samples:
        raise InputError(
            "a bound for held torques is known for chains and descriptions without delay; "
            "compute the torque several times in each period, and leave torque_held_up_to out"
        )
    return sum(
        sampled_jacobian_damping(h or 0.0, float(force), period)
        for h, force in zip(curvatures, forces, strict=True)
    )


def in_words(largest: float | Sequence[float]) -> str:
    """The force, and the moment."""
    units = zip(np.atleast_1d(largest), ("N", "N·m"), strict=False)
    return " and ".join(f"{value:g} {unit}" for value, unit in units)
