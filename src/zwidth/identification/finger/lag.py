"""How late the force of the hand was recorded, beside the position and the actuator's force.

A force that is read τ late is f_h − τ ḟ_h, and takes c τ of mass and k τ of damping from the finger.  What is
left tells τ: by ẍ of the equation of motion of device and finger, M = m + m_h in all,

    −ḟ_h = m_h x⃛ + c ẍ + k ẋ,    M x⃛ = −ḟ_a − (b + c) ẍ − k ẋ
    f_h (t − τ) = … + γ ḟ_a,      γ = τ m_h/M                                                     (1)

so with the actuator's force its steps are what is seen late; without it ẋ, ẍ, x and −ḟ_h are fitted together (2).

A force that steps at a sample may be read before the step or after it: straight between samples, it then
steps half a sample late or early, and nothing in a log tells which.  So what (1) and (2) show is τ within half
a sample, unless the actuator is known to step between two samples.  A large τ is looked for by reading the
force later, until the rest is smallest.  Derived here; checked on simulated recordings.
"""

from __future__ import annotations

from math import ceil
from typing import NamedTuple

import numpy as np
from scipy import stats

from zwidth.identification.device.choice import LONGER, SAFETY, SURE
from zwidth.identification.finger.fit import FEWEST, TERMS, Fit, fitted, solved, without_slow
from zwidth.identification.finger.means import Means, Pieces, later, means
from zwidth.identification.finger.weights import Weights, weights

LATER = (0.0, 1e-3, 2e-3, 3e-3, 5e-3, 8e-3, 12e-3)
"""By which the force is read later, in search of a large τ [s]."""


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


def lag_of(pieces: Pieces, shape: Weights, total: Fit | None, delay: float, period: float) -> Lag | None:
    """How late the force of the hand is; None where nothing tells.

    Parameters
    ----------
    pieces
        The recording.
    shape
        The pulse.
    total
        Mass, damping and stiffness of device and finger by the actuator's force; None where it is not logged.
    delay
        From a sample to its actuator force [samples].
    period
        T [s].
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
    reach = float(stats.t.ppf(0.5 + SURE / 2, max(here[2], FEWEST))) * here[1] + apart
    early, late = _moments(delay if total is not None else 0.0)
    value = here[0] + best * period
    low, high = value - late * period, value - early * period
    return Lag(max(low - reach, 0.0), max(high + reach, 0.0), high - reach > 0, low - reach > 0)


def _explained(rows: Means) -> float:
    fit = fitted(rows, True, 0.0)
    return -np.inf if fit is None else fit.explained


def _apparent(rows: Means, total: Fit | None, period: float) -> tuple[float, float, int] | None:
    """τ as it looks, its standard error, and of how many pieces."""
    fit = fitted(rows, True, 0.0) if total is not None else _with_slope(rows)
    if fit is None:
        return None
    if total is None:
        return -fit.further, fit.further_error, fit.pieces
    part = max(abs(fit.values[0]), 1e-9) / max(total.values[0], 1e-9)
    return fit.further / part, fit.further_error / part, fit.pieces


def _with_slope(rows: Means) -> Fit | None:
    """Mass, damping, stiffness and −τ by the even and the odd samples."""
    assert rows.hand is not None and rows.hand_slope is not None  # noqa: PT018
    columns, piece = without_slow(
        np.column_stack([rows.even, -rows.hand_slope[:, :1], rows.odd, -rows.hand_slope[:, 1:], -rows.hand]),
        rows.piece,
        np.arange(rows.piece.size),
    )
    count = len(TERMS) + 1
    even, odd = columns[:, :count], columns[:, count:-1]
    return solved([(even / 2, odd), (odd / 2, even)], columns[:, -1], piece)


def _moments(delay: float) -> tuple[float, float]:
    """By how much a step of the actuator looks late where the force is in time, at least and at most [samples].

    Read first at the sample after it, and straight between samples, a step is half a sample before that sample.
    """
    if delay == int(delay):
        return -0.5, 0.5
    known = ceil(delay) - 0.5 - delay
    return known, known
