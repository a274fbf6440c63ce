"""Which law computed the force: stiffness, damping and its velocity estimate, compensation of friction, lag.

    f(t) = a + K x(t − s) + B (x(t − s) − x(t − s − N T))/(N T) − F tanh(v/v_s)

Every lag s, window N and speed v_s of a list is tried, and the terms are fitted by least squares.  The law is
the one of least BIC: what a term leaves unexplained must fall by more than chance would have it.  Rows where
the force stands at its limit or is off are left out.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from zwidth.native.compiled import Array

    Rows = NDArray[np.bool_]

WINDOWS = (1, 2, 3, 5, 8, 10, 15, 20)

_MOST_ROWS = 3000
_FEWEST_ROWS = 10
_BEST, _LIKELY = 3, 6
"""Combinations that are judged in all rows of a lag, and fitted in all rows of all lags."""

_SPEEDS = (0.0, 0.01, 0.03, 0.1, 0.3)
_FINER = (1.6, 1.3, 1.15, 1.08, 1.04, 1.02)
"""Candidates of v_s, in usual speeds, and steps about the best of them."""

_TELLS, _NEAR, _EDGE = 0.2, 0.02, 1e-4
"""Of a force from end to end: what rows must hold to be fitted alone; near an end; at a wall's edge."""

_EXACT = 1e-6
"""Share of a variance below which what is left over is rounding."""

_RIDGE = 1e-12
"""Keeps terms apart that are the same in a file, such as two windows over a square wave."""

_DAMPED = range(1, len(WINDOWS) + 1)
_HELPED = range(len(WINDOWS) + 1, len(WINDOWS) + 1 + len(_SPEEDS))
_COMBINATIONS = (
    np.array([(0,), *((k,) for k in _DAMPED)]),
    np.array([*((0, k) for k in _DAMPED), *((0, k) for k in _HELPED)]),
    np.array([(0, j, k) for j in _DAMPED for k in _HELPED]),
)
"""Terms that are tried together: spring, damper by a window, compensation with a speed."""


@dataclass(frozen=True, kw_only=True)
class Law:
    stiffness: float
    damping: float
    """K [N/m; N·m/rad] and B [N·s/m; N·m·s/rad]."""
    window: int
    """N, samples of the velocity estimate."""
    compensation: float
    compensation_speed: float
    """F [N; N·m] along the motion, 0 for none; v_s [m/s; rad/s]."""
    lag: float
    unexplained: float
    """Share of the force's variance that the law leaves over."""
    limited: float
    """Share of the time for which the force stands at its limit."""
    compensated: Array = field(repr=False)
    """[N; N·m] the force of F in each row."""
    transfer: tuple[Array, Array] | None = field(default=None, repr=False)
    """H(z) of a law that was stated, numerator and denominator; None of one that was found."""

    def damper(self, omegas: Array, period: float) -> NDArray[np.complex128]:
        """What the law asks for besides its spring, over the position, at some ω [rad/s]."""
        if self.transfer is not None:
            z = np.exp(1j * omegas * period)
            numerator, denominator = (np.polyval(part, z) for part in self.transfer)
            return np.asarray(numerator / denominator - self.stiffness)
        span = self.window * period
        return np.asarray(self.damping * (1 - np.exp(-1j * omegas * span)) / span)


