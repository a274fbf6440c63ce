"""What viscous friction takes out of the joints: the power q̇ᵀ δ_m q̇ ≥ 0 of the torque −δ_m q̇.

One number for each joint, where each has a friction of its own; the whole matrix, where joints share what
rubs.
With friction b_i at shafts that turn with A q̇ (motors behind belts, a differential, tendons)

    δ_m = Aᵀ diag(b_i) A

(Miller, Colgate & Freeman 2004, section IV-A: "δ_m is a matrix of dissipation parameters").
"""

from __future__ import annotations

from collections.abc import Sequence
from math import isfinite

import numpy as np
import numpy.typing as npt

from zwidth.errors import InputError

Array = npt.NDArray[np.float64]
Damping = Sequence[float] | Sequence[Sequence[float]] | Array

_ROUNDING = 1e-12
"""Of the roots of both diagonal entries, whatever the units: what symmetry and positivity may miss."""


def joint_damping(given: Damping, joints: int) -> tuple[float, ...] | tuple[tuple[float, ...], ...]:
    """δ_m as an arm keeps it: the numbers of the joints, or the rows of a matrix that is not diagonal.

    Parameters
    ----------
    given
        b_i ≥ 0 of each joint, or δ_m ⪰ 0, symmetric [N·m·s/rad; N·s/m of two sliding joints, N·s/rad
        between a sliding joint and one that turns].
    joints
        m, how many.
    """
    try:
        values = np.atleast_1d(np.asarray(given, dtype=np.float64))
    except (TypeError, ValueError):
        raise InputError(
            f"damping: one number for each joint, or a square matrix of them; got {given!r}"
        ) from None
    return _of_each(values, joints) if values.ndim == 1 else _of_all(values, joints)


def _of_each(values: Array, joints: int) -> tuple[float, ...]:
    numbers = tuple(values.tolist())
    if len(numbers) != joints:
        raise InputError(f"damping: give one for each joint, {joints} in all; got {len(numbers)}")
    if any(not isfinite(v) or v < 0 for v in numbers):
        raise InputError(f"damping must be finite and ≥ 0 in every joint, got {numbers}")
    return numbers


def _of_all(values: Array, joints: int) -> tuple[float, ...] | tuple[tuple[float, ...], ...]:
    if values.shape != (joints, joints):
        raise InputError(
            f"damping: a matrix for {joints} joint{'s' if joints > 1 else ''} is {joints} × {joints}, "
            f"got the shape {values.shape}"
        )
    own = np.diag(values)
    if not np.isfinite(values).all() or (own < 0).any():
        raise InputError("damping must be finite, and ≥ 0 on the diagonal: friction does not push")
    size = np.sqrt(np.outer(own, own))
    if (np.abs(values - values.T) > _ROUNDING * size).any():
        raise InputError(
            "damping must be symmetric: what is lost is q̇ᵀ δ q̇, and only (δ + δᵀ)/2 is in it; "
            "if your δ is right, give that"
        )
    matrix = (values + values.T) / 2
    scale = np.where(own > 0, np.sqrt(own), 1.0)
    least = float(np.linalg.eigvalsh(matrix / np.outer(scale, scale))[0])
    if least < -_ROUNDING * joints or (matrix[own == 0] != 0).any():
        raise InputError(
            "damping must have no negative eigenvalue: friction would drive some motion of the joints; "
            "for friction b at shafts that turn with A q̇ it is Aᵀ diag(b) A"
        )
    if not (matrix - np.diag(own)).any():
        return tuple(own.tolist())
    return tuple(map(tuple, matrix.tolist()))
