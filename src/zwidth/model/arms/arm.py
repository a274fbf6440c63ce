"""A device with several joints: friction and encoders sit in the joints, the hand at the end.

    v = J(q) q̇,   τ = J(q)ᵀ F,   M(q) q̈ + C(q, q̇) q̇ + g(q) + δ_m q̇ = τ

(Miller, Colgate & Freeman 2004, equations (15) to (17); J depends on the position only).  Here are the
numbers that every such device has; its geometry is in `chain`, `legs` and `described`.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import isfinite, nextafter
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from zwidth.errors import InputError
from zwidth.model.device.transmission import Transmission
from zwidth.quantity.exact import ends
from zwidth.quantity.units import in_si
from zwidth.showing import one_line

Array = npt.NDArray[np.float64]


class Axis(NamedTuple):
    """One coordinate of a grid: the middles of its cells."""

    name: str
    unit: str
    middles: Array


class Sites(NamedTuple):
    """Points of the workspace, each in the middle of a cell; the cells leave no gap between them.

    `joints` (…, m), `positions` (…, n) and `jacobians` (…, n, m) are NaN where the arm does not reach.
    `change` (…) bounds ‖J(q) − J‖₂ from the middle to any other point of the cell; ∞ where no bound is known.
    Of a hand in pose `parts` (…, 2) bounds the same for the rows of translation and for those of rotation.
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
    transmission
        Of joints that give way between motor and link: a `Transmission` for all, or one for each joint,
        seen at the joint [N·m/rad, N·m·s/rad; N/m, N·s/m]. Damping, friction and encoder steps above are
        then those of the motors' side, and `handle_damping` is the link's. None: a joint is one piece.

    Raises
    ------
    InputError
        If a number is missing, not finite or outside its bound, or a matrix is no symmetric one without
        negative eigenvalues; or if a joint that gives way is read at its link.
    """

    damping: Damping
    coulomb_friction: Sequence[float | str] = ()
    resolution: Sequence[float | str] = ()
    torque_limit: Sequence[float | str] = ()
    name: str = "arm"
    transmission: Transmission | Sequence[Transmission] | None = None

    def __post_init__(self) -> None:
        m, names = self.joint_count, self.joint_names
        object.__setattr__(self, "name", one_line(self.name))
        object.__setattr__(self, "damping", joint_damping(self.damping, names, self.sliding))
        for key in ("coulomb_friction", "resolution", "torque_limit"):
            object.__setattr__(self, key, joint_numbers(getattr(self, key), key, names, self.sliding))
        object.__setattr__(self, "transmission", _transmissions(self.transmission, m))
        for joint, each in enumerate(self.transmissions, start=1):
            each.require("linear" if self.sliding[joint - 1] else "rotary", f"joint {joint}")
        if any(limit == 0 for limit in self.torque_limit):
            raise InputError("torque_limit must be > 0: a motor without torque renders nothing; leave it out")

    @property
    @abstractmethod
    def joint_count(self) -> int:
        """m, the joints that have a motor or move freely."""

    @property
    def joint_names(self) -> tuple[str, ...]:
        """Of each joint, for reports."""
        return tuple(f"joint {i + 1}" for i in range(self.joint_count))

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

    @property
    def transmissions(self) -> tuple[Transmission, ...]:
        """Of each joint; empty where a joint is one piece."""
        return _transmissions(self.transmission, self.joint_count)

    @property
    def at_motors(self) -> Arm:
        """The arm that the motors feel, b + c b_l/(c + b_l) in each joint, whatever links and hand do.

        For any q̇ of the links b θ̇² + c (θ̇ − q̇)² + b_l q̇² is no less than this times θ̇².  With intervals the
        least of them counts.
        """
        if not self.transmissions:
            return self
        felt = np.array(self.damping, dtype=np.float64)
        for i, each in enumerate(self.transmissions):
            c, link = ends(each.damping)[0], ends(each.handle_damping)[0]
            if c and link:
                place = (i,) * felt.ndim
                exact = Fraction(repr(float(felt[place]))) + c * link / (c + link)
                felt[place] = nextafter(float(exact), 0.0)
        return self.replace(damping=felt, transmission=Transmission())

    def at(self, joints: npt.ArrayLike, digits: int = 4) -> str:
        """A place of the joints in words, as `--hold` takes it: "shoulder=0.2, elbow=0.4" [rad; m]."""
        values = np.asarray(joints, dtype=np.float64).tolist()
        return ", ".join(
            f"{name}={value:.{digits}g}" for name, value in zip(self.joint_names, values, strict=True)
        )

    def replace(self, **changes: Any) -> Arm:
        """The same arm with some numbers changed."""
        given = {key: getattr(self, key) for key in self.__dataclass_fields__}
        return type(self)(**{**given, **changes})


def _transmissions(
    given: Transmission | Sequence[Transmission] | None, count: int
) -> tuple[Transmission, ...]:
    each = (given,) * count if isinstance(given, Transmission) else tuple(given or ())
    if len(each) == 1:
        each *= count
    if not all(isinstance(one, Transmission) for one in each) or len(each) not in (0, count):
        raise InputError(f"transmission: a zwidth.Transmission for all joints, or one for each of {count}")
    for joint, one in enumerate(each, start=1):
        if one.encoder != "motor":
            raise InputError(
                f"transmission: joint {joint} is read at its link, encoder = {one.encoder!r}, and what its "
                "motor's damping pays for is not what the controller then sees: nothing is proved of such an "
                "arm. Read the joint at the motor; of one joint alone zwidth check decides"
            )
    return each


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


JOINT_UNITS = {
    "damping": ("N*m*s/rad", "N*s/rad", "N*s/m"),
    "coulomb_friction": ("N*m", "N"),
    "resolution": ("rad", "m"),
    "torque_limit": ("N*m", "N"),
}
"""Of joints that turn, and of those that slide; of damping also between the two."""


def joint_numbers(given: Any, key: str, names: Sequence[str], sliding: Sequence[bool]) -> tuple[float, ...]:
    """One for each joint in SI, from numbers or texts with a unit; none of what is not given."""
    values = _listed(given)
    if values is None or values.ndim != 1:
        raise InputError(f"{key}: one number for each joint, got {given!r}")
    units = (JOINT_UNITS[key][0], JOINT_UNITS[key][-1])
    numbers = tuple(
        in_si(value, units[slides], f"{key} of {name}")
        for value, name, slides in zip(values, names, sliding, strict=False)
    )
    if len(values) not in (0, len(names)):
        raise InputError(
            f"{key}: give one for each joint, {len(names)} in all; got {len(values)}; "
            f"they are {', '.join(names)}"
        )
    if any(not isfinite(v) or v < 0 for v in numbers):
        raise InputError(f"{key} must be finite and ≥ 0 in every joint, got {numbers}")
    return numbers


def _listed(given: Any) -> npt.NDArray[np.object_] | None:
    """As an array; None where rows are not equally long."""
    try:
        return np.atleast_1d(np.asarray(given, dtype=object))
    except ValueError:
        return None


# What viscous friction takes out of the joints: the power q̇ᵀ δ_m q̇ ≥ 0 of the torque −δ_m q̇.
#
# One number for each joint, where each has a friction of its own; the whole matrix, where joints share what
# rubs. With friction b_i at shafts that turn with A q̇ (motors behind belts, a differential, tendons)
#
#     δ_m = Aᵀ diag(b_i) A
#
# (Miller, Colgate & Freeman 2004, section IV-A: "δ_m is a matrix of dissipation parameters").

Damping = Sequence[float | str] | Sequence[Sequence[float | str]] | Array

_UNEVEN = 1e-12
"""Of the roots of both diagonal entries, whatever the units: what symmetry and positivity may miss."""


def joint_damping(
    given: Damping, names: Sequence[str], sliding: Sequence[bool]
) -> tuple[float, ...] | tuple[tuple[float, ...], ...]:
    """δ_m as an arm keeps it: b_i of each joint, or the rows of a matrix that is not diagonal."""
    values, joints = _listed(given), len(names)
    if values is not None and values.ndim == 1 and not any(isinstance(v, (list, tuple)) for v in values):
        return joint_numbers(values, "damping", names, sliding)
    if values is None or values.ndim == 1:
        raise InputError(f"damping: one number for each joint, or a square matrix of them; got {given!r}")
    if values.shape != (joints, joints):
        raise InputError(
            f"damping: a matrix for {joints} joint{'s' if joints > 1 else ''} is {joints} × {joints}, "
            f"got the shape {values.shape}"
        )
    units = JOINT_UNITS["damping"]
    rows = [
        [in_si(value, units[i + j], "damping") for value, j in zip(row, sliding, strict=True)]
        for row, i in zip(values, sliding, strict=True)
    ]
    return _of_all(np.array(rows))


def _of_all(values: Array) -> tuple[float, ...] | tuple[tuple[float, ...], ...]:
    joints = len(values)
    own = np.diag(values)
    if not np.isfinite(values).all() or (own < 0).any():
        raise InputError("damping must be finite, and ≥ 0 on the diagonal: friction does not push")
    size = np.sqrt(np.outer(own, own))
    if (np.abs(values - values.T) > _UNEVEN * size).any():
        raise InputError(
            "damping must be symmetric: what is lost is q̇ᵀ δ q̇, and only (δ + δᵀ)/2 is in it; "
            "if your δ is right, give that"
        )
    matrix = (values + values.T) / 2
    scale = np.where(own > 0, np.sqrt(own), 1.0)
    least = float(np.linalg.eigvalsh(matrix / np.outer(scale, scale))[0])
    if least < -_UNEVEN * joints or (matrix[own == 0] != 0).any():
        raise InputError(
            "damping must have no negative eigenvalue: friction would drive some motion of the joints; "
            "for friction b at shafts that turn with A q̇ it is Aᵀ diag(b) A"
        )
    if not (matrix - np.diag(own)).any():
        return tuple(own.tolist())
    return tuple(map(tuple, matrix.tolist()))


_ROUNDED = 1e-9
"""Of what is added up: an energy below it may be rounding."""


@dataclass(frozen=True, kw_only=True)
class ArmMotion:
    """A closed motion, and its energy over one round.

    Parameters
    ----------
    joints
        q(k), N × m [rad; m].
    positions
        p(k), N × n [m]; in pose its rotation comes last [rad].
    work
        Of the hand against the wall's force, over one round [J].
    loss
        Of the joints' friction, over one round [J].
    rest
        Where the wall rests, n [m]; in pose its rotation comes last [rad].
    largest_force
        That the wall renders on the way [N].
    largest_moment
        The same of what it gives for rotations, 0 of a point [N·m].
    encoder
        "ideal": position and Jacobian are read without steps. "counted": at the readings of the arm's
        encoders.
    imposed_by
        "end": a hand at the end holds every joint. "links": it does not, as the arm has more joints than the
        hand has coordinates; whoever makes this motion holds the links, too.
    """

    joints: Array
    positions: Array
    work: float
    loss: float
    rest: Array
    largest_force: float
    largest_moment: float = 0.0
    encoder: str = "ideal"
    imposed_by: str = "end"

    @property
    def energy(self) -> float:
        """What the hand puts in, over one round [J]; negative: it takes energy out."""
        return self.work + self.loss

    @property
    def takes_energy(self) -> bool:
        """Whether it does so by more than rounding."""
        return self.energy < -_ROUNDED * (abs(self.work) + self.loss)