def fit(
    position: Array, force: Array, row_period: float, loop_period: float, lags: Sequence[float]
) -> Law | None:
    """The law of a force in a stretch; None where it does not follow the motion at all."""
    sides = _at_ends(force)
    first = int(np.ceil((max(lags) + max(WINDOWS) * loop_period) / row_period)) + 1
    first = min(first, position.size // 2)
    rows = np.flatnonzero(free(force))
    rows = rows[rows >= first]
    if rows.size < _FEWEST_ROWS or np.ptp(force[rows]) < _TELLS * np.ptp(force):
        sides, rows = np.zeros_like(sides), np.arange(first, position.size)
    if rows.size < _FEWEST_ROWS or not np.ptp(force[rows]):
        return None
    rows = rows[:: max(1, rows.size // _MOST_ROWS)]
    times = np.arange(position.size, dtype=np.float64) * row_period
    everywhere = np.arange(first, position.size, max(1, (position.size - first) // _MOST_ROWS))
    usual = float(np.std(np.diff(position))) / row_period
    data = _Data(
        at=_between(position, times, row_period > 1.5 * loop_period), times=times, force=force, free=rows,
        everywhere=everywhere, loop_period=loop_period, speeds=[usual * share for share in _SPEEDS],
        ends=(float(force.min()), float(force.max())), side=float(np.sign(force.mean())),
    )  # fmt: skip
    tries = sorted((tried for lag in lags for tried in _at_lag(data, lag)), key=lambda tried: tried.bic)
    if not tries:
        return None
    between = (np.abs(force[:, None] - (*data.ends, 0.0)) > _NEAR * np.ptp(force)).all(axis=1)
    if between.sum() >= _FEWEST_ROWS:  # else it is ever at an end or off, and of many laws
        tries = sorted((_settled(data, tried) for tried in tries[:_LIKELY]), key=lambda tried: tried.bic)
    best = tries[0]
    named = dict.fromkeys(range(_HELPED.stop), 0.0) | dict(zip(best.part, best.terms.tolist(), strict=False))
    damped = next((k for k in best.part if k in _DAMPED), 1)
    helped = next((k for k in best.part if k in _HELPED), _HELPED.start)
    return Law(
        stiffness=named[0], damping=named[damped], window=WINDOWS[damped - 1], compensation=named[helped],
        compensation_speed=best.speed, lag=best.lag, unexplained=best.left, limited=float(sides.mean()),
        compensated=named[helped] * _columns(data, best.lag, slice(None), best.speed)[:, helped],
    )  # fmt: skip


def free(force: Array) -> Rows:
    """Rows in which a force is neither at its limit nor off."""
    size = np.abs(force)
    away = size < 0.01 * size.max()
    held = _at_ends(force) | (size >= 0.9995 * size.max())
    return np.asarray(~(held | away) if away.mean() > 0.05 else ~held)


def known(
    force: Array,
    *,
    stiffness: float,
    damping: float,
    compensation: tuple[float, float, Array],
    lag: float,
    unexplained: float,
    transfer: tuple[Array, Array],
) -> Law:
    """A law that was stated, as one that was found: H(z) at rest is the spring where it has none by name."""
    helps, speed, helped = compensation
    at_rest = float(np.sum(transfer[0]) / np.sum(transfer[1])) if np.sum(transfer[1]) else 0.0
    return Law(
        stiffness=stiffness or at_rest, damping=damping, window=1, compensation=helps,
        compensation_speed=speed, lag=lag, unexplained=unexplained, limited=float(_at_ends(force).mean()),
        compensated=helped, transfer=transfer,
    )  # fmt: skip


class _Tried(NamedTuple):
    bic: float
    left: float
    lag: float
    part: tuple[int, ...]
    terms: Array
    """Of the columns of `part`, then of 1."""
    speed: float
    wall: bool
    """Whether it acts on one side of a place."""


class _Data(NamedTuple):
    """What is fitted: the rows in which the force is free, and all of them, where it may be cut off."""

    at: Callable[[Array], Array]
    """The position at some times: along a cubic, where samples of the loop are not in the file."""
    times: Array
    force: Array
    free: NDArray[np.intp]
    everywhere: NDArray[np.intp]
    loop_period: float
    speeds: list[float]
    ends: tuple[float, float]
    side: float


def _at_lag(data: _Data, lag: float) -> list[_Tried]:
    """The best combinations of terms with one lag whose signs are those of a law: K > 0, B > 0, F > 0."""
    y = data.force[data.free]
    raw = _columns(data, lag, data.free)
    means = raw.mean(axis=0)
    table = raw - means
    scale = np.sqrt((table * table).mean(axis=0))
    scale[scale == 0] = 1.0
    table /= scale
    middle = float(y.mean())
    gram, answer, size = table.T @ table, table.T @ (y - middle), float(((y - middle) ** 2).sum())
    fits: list[tuple[float, tuple[int, ...], Array]] = []
    for parts in _COMBINATIONS:
        systems = gram[parts[:, :, None], parts[:, None, :]] + _RIDGE * y.size * np.eye(parts.shape[1])
        solved = np.linalg.solve(systems, answer[parts][:, :, None])[:, :, 0]
        explained = (solved * answer[parts]).sum(axis=1)
        for part, found, gained in zip(parts, solved, explained, strict=True):
            if (found > 0).all():
                left = max(size - float(gained), 0.0) / size
                bic = y.size * np.log(left + _EXACT) + part.size * np.log(y.size)
                fits.append((bic, tuple(part.tolist()), found / scale[part]))
    fits.sort(key=lambda fit: fit[0])
    speeds = (0.0, *data.speeds)
    everywhere = _columns(data, lag, data.everywhere)
    tries = []
    for _, part, terms in fits[:_BEST]:
        terms = np.append(terms, middle - float(means[[*part]] @ terms))
        speed = speeds[max(0, part[-1] - _DAMPED.stop + 1)]
        for wall in (False, True)[: 1 + (0 in part)]:
            tried = _Tried(np.inf, np.inf, lag, part, terms, speed, wall)
            tries.append(_judged(data, everywhere[:, [*part, -1]], tried)[0])
    return tries


def _columns(data: _Data, lag: float, rows: NDArray[np.intp] | slice, speed: float | None = None) -> Array:
    """x, v by each window, −tanh(v/v_s) of the last move by each speed, or by one, and 1."""
    here = data.times[rows] - lag
    x = data.at(here)
    moves = [(x - data.at(here - n * data.loop_period)) / (n * data.loop_period) for n in WINDOWS]
    speeds = data.speeds if speed is None else [speed] * len(_SPEEDS)
    bent = [-np.tanh(moves[0] / v) if v else -np.sign(moves[0]) for v in speeds]
    return np.stack([x, *moves, *bent, np.ones_like(x)], axis=1)


def _judged(data: _Data, table: Array, tried: _Tried) -> tuple[_Tried, Array, Array]:
    """In all rows, and what it asks for before it is cut off; outside a wall, spring and damper are 0."""
    y = data.force[data.everywhere]
    if tried.wall:
        spring = tried.terms[0] * table[:, 0] + tried.terms[-1]
        inside = data.side * spring > _EDGE * np.ptp(spring)
        table = np.where(np.array([*(k in _HELPED for k in tried.part), False]) | inside[:, None], table, 0.0)
    asked = table @ tried.terms
    left = float(((y - np.clip(asked, *data.ends)) ** 2).mean() / (np.var(y) or 1.0))
    bic = y.size * np.log(left + _EXACT) + (len(tried.part) + 2) * np.log(y.size)
    return tried._replace(left=left, bic=bic), table, asked


def _settled(data: _Data, tried: _Tried) -> _Tried:
    """Least squares of what is cut off, in all rows, and v_s between those of the list."""
    best = _cut_off(data, tried)
    for step in _FINER if tried.speed else ():
        near = (min(best.speed * by, data.speeds[-1]) for by in (step, 1 / step))
        best = min(best, *(_cut_off(data, best._replace(speed=v)) for v in near), key=lambda one: one.left)
    return best


def _cut_off(data: _Data, tried: _Tried) -> _Tried:
    """Fitted where neither the last fit nor the file is cut off, as long as that leaves less."""
    whole = _columns(data, tried.lag, data.everywhere, tried.speed)[:, [*tried.part, -1]]
    y = data.force[data.everywhere]
    (low, high), near = data.ends, _NEAR * (data.ends[1] - data.ends[0])
    best, table, asked = _judged(data, whole, tried)
    while True:
        free = ~((asked >= high) & (y > high - near) | (asked <= low) & (y < low + near))
        terms = np.asarray(np.linalg.lstsq(table[free], y[free], rcond=None)[0], dtype=np.float64)
        again, table, asked = _judged(data, whole, best._replace(terms=terms))
        if free.sum() < _FEWEST_ROWS or not (terms[:-1] > 0).all() or again.left >= 0.99 * best.left:
            return best
        best = again


def _between(position: Array, times: Array, missing: bool) -> Callable[[Array], Array]:
    if not missing:
        return lambda t: np.interp(t, times, position)
    from scipy.interpolate import CubicSpline  # scipy takes its time

    cubic = CubicSpline(times, position)
    return lambda t: np.asarray(cubic(np.clip(t, 0.0, times[-1])))


def _at_ends(force: Array) -> Rows:
    """Rows where the force stands still at its largest: exactly, or in noise for longer than a sine."""
    size = np.abs(force)
    top = float(np.percentile(size, 99.5))
    at = size >= 0.9995 * size.max()
    exact = np.asarray(at & (np.append(at[1:], False) | np.append(False, at[:-1])))  # with a neighbour
    if exact.sum() >= 6:
        return exact
    noisy = size >= 0.95 * top
    return np.asarray(noisy if noisy.mean() > 0.35 else np.zeros_like(noisy))
