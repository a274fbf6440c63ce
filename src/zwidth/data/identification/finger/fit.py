"""Least squares with instruments over short pieces, what is slow taken out, the pieces as measure of scatter.

θ = (Σ Zᵀ A)⁻¹ Σ Zᵀ y        V = (ZᵀA)⁻¹ (Σ_p g_p g_pᵀ) (ZᵀA)⁻ᵀ n/(n − 3),   g_p = Σ_{p} z (y − aᵀ θ)
"""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from zwidth.data.identification.device.regression import tells_apart
from zwidth.data.identification.finger.means import Means
from zwidth.native.compiled import Array

if TYPE_CHECKING:
    from numpy.typing import NDArray

TERMS = ("mass", "damping", "stiffness")

SLOW = 4
"""Numbers of a cubic."""

MOVING = 0.75
"""Part of a pulse during which the device surely moves."""

FEWEST = 10
"""Pieces more than terms below which no uncertainty is stated."""


class Fit(NamedTuple):
    """θ.

    Parameters
    ----------
    values
        Mass, damping, stiffness.
    covariance
        V.
    pieces, pulses
        How many they rest on.
    explained
        r².
    further, further_error
        What was fitted besides, and its standard error; 0 where nothing was.
    """

    values: Array
    covariance: Array
    pieces: int
    pulses: int
    explained: float
    further: float = 0.0
    further_error: float = 0.0

    @property
    def errors(self) -> Array:
        """Standard errors."""
        found: Array = np.sqrt(np.diag(self.covariance))
        return found


def fitted(rows: Means | None, by_hand: bool, friction: float, resting: bool = False) -> Fit | None:
    """Mass, damping and stiffness of what meets a force; None where too little is known.

    By the hand: of the finger, from −f_h; else of device and finger, from −f_a − f_c sgn ẋ.  Where f_c is
    not 0 only pulses count that have no more than short turns, in which friction changes its sign in the
    middle, or is left out (`resting`).
    """
    if rows is None:
        return None
    force = rows.hand if by_hand else rows.actuator
    assert force is not None  # the question fits the channels
    sliding = not by_hand and friction > 0
    kept = rows.moving >= MOVING if sliding else np.ones(force.size, dtype=bool)
    force = -force - friction * (rows.side if resting else rows.turning) if sliding else -force
    steps = [rows.actuator_slope] if by_hand and rows.actuator_slope is not None else []
    groups = [rows.even, rows.odd, rows.expected if rows.expected is not None else rows.odd]
    columns, piece = without_slow(
        np.column_stack([*groups, *steps, force])[kept], rows.piece[kept], np.flatnonzero(kept)
    )
    even, odd, expected = (np.column_stack([columns[:, k : k + 3], columns[:, 9:-1]]) for k in (0, 3, 6))
    if rows.expected is not None:
        return solved([(expected, (even + odd) / 2)], columns[:, -1], piece)
    return solved([(even / 2, odd), (odd / 2, even)], columns[:, -1], piece)


def solved(pairs: list[tuple[Array, Array]], y: Array, piece: NDArray[np.int64]) -> Fit | None:
    """θ of y = aᵀ θ by pairs of instruments z and regressors a; None where too little is known."""
    starts = np.flatnonzero(np.diff(piece, prepend=-1))
    count = pairs[0][0].shape[1]
    if starts.size < FEWEST + count:
        return None
    matrix: Array = np.asarray(sum(z.T @ a for z, a in pairs))
    right = sum(z.T @ y for z, _ in pairs)
    if not tells_apart(matrix, 1e8):
        return None
    values: Array = np.asarray(np.linalg.solve(matrix, right), dtype=np.float64)
    scatter = sum(z * (y - a @ values)[:, None] for z, a in pairs)
    each = np.add.reduceat(scatter, starts)
    inverse = np.asarray(np.linalg.inv(matrix), dtype=np.float64)
    few = starts.size / (starts.size - count)
    covariance: Array = few * inverse @ (each.T @ each) @ inverse.T
    left = np.mean([y - a @ values for _, a in pairs], axis=0)
    some = slice(len(TERMS))
    besides = (float(values[-1]), float(np.sqrt(covariance[-1, -1]))) if count > len(TERMS) else (0.0, 0.0)
    explained = float(1 - left @ left / (y @ y))
    return Fit(values[some], covariance[some, some], starts.size, y.size, explained, *besides)


@lru_cache(maxsize=64)
def _cubic(place: tuple[int, ...]) -> Array:
    """Cubics of time, orthonormal; most pieces have their pulses at the same places."""
    time = np.array(place) - np.mean(place)
    found: Array = np.linalg.qr(np.vander(time / np.abs(time).max(), SLOW))[0]
    return found


def without_slow(
    columns: Array, piece: NDArray[np.int64], place: NDArray[np.int64]
) -> tuple[Array, NDArray[np.int64]]:
    """The columns less a cubic of time in each piece that is long enough, and the pieces they are of."""
    found, pieces = [np.empty((0, columns.shape[1]))], [np.empty(0, dtype=np.int64)]
    for rows in np.split(np.arange(len(columns)), np.flatnonzero(np.diff(piece)) + 1):
        if rows.size <= SLOW + 1:
            continue
        basis = _cubic(tuple((place[rows] - place[rows[0]]).tolist()))
        found.append(columns[rows] - basis @ (basis.T @ columns[rows]))
        pieces.append(piece[rows])
    return np.concatenate(found), np.concatenate(pieces)
