"""A relaxation time longer than the test: what it is at least.

A test that ends before the force has faded shows how fast it fades, not where it ends: a larger branch that
relaxes later does as well, and the usual interval, which is that of a parabola, means little.  So the
slowest relaxation time τ is held at a value and all else is fitted anew (profile likelihood, Venzon &
Moolgavkar, Applied Statistics 37, 1988): it may be τ as long as

    (S(τ) − S)/s² ≤ t²,     S the least sum of squares, s² = S/(N − k), t of Student, one-sided 95 %

A Maxwell body is given a spring beside it: that nothing is left in the end is what such a test cannot show.
"""

from __future__ import annotations

from collections.abc import Callable
from math import exp, log
from typing import NamedTuple

import numpy as np
from scipy.special import stdtrit

from zwidth.data.tissue.experiment.estimate import Solved, solved
from zwidth.data.tissue.experiment.prediction import Task, derivatives, predicted
from zwidth.data.tissue.model import as_model
from zwidth.native.compiled import Array

ENOUGH = 1.0
"""Of the test, that the slowest relaxation time may last and still be seen to fade."""

FURTHEST = 1e3
"""Times the length of the test; a relaxation time of that is as good as none."""

SURE = 0.95
_HALVINGS = 14


class Slowest(NamedTuple):
    """The slowest relaxation time: as fitted, at least, and at most; None where there is no bound [s]."""

    fitted: float
    at_least: float | None
    at_most: float | None


def slowest_of(task: Task, found: Solved) -> Slowest | None:
    """What is known of the slowest relaxation time, where the test is too short for it; else None."""
    if not task.model.branches:
        return None
    length = float(task.test.time[-1])
    fitted = exp(max(found.point[k + 1] - found.point[k] for k in _springs(task)))
    if fitted < ENOUGH * length:
        return None
    if task.model.name == "maxwell":
        task = task._replace(model=as_model("standard-linear-solid", None, "force"))
        found = solved(task)
    branch = max(_springs(task), key=lambda k: found.point[k + 1] - found.point[k])
    own = float(found.point[branch + 1] - found.point[branch])
    left, jacobian = found.whitened
    variance = float(left @ left) / max(left.size - jacobian.shape[1], 1)
    most = float(stdtrit(max(found.noise.independent - jacobian.shape[1], 1.0), SURE)) ** 2

    def missed(at: float) -> float:
        return (_least(task, found, branch, at) - float(left @ left)) / variance - most

    low = _crossing(missed, own, min(own, log(length * 1e-3)))
    high = _crossing(missed, own, max(own, log(length * FURTHEST)))
    if high is not None and exp(high) < length:
        return None  # a spring beside the Maxwell body: the end is seen, and it is another model
    return Slowest(fitted, None if low is None else exp(low), None if high is None else exp(high))


def _springs(task: Task) -> list[int]:
    """The places of the branches' springs, each before its dashpot."""
    first = 0 if task.model.name == "maxwell" else 1
    return list(range(first, task.own, 2))


def _least(task: Task, found: Solved, branch: int, at: float) -> float:
    """The least sum of squares with a branch whose relaxation time has this logarithm."""
    from scipy.optimize import least_squares

    output = task.output / task.size
    others = np.delete(np.arange(found.point.size), branch + 1)

    def whole(point: Array) -> Array:
        filled = np.empty(found.point.size)
        filled[others] = point
        filled[branch + 1] = filled[branch] + at
        return filled

    def slopes(point: Array) -> Array:
        table = found.noise.whitened(derivatives(task, whole(point)))
        table[:, branch] += table[:, branch + 1]
        return table[:, others]

    costs = [
        least_squares(
            lambda point: found.noise.whitened(predicted(task, whole(point)) - output),
            start[others],
            jac=slopes,
            method="lm",
            x_scale="jac",
            ftol=1e-7,
            max_nfev=60,
        ).cost
        for start in (found.point, _as_steep(found.point, branch, at))
    ]
    return float(2.0 * min(costs))


def _as_steep(point: Array, branch: int, at: float) -> Array:
    """The solid whose branch fades as steeply when it is met, as far as the spring beside it allows."""
    spring, own = np.exp(point[0]), np.exp(point[branch])
    wanted = own * np.exp(at - point[branch + 1] + point[branch])
    moved = point.copy()
    moved[branch] = np.log(min(wanted, 0.999 * (spring + own)))
    moved[0] = np.log(max(spring + own - wanted, 0.001 * (spring + own)))
    return moved


def _crossing(missed: Callable[[float], float], inside: float, outside: float) -> float | None:
    """Where a function that is negative inside becomes positive; None where it does not."""
    if missed(outside) <= 0:
        return None
    for _ in range(_HALVINGS):
        middle = 0.5 * (inside + outside)
        inside, outside = (inside, middle) if missed(middle) > 0 else (middle, outside)
    return outside
