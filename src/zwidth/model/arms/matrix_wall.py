"""A wall in the plane or in space: the force is a matrix times the depth.

    F = K y + B (y(k) − y(k−1))/T

y is the displacement from the wall's point of rest, K and B symmetric.  Stiff
across and soft along: K = k n nᵀ is the plane wall with normal n.  In pose the last
coordinates of y are rotations, and the last components of F moments.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from zwidth.errors import InputError

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
        text = f"stiffness {max(low, 0.0):.4g} to {high:.4g} {stiffness_unit}"
        b = np.linalg.eigvalsh(np.array(self.damping)[part, part])
        return text + (f", virtual damping {b[0]:.4g} to {b[-1]:.4g} {damping_unit}" if b.any() else "")


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
