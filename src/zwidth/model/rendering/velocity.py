"""Velocity estimators that are not linear, or know the encoder, and how the compiled laws call them.

Packed as kind, then the estimator's numbers.  The linear ones, which have a transfer function and so
certificates, are in `environment.velocity`.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import sqrt
from typing import Any, ClassVar, Literal

from zwidth.errors import InputError
from zwidth.model.rendering.reading import given_or_known, known
from zwidth.model.rendering.rendering_law import LoopContext, SteppedLaw
from zwidth.native.compiled import Array, compiled
from zwidth.quantity.exact import Exact
from zwidth.quantity.parameter import PLAIN, CertainOrNone, Count, exact, parameter, part, plain, word


def as_estimator(velocity: Estimator | None) -> Estimator:
    """The estimator; by default the adaptive window."""
    chosen: Any = AdaptiveWindow() if velocity is None else velocity
    if not isinstance(chosen, Estimator):
        raise InputError(
            f"velocity is AdaptiveWindow(), TickTime() or Kalman(), got {type(chosen).__name__}; the linear "
            "ones are a wall's velocity_filter, and AdaptiveWindow(longest=1) is the backward difference"
        )
    return chosen


def estimated() -> Any:
    """The field `velocity` of a law that needs one."""
    return part(
        "velocity",
        lambda given, _: as_estimator(given),
        None,
        meaning="adaptive-window (default), tick-time, kalman, or a table of one of them",
    )


def packed(estimator: Estimator, at: LoopContext) -> list[float]:
    """The numbers that `estimate` reads."""
    return [estimator.kind, *estimator.numbers(at)]


@compiled
def estimate(p: Array, i: int, s: Array, j: int, x: float) -> float:
    """v̂ of one sample [m/s; rad/s]; p from i and s from j on are the estimator's."""
    kind = p[i]
    if kind == ADAPTIVE_WINDOW:
        return adaptive_window_step(p, i + 1, s, j, x)
    if kind == TICK_TIME:
        return tick_time_step(p, i + 1, s, j, x)
    if kind == KALMAN:
        return kalman_step(p, i + 1, s, j, x)
    return 0.0


@dataclass(frozen=True, kw_only=True)
class Estimator(SteppedLaw):
    """A law v̂(x_k, x_{k−1}, …) for the laws that need a velocity."""

    kind: ClassVar[float]
    """Which step `estimate` takes; its own for each estimator."""


# Velocity over the longest window in which the readings can be a straight line.
#
#     v̂ = (x_k − x_{k−n})/(n T)                         end fit
#     v̂ = 6 Σ (2i − n)(x_k − x_{k−i})/(n (n+1) (n+2) T)   best fit, i = 0 … n: least squares
#
# n grows from 1 as long as the line through x_k with that slope passes all readings of
# the window within d.  First-order adaptive windowing, Janabi-Sharifi, Hayward & Chen (2000).
#
# At constant speed a reading is less than one count below the truth, so that with d = Δ the
# end fit always takes the longest window N and errs by less than Δ/(N T); the backward
# difference errs by up to Δ/T.  Where the hand accelerates the window shortens.

ADAPTIVE_WINDOW = 1.0

