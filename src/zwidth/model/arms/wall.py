"""A wall of several coordinates: what it is, what damping it needs at the hand, and what is other in pose.

What damping a wall of several coordinates needs at the hand.

With F = K y + B (y(k) − y(k−1))/T, K ⪰ 0 and B symmetric, held and d whole samples late,
the hand gets no energy out exactly if for every 0 < θ ≤ π

    R(θ) = (T/2) K sin((d + ½)θ)/sin(θ/2) − B cos((d + 1)θ) ⪯ δ.

- d = 0: linear in cos θ, so its ends are enough: δ ⪰ KT/2 + B and δ ⪰ KT/2 − B; the one with
  |B| where all β_i have one sign.
- B = 0: the first factor is largest at θ → 0: δ ⪰ (2d + 1) KT/2.
- else δ ⪰ (2d + 1) KT/2 + |B| is enough, and not always needed; |B| has the eigenvalues |β_i|.

For one coordinate these are Colgate & Schenkel's b > KT/2 + |B| and its delayed
form.  Proof, with no use of frequencies: docs/theory/arms.md.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from zwidth.errors import InputError
from zwidth.model.arms.arm import Arm
from zwidth.model.environment.environment import certain
from zwidth.model.environment.velocity import BackwardDifference
from zwidth.model.environment.wall import Wall
from zwidth.quantity.exact import RealLike
from zwidth.quantity.parameter import read_number
from zwidth.quantity.text import from_to

Array = npt.NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class WallNeed:
    """δ ⪰ every one of these matrices: no motion takes energy out.

    Parameters
    ----------
    stiffness_share
        (2d + 1) KT/2, n × n [N·s/m].
    damping_shares
        What the virtual damping adds, one matrix for each condition [N·s/m].
    bound
        |B| [N·s/m]: with it in the place of the shares, one positive matrix that is enough also where
        δ changes along the motion.
    exact
        True where the conditions are also necessary.
    """

    stiffness_share: Array
    damping_shares: tuple[Array, ...]
    bound: Array
    exact: bool

    @property
    def matrices(self) -> tuple[Array, ...]:
        """The right sides of all conditions [N·s/m]."""
        return tuple(self.stiffness_share + share for share in self.damping_shares)


def _period(given: RealLike) -> float:
    return float(read_number(given, "sample_period", "sample_period"))


def wall_need(
    wall: Wall | MatrixWall, sample_period: RealLike, delay_samples: int = 0, size: int = 3
) -> WallNeed:
    """The damping at the hand that a wall asks for.

    Parameters
    ----------
    wall
        A `MatrixWall`, or a `Wall`, taken as equally stiff in every direction: that asks for as much
        as a plane wall of that stiffness whose normal may point anywhere.
    sample_period
        T > 0 [s].
    delay_samples
        d ≥ 0, whole samples between reading and force.
    size
        n, the coordinates of the hand; a `MatrixWall` has its own.

    Raises
    ------
    InputError
        If the wall is none of these, or has another number of coordinates.
    """
    k, b = wall_matrices(wall, size)
    share = (2 * delay_samples + 1) * _period(sample_period) / 2 * k
    values, vectors = np.linalg.eigh(b)
    bound = (vectors * np.abs(values)) @ vectors.T
    if not b.any() or (delay_samples == 0 and (values[0] >= 0 or values[-1] <= 0)):
        return WallNeed(stiffness_share=share, damping_shares=(bound,), bound=bound, exact=True)
    if delay_samples == 0:
        return WallNeed(stiffness_share=share, damping_shares=(b, -b), bound=bound, exact=True)
    return WallNeed(stiffness_share=share, damping_shares=(bound,), bound=bound, exact=False)


def damping_at(
    theta: float, wall: Wall | MatrixWall, sample_period: RealLike, delay_samples: int = 0, size: int = 3
) -> Array:
    """R(θ): the damping that motions of one frequency ask for, θ = ωT in (0, π] [N·s/m]."""
    k, b = wall_matrices(wall, size)
    d = delay_samples
    kernel = np.sin((d + 0.5) * theta) / np.sin(theta / 2)
    return np.asarray(_period(sample_period) / 2 * kernel * k - np.cos((d + 1) * theta) * b)


def require_wall(wall: object) -> None:
    """Refuse what is no wall of an arm."""
    if not isinstance(wall, (Wall, MatrixWall)):
        raise InputError(f"the wall of an arm is a Wall or a MatrixWall, got {type(wall).__name__}")


def wall_matrices(wall: Wall | MatrixWall, size: int) -> tuple[Array, Array]:
    """K and B as n × n matrices."""
    require_wall(wall)
    if isinstance(wall, MatrixWall):
        if wall.coordinates != size:
            raise InputError(
                f"the hand of this arm has {size} coordinates and the wall {wall.coordinates}; "
                f"give {size} × {size} matrices"
            )
        return np.array(wall.stiffness), np.array(wall.damping)
    if wall.velocity_filter != BackwardDifference():
        raise InputError("for arms the velocity is a backward difference; leave out the velocity filter")
    k, b = float(certain(wall.stiffness, "stiffness")), float(certain(wall.damping, "damping"))
    if wall.clamped and b:
        raise InputError(
            "for arms a clamped wall has no virtual damping: "
            "its condition in several coordinates is not known"
        )
    return k * np.eye(size), b * np.eye(size)


# A wall in the plane or in space: the force is a matrix times the depth.
#
#     F = K y + B (y(k) − y(k−1))/T
#
# y is the displacement from the wall's point of rest, K and B symmetric.  Stiff
# across and soft along: K = k n nᵀ is the plane wall with normal n.  In pose the last
# coordinates of y are rotations, and the last components of F moments.

_ROUNDING = 1e-12
"""Of the largest entry: what symmetry and positivity may miss."""

Matrix = Sequence[Sequence[float]] | npt.NDArray[np.float64]


@dataclass(frozen=True)
class MatrixWall:
    """A linear wall of several coordinates.

    Parameters
    ----------
    stiffness
        K, n × n, symmetric and positive semidefinite [N/m; of rotations N·m/rad, between both N/rad].
    damping
        B, n × n, symmetric, of either sign [N·s/m; N·m·s/rad; N·s/rad]; None: no virtual damping.
    turns
        How many of the coordinates, the last ones, are rotations: 0, the default, for a point; of a wall in
        pose 3 of 6, or 1 of 3 in the plane.

    Raises
    ------
    InputError
        If a matrix is not square, not symmetric, not finite, or K has a negative eigenvalue.
    """

    stiffness: Matrix
    damping: Matrix | None = None
    turns: int = 0

    def __post_init__(self) -> None:
        k = _symmetric(self.stiffness, "stiffness")
        if np.linalg.eigvalsh(np.array(k))[0] < -_ROUNDING * np.abs(k).max():
            raise InputError(
                "stiffness must have no negative eigenvalue: a spring that pushes away from its rest "
                "gives out energy without end"
            )
        b = (
            _symmetric(self.damping, "damping")
            if self.damping is not None
            else tuple((0.0,) * len(k) for _ in k)
        )
        if len(b) != len(k):
            raise InputError(
                f"stiffness is {len(k)} × {len(k)} and damping {len(b)} × {len(b)}; both are n × n"
            )
        if (self.turns, len(k)) not in ((3, 6), (1, 3)) and self.turns != 0:
            raise InputError(
                f"a wall in pose has 6 coordinates, 3 of them rotations, or 3 and 1 in the plane; "
                f"got {len(k)} and turns = {self.turns}"
            )
        object.__setattr__(self, "stiffness", k)
        object.__setattr__(self, "damping", b)

    @classmethod
    def in_pose(
        cls,
        stiffness: float,
        rotational_stiffness: float,
        damping: float = 0.0,
        rotational_damping: float = 0.0,
        planar: bool = False,
    ) -> MatrixWall:
        """A wall in pose that is as stiff in every direction, and about every axis.

        Parameters
        ----------
        stiffness, rotational_stiffness
            ≥ 0 [N/m], [N·m/rad].
        damping, rotational_damping
            Virtual damping of either sign [N·s/m], [N·m·s/rad]. Default 0.
        planar
            (x, y, angle) in the place of all six coordinates.
        """
        point, turns = (2, 1) if planar else (3, 3)
        return cls(
            np.diag([stiffness] * point + [rotational_stiffness] * turns),
            np.diag([damping] * point + [rotational_damping] * turns),
            turns=turns,
        )

    @property
    def coordinates(self) -> int:
        """n."""
        return len(self.stiffness)

    @property
    def clamped(self) -> bool:
        """False: it acts on both sides of its rest."""
        return False

    def describe(self) -> str:
        """In words."""
        point = self.coordinates - self.turns
        text = f"wall of {self.coordinates} coordinates, {self._range(slice(point), 'N/m', 'N·s/m')}"
        if self.turns:
            text += f"; of the rotation {self._range(slice(point, None), 'N·m/rad', 'N·m·s/rad')}"
        return text

    def _range(self, part: slice, stiffness_unit: str, damping_unit: str) -> str:
        low, high = np.linalg.eigvalsh(np.array(self.stiffness)[part, part])[[0, -1]]
        text = f"stiffness {from_to(max(low, 0.0), high, stiffness_unit)}"
        b = np.linalg.eigvalsh(np.array(self.damping)[part, part])
        return text + (f", virtual damping {from_to(b[0], b[-1], damping_unit)}" if b.any() else "")


def _symmetric(value: Matrix, key: str) -> tuple[tuple[float, ...], ...]:
    try:
        matrix = np.array(value, dtype=np.float64)
    except (TypeError, ValueError):
        raise InputError(f"{key} must be a matrix of numbers, got {value!r}") from None
    if matrix.ndim != 2 or matrix.shape[0] != matrix.shape[1] or not matrix.size:
        raise InputError(f"{key} must be square, n × n, got the shape {matrix.shape}")
    if not np.isfinite(matrix).all():
        raise InputError(f"{key} must be finite")
    if np.abs(matrix - matrix.T).max() > _ROUNDING * np.abs(matrix).max():
        raise InputError(f"{key} must be symmetric: what is not symmetric gives out energy on closed paths")
    return tuple(map(tuple, ((matrix + matrix.T) / 2).tolist()))


# What is different where the wall is in pose: metres and radians at one hand.
#
# The condition δ_m ⪰ Jᵀ R J is one of the joints and holds in any units of the hand.  But a margin
# at the hand would have no unit, and one bound for all rows of J would let the rotation be weighed
# with the stiffness of the translation.  With G = √R J and R's blocks on the diagonal, R_p and R_e,
#
#     ‖G(q) − G‖ ≤ η = √‖R_p‖ η_p + √‖R_e‖ η_e,   λ_min falls by no more than 2 ‖G‖ η + η².


def fits(arm: Arm, wall: Wall | MatrixWall) -> None:
    """Refuse a wall in pose before a point, and a wall of a point before a hand in pose."""
    turns = wall.turns
    if turns == arm.turns:
        if arm.rests_anywhere and not _alike(wall, turns):
            raise InputError(
                "a wall that is not as stiff about every axis asks for more in some orientations of rest "
                "than in others: say where it rests, read_arm(…, rest={}) or --rest middle for the middle "
                "of the ranges"
            )
        return
    if arm.turns:
        planar = ", planar=True" if arm.turns == 1 else ""
        raise InputError(
            f"{arm.name} is held in pose, and N/m and N·m/rad are not one stiffness: give the wall as "
            f"MatrixWall.in_pose(500, 20{planar}) or MatrixWall(…, turns={arm.turns})"
        )
    raise InputError(
        f"the wall has {turns} rotations and {arm.name} is held at a point; ask for the arm in pose, "
        "read_arm(…, pose=True) or PlanarChain(…, pose=True)"
    )


def _alike(wall: Wall | MatrixWall, turns: int) -> bool:
    """Whether a wall is as stiff about every axis, without coupling of forces and turns."""
    matrices = [np.array(m) for m in (wall.stiffness, wall.damping)]
    last = np.eye(turns, len(matrices[0]), len(matrices[0]) - turns)
    return all(np.array_equal(m[-turns:], m[-1, -1] * last) for m in matrices)


def loss_in_pose(need: Array, jacobians: Array, parts: Array, turns: int) -> Array:
    """How far the smallest eigenvalue of δ_m − JᵀRJ may fall inside a cell [N·m·s/rad].

    R ⪰ 0, n × n; J (…, n, m); `parts` are η_p [m/rad] and η_e [1] (…, 2); of rows the last `turns` rotate.
    """
    point = need.shape[0] - turns
    weights = [np.sqrt(np.linalg.norm(block, 2)) for block in (need[:point, :point], need[point:, point:])]
    change = parts @ np.array(weights)
    load = np.linalg.eigvalsh(np.swapaxes(jacobians, -1, -2) @ need @ jacobians)[..., -1]
    return np.asarray(2 * np.sqrt(np.maximum(load, 0.0)) * change + change**2)


def motion_at_hand(worst: Array, jacobians: Array, turns: int) -> tuple[Array, Array]:
    """|J_p w| [m/rad] and |J_e w| [1]: how the hand moves and turns in a direction w of the joints (…, m)."""
    rates = np.einsum("...nm,...m->...n", jacobians, worst)
    point = rates.shape[-1] - turns
    return np.linalg.norm(rates[..., :point], axis=-1), np.linalg.norm(rates[..., point:], axis=-1)
