"""The fit of a finger; and how late the force of the hand was recorded, beside position and actuator force.

A force that is read τ late is f_h − τ ḟ_h, and takes c τ of mass and k τ of damping from the finger.  What is
left tells τ: by ẍ of the equation of motion of device and finger, M = m + m_h in all,

    −ḟ_h = m_h x⃛ + c ẍ + k ẋ,    M x⃛ = −ḟ_a − (b + c) ẍ − k ẋ
   −f_h (t − τ) = … + γ ḟ_a,      γ = τ m_h/M                                                     (1)

so the actuator's steps are what is seen late, and tremor, which is not in ḟ_a, does not matter.  Where it
is not logged the force of the hand is read later, sample by sample, and what the fit leaves of each piece
is held against what it leaves of the same piece at the best moment: every moment that is not surely worse, by
Student's t of the differences, may be the right one.

A force that steps at a sample may be read before the step or after it: straight between samples, it then
steps half a sample late or early, and nothing in a log tells which.  So both show τ within half a sample
only, unless the actuator is known to step between two samples.  Derived here; checked on simulated
recordings.
"""

from __future__ import annotations

from functools import lru_cache
from math import ceil
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from zwidth.data.identification.device.choice import LONGER, SAFETY, SURE
from zwidth.data.identification.device.estimate import student, tells_apart
from zwidth.data.identification.finger.means import Means, Pieces, Weights, later, means, weights
from zwidth.native.compiled import Array

if TYPE_CHECKING:
    from numpy.typing import NDArray

LATER = (0.0, 1e-3, 2e-3, 3e-3, 5e-3, 8e-3, 12e-3)
"""By which the force is read later, in search of a large τ [s]."""

SHORTEST = 4
"""Samples of a quarter of a pulse: the shorter, the more is seen of the moment."""

LEAST = 0.5
"""Parts of a sample below which a lateness is not told from what friction and curves do to the fit."""

SURELY = 2.0
"""Times the reach of 99.9 % beyond which a force is late even if it was read before the step."""


class Lag(NamedTuple):
    """Where τ is, with 99.9 % [s]."""

    least: float
    """If the force was read at the later of the two moments that a sample may be."""
    most: float
    """If at the earlier one."""
    seen: bool
    """True where τ = 0 is outside for the later moment, and for the earlier too where `sure`."""
    sure: bool


def lag_of(pieces: Pieces, shape: Weights, total: Fit, delay: float, period: float) -> Lag | None:
    """How late the force of the hand is beside the actuator's; None where nothing tells. `total` is the fit
    of device and finger to the actuator's force, whose delay is in samples."""
    other = weights(LONGER * shape.piece, delay)
    rows, longer = (means(pieces, s, period) for s in (shape, other))
    if rows is None or longer is None:
        return None
    tried = [round(seconds / period) for seconds in LATER]
    best = max(tried, key=lambda samples: _explained(later(rows, pieces, shape, samples)))
    here = _apparent(later(rows, pieces, shape, best), total)
    there = _apparent(later(longer, pieces, other, best), total)
    if here is None or there is None:
        return None
    apart = SAFETY * abs(here[0] - there[0])
    reach = student(SURE, max(here[2], FEWEST)) * here[1] + apart
    early, late = _moments(delay)
    value = here[0] + best * period
    low, high = value - late * period, value - early * period
    seen = high > max(reach, LEAST * period)
    return Lag(max(low - reach, 0.0), max(high + reach, 0.0), seen, low - reach > 0)


def _explained(rows: Means) -> float:
    fit = fitted(rows, True, 0.0)
    return -np.inf if fit is None else fit.explained


def _apparent(rows: Means, total: Fit) -> tuple[float, float, int] | None:
    """τ as the actuator's steps have it, its standard error, and of how many pieces."""
    fit = fitted(rows, True, 0.0)
    if fit is None:
        return None
    part = max(abs(fit.values[0]), 1e-9) / max(total.values[0], 1e-9)
    return fit.further / part, fit.further_error / part, fit.pieces