_WINDOW_PERIOD, _NOISE, _LONGEST, _BEST = range(4)
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

    noise: CertainOrNone = exact(
        "position",
        None,
        "≥ 0",
        "it is how far a reading may be off",
        "d, how far a reading may be off, by default one count",
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
    def state_size(self) -> int:  # type: ignore[override]  # as many as the window is long
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
        noise = self.with_unit("noise", motion) or "one count"
        return f"adaptive window of up to {self.longest} samples within {noise}, {self.fit} fit"


@compiled
def adaptive_window_step(p: Array, i: int, s: Array, j: int, x: float) -> float:
    """One sample; p from i and s from j on are this estimator's."""
    size = int(p[i + _LONGEST]) + 1
    head = (int(s[j + _HEAD]) + 1) % size
    s[j + _HEAD], s[j + _RING + head] = float(head), x
    if p[i + _BEST] > 0.0:
        slope = _best_fit(s, j + _RING, head, size, x, p[i + _NOISE])
    else:
        slope = _end_fit(s, j + _RING, head, size, x, p[i + _NOISE])
    return slope / p[i + _WINDOW_PERIOD]


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


# Velocity from the time between two ticks of the encoder, for a hand slower than a count per sample.
#
#     v̂ = ± c Δ/(n T)              at a tick: c edges on, n samples after the tick before
#     v̂ = ± min(|v̂|, Δ/(n T))      without one: had it been faster, the next edge would have come
#
# The first edge after a turn is the one that was crossed last: c is then one less, and a hand that trembles
# about one edge has no velocity.  The clock is that of the samples, so that the time, and the velocity, is
# good to one part in n; from one count per sample on it is the backward difference.
#
# Timing ticks is as old as counting them (Brown, Schneider & Mulligan 1992 compare the two);
# how it decays and turns is derived for this project.

TICK_TIME = 2.0

_TICK_PERIOD, _COUNT = range(2)
_BEFORE, _TICK_VELOCITY, _WAITED, _SIDE = range(4)

_FOR_EVER = 1e15


@dataclass(frozen=True, kw_only=True)
class TickTime(Estimator):
    """Counts over the time since the last tick, decaying while no tick comes.  No parameters.

    With an ideal sensor, Δ = 0, every sample is a tick: the backward difference.
    """

    kind: ClassVar[float] = TICK_TIME

    state_size: ClassVar[int] = 4
    """Last reading, velocity, samples since the last tick, its direction."""

    def numbers(self, at: LoopContext) -> list[float]:
        """T and Δ."""
        return [at.period, known(at, "resolution", "the time between ticks needs the resolution")]

    def initial_state(self, reading: float) -> list[float]:
        """The last tick was for ever ago."""
        return [reading, 0.0, _FOR_EVER, 0.0]

    def describe(self, motion: str = "linear") -> str:
        return "time between ticks"


@compiled
def tick_time_step(p: Array, i: int, s: Array, j: int, x: float) -> float:
    """One sample; p from i and s from j on are this estimator's."""
    moved, velocity = x - s[j + _BEFORE], s[j + _TICK_VELOCITY]
    waited = s[j + _WAITED] + 1.0
    time = waited * p[i + _TICK_PERIOD]
    if moved == 0.0:
        most = p[i + _COUNT] / time
        velocity = min(max(velocity, -most), most)
        if most == 0.0:
            waited = 0.0
    else:
        side = 1.0 if moved > 0.0 else -1.0
        crossed = abs(moved)
        if s[j + _SIDE] == -side:
            crossed = max(crossed - p[i + _COUNT], 0.0)
        velocity = side * crossed / time
        waited = 0.0
        s[j + _SIDE] = side
    s[j + _BEFORE], s[j + _TICK_VELOCITY], s[j + _WAITED] = x, velocity, waited
    return velocity


# Velocity by a Kalman filter that has settled: white acceleration, readings wrong by quantization.
#
#     e = x − (x̂ + T v̂)        x̂ ← x̂ + T v̂ + α e        v̂ ← v̂ + β e/T
#
# Of acceleration of density q and readings of variance R = Δ²/12, with λ = q T³/R,
#
#     p = √λ + √(16 + λ/3),   s = 4/(p + √(p² − 16)),   α = 1 − s²,   β = s √λ
#
# Derived for this project: the innovations e of the settled filter have variance S = R/(1 − α), and 1 + (α +
# β − 2) z⁻¹ + (1 − α) z⁻² times them is the second difference of the readings, whose spectrum is q T³ (2 +
# cos θ)/3 + R (2 − 2 cos θ)²; compare at θ = 0 and π.  Without quantization α = 1, β = 3 − √3.
#
# An estimate of velocity for haptics by Kalman filter: Bélanger, Dobrovolny, Helmy & Zhang (1998).

KALMAN = 3.0

_KALMAN_PERIOD, _ALPHA, _BETA = range(3)
_POSITION, _KALMAN_VELOCITY = range(2)

_WANDERING = 10
"""Samples in which a hand at rest wanders by a count, if nothing else is said."""


@dataclass(frozen=True)
class Kalman(Estimator):
    """Steady-state Kalman filter of position and velocity with constant gains.

    Parameters
    ----------
    acceleration
        √q, the density of the hand's acceleration, > 0 [(m/s²)/√Hz; (rad/s²)/√Hz]; None:
        √(3 Δ²/(10 T)³), which moves a hand at rest one count in ten samples, root mean square.
        The filter then forgets within three samples.

    Raises
    ------
    InputError
        If it is not > 0.
    """

    kind: ClassVar[float] = KALMAN
    state_size: ClassVar[int] = 2

    acceleration: CertainOrNone = exact(
        plain("acceleration", "√q in (m/s²)/√Hz or (rad/s²)/√Hz, a plain number"),
        None,
        "> 0",
        "a hand that never accelerates has no velocity to estimate",
    )

    def numbers(self, at: LoopContext) -> list[float]:
        """T, α and β/T."""
        resolution = known(at, "resolution", "the noise of the readings is the resolution's")
        wanders = sqrt(3 * resolution**2 / (_WANDERING * at.period) ** 3)
        density = wanders if self.acceleration is None else float(self.acceleration)
        alpha, beta = gains(density, resolution, at.period)
        return [at.period, alpha, beta / at.period]

    def describe(self, motion: str = "linear") -> str:
        unit = "(rad/s²)/√Hz" if motion == "rotary" else "(m/s²)/√Hz"
        of = "a count in ten samples" if self.acceleration is None else f"{self.acceleration:g} {unit}"
        return f"Kalman filter for {of}"


def gains(density: float, resolution: float, period: float) -> tuple[float, float]:
    """(α, β) for √q [(m/s²)/√Hz], Δ [m] and T [s]."""
    if resolution == 0.0:
        return 1.0, 3.0 - sqrt(3.0)
    root = density * sqrt(12.0 * period**3) / resolution  # √λ
    p = root + sqrt(16.0 + root * root / 3.0)
    s = 4.0 / (p + sqrt(p * p - 16.0))
    return (1.0 - s) * (1.0 + s), s * root


@compiled
def kalman_step(p: Array, i: int, s: Array, j: int, x: float) -> float:
    """One sample; p from i and s from j on are this estimator's."""
    expected = s[j + _POSITION] + p[i + _KALMAN_PERIOD] * s[j + _KALMAN_VELOCITY]
    error = x - expected
    s[j + _POSITION] = expected + p[i + _ALPHA] * error
    s[j + _KALMAN_VELOCITY] += p[i + _BETA] * error
    return s[j + _KALMAN_VELOCITY]
