"""One decaying mode under samples joined by straight lines, stepped without error.

    ẏ = ẋ − r y:    y ← y e + Δx (1 − e)/(r h),    e = exp(−r h)

The force of a Maxwell branch is μ y; a mode of creep is Δ(input) less such a y.
"""

from __future__ import annotations

from math import exp, expm1

import numpy as np
from numpy.typing import ArrayLike

from zwidth.errors import InputError
from zwidth.native.compiled import Array, compiled


def samples(time: ArrayLike, values: ArrayLike, name: str) -> tuple[Array, Array]:
    """Times and values as two arrays of one length.

    Raises
    ------
    InputError
        If they are not two at least, finite, of one length, the times increasing.
    """
    t, x = (np.array(part, dtype=float, ndmin=1) for part in (time, values))
    if t.ndim != 1 or t.shape != x.shape or t.size < 2:
        raise InputError(
            f"time and {name} are two arrays of one length, two samples at least; got {t.shape} and {x.shape}"
        )
    if not (np.isfinite(t).all() and np.isfinite(x).all()):
        raise InputError(f"time and {name} must be finite: leave out the samples that were not measured")
    if (np.diff(t) <= 0.0).any():
        raise InputError("the times must increase from sample to sample")
    return t, x


@compiled
def _decay(h: Array, moved: Array, rate: float, y: float, out: Array) -> None:
    last, e, share = -1.0, 1.0, 1.0
    out[0] = y
    for k in range(h.size):
        if h[k] != last:
            last = h[k]
            e = exp(-rate * last)
            share = -expm1(-rate * last) / (rate * last)
        y = y * e + moved[k] * share
        out[k + 1] = y


def decaying(h: Array, moved: Array, rate: float, start: float = 0.0) -> Array:
    """y at each sample, from `start`, under steps `moved` over times `h` [unit of x]; rate r > 0 [1/s]."""
    out = np.empty(h.size + 1)
    _decay(h, moved, rate, start, out)
    return out
