"""How late the force of the hand was recorded, beside the position and the actuator's force.

A force that is read τ late is f_h − τ ḟ_h, and takes c τ of mass and k τ of damping from the finger.  What is
left tells τ: by ẍ of the equation of motion of device and finger, M = m + m_h in all,

    −ḟ_h = m_h x⃛ + c ẍ + k ẋ,    M x⃛ = −ḟ_a − (b + c) ẍ − k ẋ
    f_h (t − τ) = … + γ ḟ_a,      γ = τ m_h/M                                                     (1)

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

from math import ceil
from typing import NamedTuple

import numpy as np

from zwidth.data.identification.device.choice import LONGER, SAFETY, SURE
from zwidth.data.identification.device.estimate import student
from zwidth.data.identification.finger.fit import FEWEST, Fit, fitted, without_slow
from zwidth.data.identification.finger.means import Means, Pieces, later, means
from zwidth.data.identification.finger.weights import Weights, weights
from zwidth.native.compiled import Array

LATER = (0.0, 1e-3, 2e-3, 3e-3, 5e-3, 8e-3, 12e-3)
"""By which the force is read later, in search of a large τ [s]."""


SHORTEST = 4
"""Samples of a quarter of a pulse: the shorter, the more is seen of the moment."""

LEAST = 0.5
"""Parts of a sample below which a lateness is not told from what friction and curves do to the fit."""

SURELY = 2.0
"""Times the reach of 99.9 % beyond which a force is late even if it was read before the step."""


class Lag(NamedTuple):
    """Where τ is, with 99.9 % [s].

    Parameters
    ----------
    least
        If the force was read at the later of the two moments that a sample may be.
    most
        If at the earlier one.
    seen
        True where τ = 0 is outside for the later moment, and for the earlier too where `sure`.
    sure
        See there.
    """

    least: float
    most: float
    seen: bool
    sure: bool


def lag_of(pieces: Pieces, shape: Weights, total: Fit, delay: float, period: float) -> Lag | None:
    """How late the force of the hand is beside the actuator's; None where nothing tells.

    `total` is the fit of device and finger to the actuator's force, whose delay is in samples.
    """
    other = weights(LONGER * shape.piece, delay)
    rows, longer = (means(pieces, s, period) for s in (shape, other))
    if rows is None or longer is None:
        return None
    tried = [round(seconds / period) for seconds in LATER]
    best = max(tried, key=lambda samples: _explained(later(rows, pieces, shape, samples)))
    here = _apparent(later(rows, pieces, shape, best), total, period)
    there = _apparent(later(longer, pieces, other, best), total, period)
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


def _apparent(rows: Means, total: Fit, period: float) -> tuple[float, float, int] | None:
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
    """By how much the actuator's steps look late where the force is in time: least and most [samples].

    Read first at the sample after it, and straight between samples, a step is half a sample before that
    sample.
    """
    if delay == int(delay):
        return -0.5, 0.5
    known = ceil(delay) - 0.5 - delay
    return known, known
