"""A friction curve that lies below the data: a lower bound of the mean friction in each bin of speed.

    f_i = f̄_i − t σ_i        σ_i² = n/(n − 1) Σ_s (Σ_{k ∈ s} r_k)² / N_i²

with f̄_i the mean friction of the N_i pulses against their motion, r_k what a straight line of
speed leaves of that of pulse k, s the n strokes that have pulses in the bin.  What one stroke has
too much of counts once, however many pulses it has.

A first point, at rest, lies as far below the first bound as friction could fall with an upper bound of
its slope over the slower half.  A last point, at the largest speed, lies on a line from the last bound
whose slope is a lower bound too, that of friction over the quicker half of the pulses: a model below
the curve takes its damping from there, and two bounds beside each other may be steeper than what they
bound.  All bounds, B and the two slopes, hold together with the stated confidence: each has the
(B + 2)-th part of the risk (Bonferroni).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy import stats

from zwidth.device.friction import FrictionCurve
from zwidth.errors import InputError

if TYPE_CHECKING:
    import xarray as xr

    from zwidth.compiled import Array

FEWEST_STROKES = 8
"""In a bin: fewer say too little about their own scatter."""


def friction_bins(points: xr.Dataset, bins: int) -> xr.Dataset:
    """Mean speed and mean friction by speed, each bin with as many pulses.

    Parameters
    ----------
    points
        Of an `Identified`.
    bins
        How many; fewer where the strokes are few.

    Returns
    -------
    xarray.Dataset
        Along `bin`: speed, friction, its standard error, and the strokes in it.
    """
    import xarray as xr

    columns = _against(points)
    rows = [
        _line(*part) for part in zip(*(np.array_split(c, bins) for c in columns), strict=True) if part[0].size
    ]
    kept = [
        (row.speed, row.friction, row.error, row.strokes) for row in rows if row.strokes >= FEWEST_STROKES
    ]
    table = np.array(kept, dtype=np.float64).reshape(-1, 4).T
    units = {key: points[key].attrs["units"] for key in ("speed", "friction")}
    return xr.Dataset(
        {
            "speed": ("bin", table[0], {"units": units["speed"], "long_name": "mean speed"}),
            "friction": ("bin", table[1], {"units": units["friction"], "long_name": "mean friction"}),
            "error": ("bin", table[2], {"units": units["friction"], "long_name": "standard error"}),
            "strokes": ("bin", table[3], {"units": "1", "long_name": "strokes in the bin"}),
        }
    )


class _Line(NamedTuple):
    """A straight line through some pulses: at their mean speed, its slope, and the errors of both."""

    speed: float
    friction: float
    error: float
    slope: float
    slope_error: float
    strokes: int


def _line(speed: Array, friction: Array, stroke: Array) -> _Line:
    mean, away = float(friction.mean()), speed - speed.mean()
    square = float(away @ away) or 1.0
    slope = float(away @ friction) / square
    left = friction - mean - slope * away
    _, member = np.unique(stroke, return_inverse=True)
    sums, moments = np.bincount(member, left), np.bincount(member, left * away)
    few = sums.size / max(sums.size - 1, 1)
    return _Line(
        float(speed.mean()),
        mean,
        float(np.sqrt(few * (sums @ sums))) / speed.size,
        slope,
        float(np.sqrt(few * (moments @ moments))) / square,
        sums.size,
    )


def _against(points: xr.Dataset) -> tuple[Array, Array, Array]:
    """Speed, friction against the motion and stroke of every pulse, slow ones first."""
    velocity = points["speed"].values
    order = np.argsort(np.abs(velocity), kind="stable")
    friction = points["friction"].values * np.sign(velocity)
    return np.abs(velocity)[order], friction[order], points["stroke"].values[order]


def curve_below(points: xr.Dataset, confidence: float, bins: int) -> FrictionCurve:
    """The lower bounds as a friction curve, see `Identified.friction_curve`."""
    if not 0 < confidence < 1:
        raise InputError(
            f"confidence must be between 0 and 1, got {confidence!r}: it is how often all the bounds hold"
        )
    if not bins >= 2:
        raise InputError(f"a friction curve needs two bins of speed or more, got {bins!r}")
    found = friction_bins(points, bins)
    if found.sizes["bin"] < 2:
        raise InputError(
            "the strokes are too few for a friction curve: no two bins of speed have "
            f"{FEWEST_STROKES} strokes each; record longer"
        )
    low = lower_bounds(found, confidence)
    speed, friction, stroke = _against(points)
    half = speed.size // 2
    slow, quick = (
        _line(speed[part], friction[part], stroke[part]) for part in (slice(None, half), slice(half, None))
    )
    each = _each(found, confidence)
    steepest = max(slow.slope + _reach(slow, each) * slow.slope_error, 0.0)
    slope = max(quick.slope - _reach(quick, each) * quick.slope_error, 0.0)
    first, last = (float(found["speed"][k]) for k in (0, -1))
    rest = max(float(low[0]) - steepest * first, 0.0)
    beyond = max(float(speed[-1]), 1.01 * last)
    end = float(low[-1]) + slope * (beyond - last)
    return FrictionCurve([0.0, *found["speed"].values.tolist(), beyond], [rest, *low.tolist(), end])


def _reach(line: _Line, confidence: float) -> float:
    return float(stats.t.ppf(confidence, max(line.strokes - 1, 1)))


def lower_bounds(found: xr.Dataset, confidence: float) -> Array:
    """Of the bins' friction, together with the slopes beside them, not below 0 [N; N·m]."""
    reach = stats.t.ppf(_each(found, confidence), found["strokes"].values - 1)
    low: Array = np.maximum(found["friction"].values - reach * found["error"].values, 0.0)
    return low


def _each(found: xr.Dataset, confidence: float) -> float:
    """Confidence of one bound, for all of them together to have the stated one."""
    return 1 - (1 - confidence) / (found.sizes["bin"] + 2)
