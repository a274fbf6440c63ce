"""A wall in the plane or in space: the force is a matrix times the depth.

    F = K y + B (y(k) − y(k−1))/T

y is the displacement from the wall's point of rest, K and B symmetric.  Stiff
across and soft along: K = k n nᵀ is the plane wall with normal n.
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
        K, n × n, symmetric and positive semidefinite [N/m].
    damping
        B, n × n, symmetric, of either sign [N·s/m]; None: no virtual damping.

    Raises
    ------
    InputError
        If a matrix is not square, not symmetric, not finite, or K has a negative eigenvalue.
    """

    stiffness: Matrix
    damping: Matrix | None = None

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
        object.__setattr__(self, "stiffness", k)
        object.__setattr__(self, "damping", b)

    @property
    def coordinates(self) -> int:
        """n."""
        return len(self.stiffness)

    def describe(self) -> str:
        """In words."""
        low, high = np.linalg.eigvalsh(np.array(self.stiffness))[[0, -1]]
        text = f"wall of {self.coordinates} coordinates, stiffness {max(low, 0.0):.4g} to {high:.4g} N/m"
        b = np.linalg.eigvalsh(np.array(self.damping))
        return text + (f", virtual damping {b[0]:.4g} to {b[-1]:.4g} N·s/m" if b.any() else "")


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
