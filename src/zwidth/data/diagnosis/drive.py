"""What lies between the force that the law asked for and the one that the motor gave.

    a delay            f_a(t) = f(t − τ), cut off at ± L
    a damper inside    f_a(t) = f(t − τ₀) + B_d v(t − τ_d)
    a limit of rate    |df_a/dt| ≤ R

Each is fitted by least squares, and what it leaves unexplained says how well it accounts for the file.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from zwidth.native.compiled import Array, compiled

if TYPE_CHECKING:
    from numpy.typing import NDArray

STRAIGHT = 0.42
"""Share of the time in which a force changes as fast as it ever does, ± 15 %; a sine does so for 0.37."""

_TRIED = 40
_STEEP = (50, 70, 85, 90, 93, 95, 97, 99, 99.8)


@dataclass(frozen=True, kw_only=True)
class Drive:
    """What the drive does to a command; `by_…` is the share of the applied force's variance that is left over
    by each account of it, 0 by a full one."""

    delay: float
    """[s] τ of the best pure delay, of some forty in three quarters of a cycle."""
    delay_to_a_sample: float
    """[s] the best one near that, to a sample of the loop."""
    gain: float
    """How many times the delayed command the applied force is."""
    by_gain: float
    by_nothing: float
    by_delay: float
    by_damper: float
    by_rate: float
    damping: float
    """B_d [N·s/m; N·m·s/rad], positive where it brakes."""
    damping_lag: float
    """τ_d [s]."""
    rate: float
    """[N/s; N·m/s] R."""
    applied: Array = field(repr=False)
    """[N; N·m] the applied force in each row."""


def account(
    commanded: Array, applied: Array, position: Array, row_period: float, loop_period: float, cycle: float
) -> Drive:
    """Fit the three to a stretch; `cycle` is the period of the vibration [s]."""
    spread = float(np.var(applied)) or 1.0
    times = np.arange(applied.size, dtype=np.float64) * row_period
    skip = max(2, int(0.6 * cycle / row_period))
    used = slice(min(skip, applied.size // 4), None)
    step = min(loop_period, row_period) if row_period <= loop_period else loop_period
    lags = _lags(cycle, step)

    def left(model: Array) -> float:
        return float(np.mean((applied - model)[used] ** 2)) / spread

    def delayed_by(lag: float) -> Array:
        return _late(commanded, times, lag)

    top = float(np.abs(applied).max())
    delayed = {lag: np.clip(_late(commanded, times, lag), -top, top) for lag in lags}
    delay = min(lags, key=lambda lag: left(delayed[lag]))
    stride = round((lags[1] - lags[0]) / step)
    near = [delay + k * step for k in range(-stride + 1, stride) if delay + k * step > -0.5 * step]
    finer = min(near, key=lambda lag: left(np.clip(_late(commanded, times, lag), -top, top)))
    by_delay = min(left(delayed[delay]), left(np.clip(_late(commanded, times, finer), -top, top)))
    by_gain, multiple, rough = min((*_scaled(delayed_by(lag)[used], applied[used]), lag) for lag in lags)
    around = [rough + k * step / 2 for k in range(-2 * stride + 1, 2 * stride)]
    by_gain, multiple = min(_scaled(delayed_by(lag)[used], applied[used]) for lag in around)
    best, damping, damping_lag = np.inf, 0.0, 0.0
    speed = np.gradient(position, row_period)
    short = [lag for lag in lags if lag <= max(step, 0.0) * 1.01]
    free = _free(applied, used)
    for late in short:
        asked = _late(commanded, times, late)
        missing = applied - asked
        for lag in lags:
            v = _late(speed, times, lag)
            power = float(np.mean(v[free] ** 2))
            gain = float(np.mean((missing * v)[free])) / power if power else 0.0
            rest = left(np.clip(asked + gain * v, -top, top))
            if gain > 0 and rest < best:
                best, damping, damping_lag = rest, gain, lag
    rate, by_rate = min(
        (_rate(asked, applied, times, step, left) for asked in (commanded, np.clip(commanded, -top, top))),
        key=lambda found: found[1],
    )
    return Drive(
        delay=delay, delay_to_a_sample=finer, gain=multiple,
        by_gain=by_gain, by_nothing=left(np.clip(commanded, -top, top)), by_delay=by_delay,
        by_damper=min(best, 1.0), by_rate=by_rate, damping=damping, damping_lag=damping_lag, rate=rate,
        applied=applied,
    )  # fmt: skip


def inside(applied: Array, position: Array, row_period: float, cycle: float) -> float:
    """Share of an applied force's variance that a spring and a damper inside the drive leave over,

        f_a(t) = a + K x(t) + B_d v(t − τ_d),    K and B_d > 0, cut off where the file's own ends;

    1 where no such pair is found.  For a file that does not hold the command.
    """
    times = np.arange(applied.size, dtype=np.float64) * row_period
    used = slice(min(max(2, int(0.8 * cycle / row_period)), applied.size // 4), None)
    free = _free(applied, used)
    reach = max(1, round(cycle / 24 / row_period))
    speed = np.gradient(position, row_period)
    if position.size > 2 * reach:
        speed[reach:-reach] = (position[2 * reach :] - position[: -2 * reach]) / (2 * reach * row_period)
    ends = float(applied.min()), float(applied.max())
    spread, best = float(np.var(applied[used])) or 1.0, 1.0
    for lag in _lags(cycle, row_period):
        table = np.stack([position, _late(speed, times, lag), np.ones_like(times)], axis=1)
        terms = np.linalg.lstsq(table[free], applied[free], rcond=None)[0]
        if (terms[:2] > 0).all():
            rest = applied - np.clip(table @ terms, *ends)
            best = min(best, float(np.mean(rest[used] ** 2)) / spread)
    return best


def _scaled(asked: Array, given: Array) -> tuple[float, float]:
    """What a multiple of one force leaves of the other's variance, and the multiple, if it is positive."""
    asked, given = asked - asked.mean(), given - given.mean()
    gain = max(0.0, float(asked @ given) / (float(asked @ asked) or 1.0))
    return float(np.mean((given - gain * asked) ** 2)) / (float(np.mean(given**2)) or 1.0), gain