def lag_without_actuator(pieces: Pieces, period: float) -> Lag | None:
    """How late the force of the hand is, where it alone is logged; None where nothing tells."""
    shape = weights(SHORTEST, 0.0)
    rows = means(pieces, shape, period)
    if rows is None:
        return None
    left = {round(seconds / period): np.empty(0) for seconds in LATER}
    left |= {samples: _left(later(rows, pieces, shape, samples)) for samples in left}
    middle = min(left, key=lambda samples: float(left[samples].sum()))
    near = {0, 1, *range(max(middle - 2, 0), middle + 3)} - set(left)
    left |= {samples: _left(later(rows, pieces, shape, samples)) for samples in near}
    best = min(left, key=lambda samples: float(left[samples].sum()))
    if left[best].size < FEWEST:
        return None
    worse = {samples: _worse(rest - left[best]) for samples, rest in left.items()}
    reach = student(SURE, left[best].size - 1)
    inside = [samples for samples, t in worse.items() if t <= reach]
    sure = min(inside) > 0 and worse.get(0, 0.0) > SURELY * reach
    least, most = max(min(inside) - 1, 0) * period, (max(inside) + 0.5) * period
    return Lag(least, most, max(inside) > 0, sure)


def _left(rows: Means) -> Array:
    """What the fit leaves of each piece, a mean over its pulses; a product of two halves, which noise is
    not in."""
    assert rows.hand is not None  # it is what may be late
    columns, piece = without_slow(
        np.column_stack([rows.even, rows.odd, -rows.hand]), rows.piece, np.arange(rows.piece.size)
    )
    even, odd, y = columns[:, :3], columns[:, 3:6], columns[:, 6]
    values = np.linalg.lstsq(even.T @ odd + odd.T @ even, (even + odd).T @ y, rcond=None)[0]
    starts = np.flatnonzero(np.diff(piece, prepend=-1))
    found: Array = np.add.reduceat((y - even @ values) * (y - odd @ values), starts)
    return found / np.diff(np.append(starts, piece.size))


def _worse(more: Array) -> float:
    """By how many standard errors more is left."""
    spread = float(more.std(ddof=1)) / np.sqrt(more.size)
    return float(more.mean()) / spread if spread > 0 else 0.0


def _moments(delay: float) -> tuple[float, float]:
    """By how much the actuator's steps look late where the force is in time: least and most [samples]. Read
    first at the sample after it, and straight between samples, a step is half a sample before that sample."""
    if delay == int(delay):
        return -0.5, 0.5
    known = ceil(delay) - 0.5 - delay
    return known, known


# Least squares with instruments over short pieces, what is slow taken out, the pieces as measure of scatter.
#
# θ = (Σ Zᵀ A)⁻¹ Σ Zᵀ y        V = (ZᵀA)⁻¹ (Σ_p g_p g_pᵀ) (ZᵀA)⁻ᵀ n/(n − 3),   g_p = Σ_{p} z (y − aᵀ θ)

TERMS = ("mass", "damping", "stiffness")

SLOW = 4
"""Numbers of a cubic."""

MOVING = 0.75
"""Part of a pulse during which the device surely moves."""

FEWEST = 10
"""Pieces more than terms below which no uncertainty is stated."""


class Fit(NamedTuple):
    values: Array
    """Mass, damping, stiffness."""
    covariance: Array
    pieces: int
    pulses: int
    explained: float
    further: float = 0.0
    further_error: float = 0.0
    """What was fitted besides, and its standard error; 0 where nothing was."""

    @property
    def errors(self) -> Array:
        return np.asarray(np.sqrt(np.diag(self.covariance)))


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
    return np.asarray(np.linalg.qr(np.vander(time / np.abs(time).max(), SLOW))[0])


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
