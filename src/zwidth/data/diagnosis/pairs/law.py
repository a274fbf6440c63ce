"""Which law an arm of a pair was moved by: stiffness, damping, how old its own reading was and the other's.

    f(t) = a + K (x(t − s) − x'(t − s − d)) + B (v(t − s) − v'(t − s − d)) + D v(t − s) − F sgn v(t − s)

x is the arm's own position, x' the other's, v the difference of the last two readings.  Every pair of lags
of a list is tried, the terms are fitted by least squares, and the law is the one of least BIC.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

_MOST_ROWS = 2000
_FEWEST_ROWS = 30
_EXACT = 1e-9
_FREE = 0.8
"""Of the largest force: what is larger may have been cut off."""

_MODELS = ((0,), (0, 1), (0, 2), (0, 3), (0, 1, 2), (0, 1, 3), (0, 2, 3), (0, 1, 2, 3))
"""Terms that are tried together: K, B, D, F."""


@dataclass(frozen=True, kw_only=True)
class ArmLaw:
    """What an arm's force was computed from.

    Parameters
    ----------
    stiffness, damping, local_damping
        K [N/m; N·m/rad], B and D [N·s/m; N·m·s/rad].
    compensation
        F [N; N·m] along the motion; 0 for none.
    lag
        [s] s, from the arm's own position to its force.
    link_delay
        [s] d, by how much the other's reading is older.
    unexplained
        Share of the force's variance that is left over.
    helped
        [N; N·m] the force of F in each row.
    """

    stiffness: float
    damping: float
    local_damping: float
    compensation: float
    lag: float
    link_delay: float
    unexplained: float
    helped: Array = field(repr=False)


def fit(
    own: Array,
    other: Array,
    force: Array,
    row_period: float,
    loop_period: float,
    lags: Sequence[float],
    links: Sequence[float],
) -> ArmLaw | None:
    """The law of one arm in a stretch; None where its force does not follow the arms."""
    times = np.arange(own.size, dtype=np.float64) * row_period
    first = int(np.ceil((max(lags) + max(links) + loop_period) / row_period)) + 1
    rows = np.flatnonzero(np.abs(force) < _FREE * np.abs(force).max())
    rows = rows[rows >= min(first, own.size // 2)]
    if rows.size < _FEWEST_ROWS or not np.ptp(force[rows]):
        return None
    rows = rows[:: max(1, rows.size // _MOST_ROWS)]
    y = force[rows]
    best: tuple[float, tuple[int, ...], Array, float, float] | None = None
    for lag in lags:
        x, v = _read(own, times, times[rows] - lag, loop_period)
        for link in links:
            there, going = _read(other, times, times[rows] - lag - link, loop_period)
            table = np.stack([x - there, v - going, v, -np.sign(v)], axis=1)
            for model, terms, left in _fitted(table, y):
                bic = y.size * np.log(left + _EXACT) + len(model) * np.log(y.size)
                if best is None or bic < best[0] - 1e-9:
                    best = (bic, model, terms, lag, link)
    if best is None:
        return None
    _, model, terms, lag, link = best
    gains = dict(zip(model, map(float, terms), strict=True))
    _, moved = _read(own, times, times - lag, loop_period)
    left = float(np.exp((best[0] - len(model) * np.log(y.size)) / y.size) - _EXACT)
    return ArmLaw(
        stiffness=gains[0], damping=gains.get(1, 0.0), local_damping=gains.get(2, 0.0),
        compensation=gains.get(3, 0.0), lag=lag, link_delay=link, unexplained=max(left, 0.0),
        helped=-gains.get(3, 0.0) * np.sign(moved),
    )  # fmt: skip


def _read(position: Array, times: Array, at: Array, loop_period: float) -> tuple[Array, Array]:
    """x and the difference of the last two readings, at some instants."""
    x = np.interp(at, times, position)
    return x, (x - np.interp(at - loop_period, times, position)) / loop_period


def _fitted(table: Array, y: Array) -> list[tuple[tuple[int, ...], Array, float]]:
    """Each model with K, B and F > 0: its terms, and what they leave over."""
    centred, wanted = table - table.mean(axis=0), y - y.mean()
    size = float(wanted @ wanted)
    norm = np.sqrt((centred**2).sum(axis=0))
    norm[norm == 0] = 1.0
    unit = centred / norm
    gram, answer = unit.T @ unit, unit.T @ wanted
    found: list[tuple[tuple[int, ...], Array, float]] = []
    for model in _MODELS:
        index = list(model)
        system = gram[np.ix_(index, index)] + 1e-12 * np.eye(len(index))
        terms = np.linalg.solve(system, answer[index])
        if all(value > 0 for term, value in zip(model, terms, strict=True) if term != 2):
            left = max(size - float(terms @ answer[index]), 0.0) / size
            found.append((model, terms / norm[index], left))
    return found
