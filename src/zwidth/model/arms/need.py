"""What damping a wall of several coordinates needs at the hand.

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

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from zwidth.errors import InputError
from zwidth.model.arms.matrix_wall import MatrixWall
from zwidth.model.environment.environment import certain
from zwidth.model.environment.velocity import BackwardDifference
from zwidth.model.environment.wall import Wall

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


def wall_need(
    wall: Wall | MatrixWall, sample_period: float, delay_samples: int = 0, size: int = 3
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
    share = (2 * delay_samples + 1) * sample_period / 2 * k
    values, vectors = np.linalg.eigh(b)
    bound = (vectors * np.abs(values)) @ vectors.T
    if not b.any() or (delay_samples == 0 and (values[0] >= 0 or values[-1] <= 0)):
        return WallNeed(stiffness_share=share, damping_shares=(bound,), bound=bound, exact=True)
    if delay_samples == 0:
        return WallNeed(stiffness_share=share, damping_shares=(b, -b), bound=bound, exact=True)
    return WallNeed(stiffness_share=share, damping_shares=(bound,), bound=bound, exact=False)


def damping_at(
    theta: float, wall: Wall | MatrixWall, sample_period: float, delay_samples: int = 0, size: int = 3
) -> Array:
    """R(θ): the damping that motions of one frequency ask for, θ = ωT in (0, π] [N·s/m]."""
    k, b = wall_matrices(wall, size)
    d = delay_samples
    kernel = np.sin((d + 0.5) * theta) / np.sin(theta / 2)
    return np.asarray(sample_period / 2 * kernel * k - np.cos((d + 1) * theta) * b)


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
