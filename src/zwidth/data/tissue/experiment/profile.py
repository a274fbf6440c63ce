"""The ends of the interval of a number that is known to some tens of per cent only, by its likelihood.

Of a branch that relaxes within a sample or two it is nearly the compliance 1/μ that is seen, not μ: an
interval symmetric in ln μ lies too low, and where the likelihood is flat above it is too short.  So such a
number is held away from where it was found and all else fitted anew (profile likelihood; Venzon &
Moolgavkar, Applied Statistics 37, 1988), until the fit is worse by what chance does in one test of twenty:

    (S(ln θ + δ) − S)/s² = t²,     S the least sum of squares, s² its variance, t of Student

With σ the standard deviation of ln θ, δ = ± tσ (1 + c t): c = 0 is the usual interval.  It is found at 95 %
on each side; at another level c is taken to be the same.
"""

from __future__ import annotations

from math import log, sqrt
from typing import NamedTuple

import numpy as np

from zwidth.data.tissue.experiment.estimate import Solved, covariance
from zwidth.data.tissue.experiment.prediction import Task, derivatives, predicted
from zwidth.native.compiled import Array

CURVED = 0.03
"""Standard deviation of a logarithm, below which the usual interval will do."""

LOOSE = 1.0
"""Beyond which nothing is known, and no interval means much."""

FURTHEST = log(20.0)
"""How far an end may be from the estimate; there it is cut."""

CLOSE = 0.03
"""Of t, within which an end is found."""

_TRIES, _MOST = 8, 30


def bends(task: Task, found: Solved) -> list[tuple[float, float]]:
    """c below and above, of each parameter of the model."""
    from scipy.special import stdtrit

    spread = covariance(found)[0]
    free = max(found.noise.independent - found.jacobian.shape[1], 1.0)
    least = float(stdtrit(free, 0.975))
    return [
        (_bend(task, found, spread, place, -least), _bend(task, found, spread, place, least))
        for place in range(task.own)
    ]


class _At(NamedTuple):
    """A distance δ, how many standard deviations worse the best fit there is, and where that lies."""

    away: float
    worse: float
    point: Array


def _bend(task: Task, found: Solved, spread: Array, place: int, t: float) -> float:
    """c on the side that t is on."""
    sigma = sqrt(spread[place, place])
    if not CURVED <= sigma <= LOOSE:
        return 0.0
    away = _end(task, found, spread[:, place] / spread[place, place], place, t)
    return (away / (t * sigma) - 1.0) / abs(t)


def _end(task: Task, found: Solved, others: Array, place: int, t: float) -> float:
    """δ on the side that t is on, sought between where the number was found and the furthest, from both."""
    left, jacobian = found.whitened
    cost = float(left @ left)
    variance = cost / max(left.size - jacobian.shape[1], 1)

    def at(away: float, starts: list[Array]) -> _At:
        for start in starts:
            start[place] = found.point[place] + away
        point, least = min((_least(task, found, start, place) for start in starts), key=lambda each: each[1])
        return _At(away, sqrt(max(least - cost, 0.0) / variance), point)

    near = _At(0.0, 0.0, found.point)
    far = at(FURTHEST if t > 0 else -FURTHEST, [found.point.copy()])
    if far.worse <= abs(t):
        return far.away
    for _ in range(_TRIES):
        share = (abs(t) - near.worse) / (far.worse - near.worse)
        away = near.away + min(max(share, 0.05), 0.95) * (far.away - near.away)
        here = at(away, [near.point + others * (away - near.away), far.point.copy()])
        if abs(here.worse - abs(t)) < CLOSE * abs(t):
            return away
        near, far = (here, far) if here.worse < abs(t) else (near, here)
    return far.away


def _least(task: Task, found: Solved, start: Array, place: int) -> tuple[Array, float]:
    """The best point with one number held where it is, and the sum of squares there."""
    from scipy.optimize import least_squares

    output = task.output / task.size
    others = np.delete(np.arange(start.size), place)

    def whole(point: Array) -> Array:
        filled = start.copy()
        filled[others] = point
        return filled

    fit = least_squares(
        lambda point: found.noise.whitened(predicted(task, whole(point)) - output),
        start[others],
        jac=lambda point: found.noise.whitened(derivatives(task, whole(point)))[:, others],
        method="lm",
        x_scale="jac",
        ftol=1e-6,
        max_nfev=_MOST,
    )
    return whole(fit.x), float(2.0 * fit.cost)
