"""A device with several joints: friction and encoders sit in the joints, the hand at the end.

    v = J(q) q̇,   τ = J(q)ᵀ F,   M(q) q̈ + C(q, q̇) q̇ + g(q) + δ_m q̇ = τ

(Miller, Colgate & Freeman 2004, equations (15) to (17); J depends on the
position only).  Here are the numbers that every such device has; its geometry
is in `chain`, `legs` and `described`.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from math import isfinite
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from zwidth.errors import InputError
from zwidth.model.arms.kinematics.joint_damping import Damping, joint_damping
from zwidth.showing import one_line

Array = npt.NDArray[np.float64]


class Axis(NamedTuple):
    """One coordinate of a grid: the middles of its cells."""

    name: str
    unit: str
    middles: Array


class Sites(NamedTuple):
    """Points of the workspace, each in the middle of a cell; the cells leave no gap between them.

    `joints` (…, m), `positions` (…, n) and `jacobians` (…, n, m) are NaN where
    the arm does not reach.  `change` (…) bounds ‖J(q) − J‖₂ from the middle
    to any other point of the cell; ∞ where no bound is known.  Of a hand in pose
    `parts` (…, 2) bounds the same for the rows of translation and for those of rotation.
    """

    axes: tuple[Axis, ...]
    joints: Array
    positions: Array
    jacobians: Array
    change: Array
    region: str
    parts: Array | None = None


@dataclass(frozen=True, kw_only=True)
class Arm(ABC):
    """What all arms have in their joints.

    Parameters
    ----------
    damping
        Viscous friction b_i of each joint, ≥ 0 [N·m·s/rad; N·s/m of a sliding joint]; or, of joints that damp
        each other by belts, differentials or tendons, the matrix δ_m ⪰ 0, m × m and symmetric [also
        N·s/rad between the two]. A diagonal matrix is kept as its diagonal.
    coulomb_friction
        Coulomb friction f_c,i of each joint, ≥ 0 [N·m; N]; empty: none.
    resolution
        Encoder step Δ_i of each joint, ≥ 0 [rad; m]; empty: no steps.
    torque_limit
        What each motor gives, > 0 [N·m; N]; empty: unknown.
    name
        For reports.

    Raises
    ------
    InputError
        If a number is missing, not finite or outside its bound, or a matrix is no symmetric one without
        negative eigenvalues.
    """

    damping: Damping
    coulomb_friction: Sequence[float] = ()
    resolution: Sequence[float] = ()
    torque_limit: Sequence[float] = ()
    name: str = "arm"

    def __post_init__(self) -> None:
        m = self.joint_count
        object.__setattr__(self, "name", one_line(self.name))
        object.__setattr__(self, "damping", joint_damping(self.damping, m))
        for key in ("coulomb_friction", "resolution", "torque_limit"):
            object.__setattr__(self, key, _numbers(getattr(self, key), key, m))
        if any(limit == 0 for limit in self.torque_limit):
            raise InputError("torque_limit must be > 0: a motor without torque renders nothing; leave it out")

    @property
    @abstractmethod
    def joint_count(self) -> int:
        """m, the joints that have a motor or move freely."""

    @property
    def sliding(self) -> tuple[bool, ...]:
        """Of each joint whether it slides; the others turn."""
        return (False,) * self.joint_count

    @property
    def turns(self) -> int:
        """How many of the hand's coordinates, the last ones, are rotations; 0: the hand is a point."""
        return 0

    @property
    def rests_anywhere(self) -> bool:
        """Whether `sites` are for walls in every orientation of rest, where it makes a difference."""
        return False

    def resting(self, joints: npt.ArrayLike) -> Arm:
        """The same arm, with the wall at rest at these joints if it may rest anywhere."""
        return self

    @abstractmethod
    def forward(self, joints: npt.ArrayLike) -> Array:
        """The point that the hand holds, (…, m) → (…, n) [m]; its rotation comes last [rad]."""

    @abstractmethod
    def jacobian(self, joints: npt.ArrayLike) -> Array:
        """J = ∂p/∂q, (…, m) → (…, n, m) [m/rad; 1]."""

    @property
    def curvature(self) -> float | None:
        """h with |Σ ∂²p/∂q_i∂q_j w_i w_j| ≤ h |w|² for the point p, everywhere [m/rad²]; None: unknown."""
        return None

    @property
    def turning_curvature(self) -> float | None:
        """The same of the rotations at the hand [1/rad]; None: no bound is known."""
        return None

    @abstractmethod
    def sites(self, points: int) -> Sites:
        """The middles of about `points` × `points` cells that cover the region of this arm."""

    def replace(self, **changes: Any) -> Arm:
        """The same arm with some numbers changed."""
        given = {key: getattr(self, key) for key in self.__dataclass_fields__}
        return type(self)(**{**given, **changes})


def as_joints(joints: npt.ArrayLike, count: int) -> Array:
    """Joint values as an array (…, m)."""
    q = np.asarray(joints, dtype=np.float64)
    if q.ndim == 0 or q.shape[-1] != count:
        raise InputError(
            f"this arm has {count} joint{'s' if count > 1 else ''}: "
            f"give an array of shape (…, {count}), got {q.shape}"
        )
    return q


def middles(low: float, high: float, count: int) -> Array:
    """The middles of `count` equal cells from `low` to `high`."""
    return low + (high - low) * (np.arange(count) + 0.5) / count


def _numbers(values: Sequence[float], key: str, count: int) -> tuple[float, ...]:
    try:
        numbers = tuple(float(v) for v in np.atleast_1d(np.asarray(values, dtype=np.float64)))
    except (TypeError, ValueError):
        raise InputError(f"{key}: one number for each joint, got {values!r}") from None
    if not numbers:
        return ()
    if len(numbers) != count:
        raise InputError(f"{key}: give one for each joint, {count} in all; got {len(numbers)}")
    if any(not isfinite(v) or v < 0 for v in numbers):
        raise InputError(f"{key} must be finite and ≥ 0 in every joint, got {numbers}")
    return numbers