def _free(applied: Array, used: slice) -> NDArray[np.intp]:
    """Rows in which a force does not stand at its limit; all of them, where hardly any would be left."""
    rows = np.arange(applied.size)[used]
    size = np.abs(applied[rows])
    free = rows[size < 0.97 * size.max()]
    return free if free.size > 0.2 * rows.size else rows


def _lags(cycle: float, step: float) -> list[float]:
    """Up to three quarters of a cycle, in samples of the loop where those are not too many."""
    longest = 0.75 * cycle
    stride = step * max(1, int(np.ceil(longest / step / _TRIED)))
    return [float(lag) for lag in np.arange(0.0, longest + stride / 2, stride)]


def _late(values: Array, times: Array, lag: float) -> Array:
    return np.interp(times - lag, times, values)


def _rate(
    commanded: Array, applied: Array, times: Array, step: float, left: Callable[[Array], float]
) -> tuple[float, float]:
    """R that follows the applied force best when the command is followed no faster."""
    steep = np.abs(np.diff(applied)) / (times[1] - times[0])
    between = max(1, round((times[1] - times[0]) / step))
    fine = np.interp(
        np.arange(between * (times.size - 1) + 1) * ((times[1] - times[0]) / between), times, commanded
    )
    best, followed = (0.0, 1.0), np.empty_like(fine)
    for rate in np.unique(np.percentile(steep, _STEEP)):
        if rate > 0:
            _follow(fine, applied[0], rate * (times[1] - times[0]) / between, followed)
            model = followed[::between]
            rest = left(model)
            if rest < best[1]:
                best = (float(rate), rest)
    return best


@compiled
def _follow(commanded: Array, start: float, most: float, followed: Array) -> None:
    """Fill in the command followed by no more than so much a step, from the step after."""
    followed[0] = start
    for k in range(1, commanded.size):
        missing = commanded[k - 1] - followed[k - 1]
        followed[k] = followed[k - 1] + min(max(missing, -most), most)


def ramps(applied: Array) -> float:
    """Share of the time in which a force changes about as fast as it ever does."""
    steep = np.abs(np.diff(applied))
    top = float(np.percentile(steep, 97))
    return float((np.abs(steep - top) < 0.15 * top).mean()) if top else 0.0
