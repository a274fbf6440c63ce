"""A friction curve that lies below the data: a lower bound of the mean friction in each bin of speed.

    f_i = f̄_i − t σ_i        σ_i² = n/(n − 1) Σ_s (Σ_{k ∈ s} (f_k − f̄_i))² / N_i²

with f_k the friction of pulse k against its motion, s the n strokes that have pulses in the bin,
N_i its pulses.  What one stroke has too much of counts once, however many pulses it has.  All
bounds hold together with the stated confidence: each has the B-th part of the risk (Bonferroni).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

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

    speed = np.abs(points["speed"].values)
    friction = points["friction"].values * np.sign(points["speed"].values)
    stroke = points["stroke"].values
    order = np.argsort(speed, kind="stable")
    rows = []
    for part in np.array_split(order, bins):
        if part.size:
            rows.append(_bin(speed[part], friction[part], stroke[part]))
    kept = [row for row in rows if row[3] >= FEWEST_STROKES]
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


def _bin(speed: Array, friction: Array, stroke: Array) -> tuple[float, float, float, int]:
    mean = float(friction.mean())
    _, member = np.unique(stroke, return_inverse=True)
    sums = np.bincount(member, friction - mean)
    count = sums.size
    spread = float(sums @ sums) * count / max(count - 1, 1)
    return float(speed.mean()), mean, float(np.sqrt(spread)) / speed.size, count


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
    return FrictionCurve(found["speed"].values.tolist(), low.tolist())


def lower_bounds(found: xr.Dataset, confidence: float) -> Array:
    """Of the bins' friction, all together with this confidence, not below 0 [N; N·m]."""
    each = 1 - (1 - confidence) / found.sizes["bin"]
    reach = stats.t.ppf(each, found["strokes"].values - 1)
    low: Array = np.maximum(found["friction"].values - reach * found["error"].values, 0.0)
    return low
