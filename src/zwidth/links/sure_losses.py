"""What friction has surely taken, from the counts of an encoder.

Over n periods in which the reading changes by N counts the device has gone s = (|N| − 1)₊ Δ at least, so that

    b s²/(n T) + f_c s

is lost at least: b ∫v² ≥ b s²/(n T) by Cauchy and Schwarz.  Losses of periods that do not overlap add, so

    V_k = max over n of V_{k−n} + b s²/(n T) + f_c s

is lost by sample k at least: slow motion is seen in long windows, quick motion in short ones.  n is a power
of two here.  Where Δ = 0 one period is the best window.
"""

from __future__ import annotations

import numpy as np

from zwidth.links.memory import COULOMB, DAMPING, LOSSES, PERIOD, RESOLUTION
from zwidth.native.compiled import Array, compiled

ROUNDING = 2.0**-48
"""Of sums of a few terms, and of the device's numbers: all is rounded to the side of less energy."""

WINDOW = 64
_AT, _SINCE = LOSSES, LOSSES + 1
"""Sample, in the ring; how many samples there are behind it."""
_COUNTS = LOSSES + 2
_LOST = _COUNTS + WINDOW
SIZE = 2 + 2 * WINDOW


@compiled
def newly_lost(p: Array, s: Array, moved: float) -> float:
    """V_k − V_{k−1} [J], for the displacement that was read over the period."""
    step = p[RESOLUTION]
    if step == 0.0:
        return at_least(p, abs(moved), 1.0)
    before = int(s[_AT])
    now = (before + 1) % WINDOW
    if now == 0:  # told from here: sums of much energy would lose the digits of little
        base = s[_LOST + before]
        for k in range(WINDOW):
            s[_LOST + k] -= base
    counts = s[_COUNTS + before] + np.floor(moved / step + 0.5)
    lost, n = s[_LOST + before], 1
    while n < WINDOW and n <= s[_SINCE] + 1.0:
        then = (now + WINDOW - n) % WINDOW
        sure = (abs(counts - s[_COUNTS + then]) - 1.0) * step
        more, base = at_least(p, max(sure, 0.0), float(n)), s[_LOST + then]
        lost = max(lost, base + more - ROUNDING * (abs(base) + more))
        n *= 2
    gain: float = lost - s[_LOST + before]
    s[_COUNTS + now], s[_LOST + now], s[_AT] = counts, lost, float(now)
    s[_SINCE] = min(s[_SINCE] + 1.0, float(WINDOW))
    return gain


@compiled
def at_least(p: Array, way: float, n: float) -> float:
    """b s²/(n T) + f_c s."""
    lost: float = (p[DAMPING] * way / (n * p[PERIOD]) + p[COULOMB]) * way
    return lost
