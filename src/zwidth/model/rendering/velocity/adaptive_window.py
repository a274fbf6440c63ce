"""Velocity over the longest window in which the readings can be a straight line.

    v̂ = (x_k − x_{k−n})/(n T)                         end fit
    v̂ = 6 Σ (2i − n)(x_k − x_{k−i})/(n (n+1) (n+2) T)   best fit, i = 0 … n: least squares

n grows from 1 as long as the line through x_k with that slope passes all readings of
the window within d.  First-order adaptive windowing, Janabi-Sharifi, Hayward & Chen (2000).

At constant speed a reading is less than one count below the truth, so that with d = Δ the
end fit always takes the longest window N and errs by less than Δ/(N T); the backward
difference errs by up to Δ/T.  Where the hand accelerates the window shortens.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal

from zwidth.errors import InputError
from zwidth.model.rendering.defaults import given_or_known
from zwidth.model.rendering.rendering_law import LoopContext
from zwidth.model.rendering.velocity.estimator import Estimator
from zwidth.native.compiled import Array, compiled
from zwidth.quantity.exact import Exact
from zwidth.quantity.parameter import PLAIN, CertainOrNone, Count, parameter, word

ADAPTIVE_WINDOW = 1.0

_PERIOD, _NOISE, _LONGEST, _BEST = range(4)
_HEAD, _RING = range(2)

_EDGE = 1.0 + 1e-9
"""Readings are whole counts, and often just d off a line: rounding must not decide there."""

LARGEST_WINDOW = 1000


def _samples(longest: Exact) -> int:
    if longest.fraction.denominator != 1 or longest > LARGEST_WINDOW:
        raise InputError(
            f"longest is a whole number of samples from 1 to {LARGEST_WINDOW}, got {longest:g}: a window "
            "longer than that lags behind every hand"
        )
    return int(longest)


@dataclass(frozen=True)
class AdaptiveWindow(Estimator):
    """First-order adaptive windowing: slope of the longest line that fits the readings.

    Parameters
    ----------
    noise
        d, how far a reading may be off the line [m; rad]; None: the encoder's resolution.
    longest
        N, the longest window [samples], 1 to 1000; 1 is the backward difference.
    fit
        "end": through the two ends; "best": least squares, which takes N²/2 steps.

    Raises
    ------
    InputError
        If d < 0, N is not such a number, or the fit is none of these.
    """

    kind: ClassVar[float] = ADAPTIVE_WINDOW

    noise: CertainOrNone = parameter(
        "position",
        None,
        kept=Exact,
        bound="≥ 0",
        why="it is how far a reading may be off",
        meaning="d, how far a reading may be off, by default one count",
    )
    longest: Count = parameter(
        PLAIN,
        15,
        kept=_samples,
        bound="> 0",
        why="it counts samples",
        meaning="N, the longest window in samples, by default 15",
    )
    fit: Literal["end", "best"] = word("end", "best")

    @property
    def state_size(self) -> int:
        """Where the newest reading is, and N + 1 readings."""
        return self.longest + 2

    def numbers(self, at: LoopContext) -> list[float]:
        """T, d, N and whether the best fit is taken."""
        noise = given_or_known(self.noise, at, "resolution", "noise")
        return [at.period, noise * _EDGE, float(self.longest), float(self.fit == "best")]

    def initial_state(self, reading: float) -> list[float]:
        """All readings the same."""
        return [0.0] + [reading] * (self.longest + 1)

    def describe(self, motion: str = "linear") -> str:
        """In a few words."""
        noise = self.with_unit("noise", motion) or "one count"
        return f"adaptive window of up to {self.longest} samples within {noise}, {self.fit} fit"


@compiled
def step(p: Array, i: int, s: Array, j: int, x: float) -> float:
    """One sample; p from i and s from j on are this estimator's."""
    size = int(p[i + _LONGEST]) + 1
    head = (int(s[j + _HEAD]) + 1) % size
    s[j + _HEAD], s[j + _RING + head] = float(head), x
    if p[i + _BEST] > 0.0:
        slope = _best_fit(s, j + _RING, head, size, x, p[i + _NOISE])
    else:
        slope = _end_fit(s, j + _RING, head, size, x, p[i + _NOISE])
    return slope / p[i + _PERIOD]


@compiled
def _end_fit(s: Array, ring: int, head: int, size: int, x: float, noise: float) -> float:
    """Per sample; the slopes that pass all readings so far lie between `low` and `high`."""
    result, low, high = 0.0, -1e300, 1e300
    for n in range(1, size):
        moved = x - s[ring + (head - n + size) % size]
        slope = moved / n
        if slope < low or slope > high:
            break
        result = slope
        low, high = max(low, (moved - noise) / n), min(high, (moved + noise) / n)
    return result


@compiled
def _best_fit(s: Array, ring: int, head: int, size: int, x: float, noise: float) -> float:
    """Per sample; the sums grow by one reading at a time, the line is tested against all of them."""
    result, total, weighted = 0.0, 0.0, 0.0
    for n in range(1, size):
        moved = x - s[ring + (head - n + size) % size]
        total += moved
        weighted += n * moved
        slope = 6.0 * (2.0 * weighted - n * total) / (n * (n + 1.0) * (n + 2.0))
        for m in range(1, n + 1):
            if abs(x - s[ring + (head - m + size) % size] - slope * m) > noise and n > 1:
                return result
        result = slope
    return result
