"""What a controller asks of the joints that computes their torques once a sample and holds them.

    c = ½ (h F + h_e M) T

with the curvatures h of the point and h_e of the turn, and the largest force F and moment M of the
wall; `sampled_jacobian_damping` is one of the two.
"""

from __future__ import annotations

from collections.abc import Sequence
from decimal import ROUND_FLOOR, Context

import numpy as np

from zwidth.errors import InputError
from zwidth.model.arms.encoders import MOST
from zwidth.model.arms.joints import sampled_jacobian_damping
from zwidth.model.arms.kinematics import Arm

_DIGITS = 4


def held_torque_damping(arm: Arm, period: float, delay_samples: int, largest: tuple[float, ...]) -> float:
    """c, to be taken from every joint; 0 where the torque follows the arm [N·m·s/rad].

    Parameters
    ----------
    arm
        With a known curvature.
    period
        T [s].
    delay_samples
        Of delay: the bound is for none.
    largest
        F [N], in pose F and M [N], [N·m], from `forces_of`; empty: the torque follows the arm.
    """
    if not largest:
        return 0.0
    curvatures = (arm.curvature, arm.turning_curvature) if arm.turns else (arm.curvature,)
    if None in curvatures or delay_samples:
        raise InputError(
            "a bound for held torques is known for chains and descriptions without delay; "
            "compute the torque several times in each period, and leave torque_held_up_to out"
        )
    return sum(
        sampled_jacobian_damping(h or 0.0, force, period)
        for h, force in zip(curvatures, largest, strict=True)
    )


def forces_of(arm: Arm, given: float | Sequence[float] | None, name: str) -> tuple[float, ...]:
    """A force [N], in pose with a moment [N·m], as it was given for `name`; empty if it was not."""
    if given is None:
        return ()
    try:
        forces = np.atleast_1d(np.asarray(given, dtype=np.float64))
    except (TypeError, ValueError):
        forces = np.empty(0)
    if forces.shape != (2 if arm.turns else 1,) or not ((forces >= 0) & (forces < np.inf)).all():
        also = " and the largest moment, ≥ 0 N·m" if arm.turns else ""
        raise InputError(f"{name} is the largest force of the wall, ≥ 0 N{also}; got {given!r}")
    return tuple(forces.tolist())


def in_words(largest: Sequence[float]) -> str:
    """The force, and the moment, rounded down: a claim goes no further than its proof."""
    down = Context(prec=_DIGITS, rounding=ROUND_FLOOR)
    units = zip(largest, ("N", "N·m"), strict=False)
    bounds = [f"{float(down.create_decimal(repr(value))):g} {unit}" for value, unit in units if value < MOST]
    return " and ".join(bounds) or "any"
