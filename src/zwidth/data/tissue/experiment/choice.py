"""Which model it is: the corrected AIC, the noise's own memory in the likelihood; and what it cannot tell.

    AICc = −2 ln L + 2 k + 2 k (k + 1)/(N − k − 1)

k numbers fitted, those of the noise among them; N samples (Sugiura, 1978; Hurvich & Tsai, Biometrika 76,
1989).  L is that of noise whose memory was estimated for this very model, so that neither a memory of the
noise nor the sampling rate makes large models look good.

Taken is the model of fewest numbers among those within `APART` of the least.  Not told apart from it are all
others within, but for those that only add to it and gain nothing by that.
"""

from __future__ import annotations

from collections.abc import Callable
from math import exp, log
from typing import NamedTuple

import numpy as np
from scipy.special import stdtrit

from zwidth.data.tissue.experiment.estimate import Solved, solved
from zwidth.data.tissue.experiment.history import History, about_surface
from zwidth.data.tissue.experiment.prediction import Fine, Task, derivatives, fines_of, predicted
from zwidth.data.tissue.findings import by_chance
from zwidth.data.tissue.model import Model, as_model
from zwidth.errors import InputError
from zwidth.native.compiled import Array

APART = 6.0
"""Difference of AICc beyond which a model is told apart: the other is exp(−3), a twentieth, as likely."""

MODELS = (
    ("kelvin-voigt", None),
    ("maxwell", None),
    ("standard-linear-solid", None),
    ("generalized-maxwell", 2),
    ("generalized-maxwell", 3),
    ("hunt-crossley", None),
)

SEEN = 2.0
"""Of AICc, by which a surface must do better than none."""

FELT = 0.1
"""Standard deviations, below which nobody asks which curve the probe took between samples."""

UNLIKELY = 1e-3
"""Chance below which what is left over is no noise."""

LAGS = 8


class Tried(NamedTuple):
    """A model as it was fitted, its AICc, and how far curves between the samples that fit nearly as well
    move the numbers: Σ w d dᵀ, w the Akaike weights (Buckland, Burnham & Augustin, Biometrics 53, 1997)."""

    task: Task
    found: Solved
    criterion: float
    apart: Array | None = None


def understood(test: History, zero: bool) -> History:
    """The test with a surface where two branches do better with one, else without. A model with a branch too
    few would take the other for a surface."""
    if test.surface is None:
        return test
    alone, fines = test._replace(surface=None), fines_of(test)
    model = as_model("generalized-maxwell", 2, "force")
    without, with_one = (_tried(model, each, fines, zero) for each in (alone, test))
    depth = float(with_one.found.point[with_one.task.own + zero]) * with_one.task.way
    if without.criterion - with_one.criterion < SEEN or depth <= 0:
        return alone
    return test._replace(surface=depth, findings=(*test.findings, about_surface(depth)))


def tried(test: History, zero: bool, names: tuple[str, ...] = ()) -> list[Tried]:
    """Every model that such a test allows, the smallest AICc first. A third branch is tried where the second
    was worth its numbers."""
    every: list[Tried] = []
    fines = fines_of(test)
    for model in _models(test):
        if names and not {label(model), model.name} & set(names):
            continue
        if not names and model.branches > 2 and not _gained(every):
            continue
        try:
            every.append(_tried(model, test, fines, zero))
        except InputError:  # a contact that does not push in four samples has no place to begin
            if names:
                raise
    return sorted(every, key=lambda each: each.criterion)


def _gained(every: list[Tried]) -> bool:
    """True where two branches did better than one."""
    by_branches = {
        each.task.model.branches: each.criterion for each in every if each.task.model.name != "maxwell"
    }
    return by_branches.get(2, np.inf) < by_branches.get(1, np.inf)


def _models(test: History) -> list[Model]:
    response = "position" if test.kind == "creep" else "force"
    most = (test.time.size - 4) // 2
    models = [as_model(n, b, "force") for n, b in MODELS if response == "force" or n != "hunt-crossley"]
    return [model for model in models if len(model.parameters) <= most]


def label(model: Model) -> str:
    """As it is called where several have branches: "generalized-maxwell-3"."""
    return f"{model.name}-{model.branches}" if model.name == "generalized-maxwell" else model.name


def _tried(model: Model, test: History, fines: list[Fine], zero: bool) -> Tried:
    """With the curve between the samples that leaves least, where it matters which. Each but the first, which
    is smooth, must do better than it by more than `SEEN`."""
    task = Task(model, test, fines[0], zero)
    every = [Tried(task, found := solved(task), criterion(found) - SEEN)]
    for fine in fines[1:]:
        other = task._replace(fine=fine)
        if all(_matters(one.task, other, one.found) for one in every):
            again = solved(other, found)
            every.append(Tried(other, again, criterion(again)))
    best = min(every, key=lambda each: each.criterion)
    weights = [np.exp(0.5 * (best.criterion - each.criterion)) for each in every]
    moved = [each.found.point - best.found.point for each in every]
    apart = sum(w / sum(weights) * np.outer(d, d) for w, d in zip(weights, moved, strict=True))
    return best._replace(criterion=criterion(best.found), apart=np.asarray(apart))


def _matters(one: Task, other: Task, found: Solved) -> bool:
    """Whether two curves may move a number by more than `FELT` of its standard deviation."""
    apart = found.noise.whitened(predicted(one, found.point) - predicted(other, found.point))
    left, _ = found.whitened
    return float(apart @ apart) > FELT**2 * float(left @ left) / left.size


def criterion(found: Solved) -> float:
    """AICc, up to a constant of the test."""
    n, k = found.left.size, found.numbers
    return found.deviance + 2 * k + 2 * k * (k + 1) / max(n - k - 1, 1)


def taken(every: list[Tried]) -> int:
    """The place of the model that is taken, of those in the order of their AICc."""
    least = every[0].criterion
    within = [k for k, each in enumerate(every) if each.criterion - least <= APART]
    return min(within, key=lambda k: (every[k].task.own, k))


def not_told_apart(every: list[Tried], chosen: int) -> tuple[int, ...]:
    """The places of other models that the test does not tell from the one that is taken."""
    least, own = every[0].criterion, every[chosen]
    return tuple(
        k
        for k, each in enumerate(every)
        if k != chosen
        and each.criterion - least <= APART
        and not (_adds_to(each.task.model, own.task.model) and each.criterion > own.criterion)
    )


def _adds_to(larger: Model, smaller: Model) -> bool:
    """True where the larger model has the smaller one as a special case, or a limit."""
    both = larger.linear and smaller.linear
    return both and len(larger.parameters) > len(smaller.parameters)


def leftover(found: Solved) -> float:
    """How seldom noise would be so much like itself a moment before: p of Ljung & Box (1978)."""
    left, _ = found.whitened
    n = left.size
    lags = min(LAGS, n // 5)
    size = float(left @ left)
    if not size or np.sqrt(size / n) < 1e-9:
        return 1.0
    r = np.array([float(left[k:] @ left[:-k]) / size for k in range(1, lags + 1)])
    value = n * (n + 2) * float((r**2 / (n - np.arange(1, lags + 1))).sum())
    return by_chance(value, lags - bool(found.noise.memory))


# A relaxation time longer than the test: what it is at least.
#
# A test that ends before the force has faded shows how fast it fades, not where it ends: a larger branch that
# relaxes later does as well, and the usual interval, which is that of a parabola, means little.  So the
# slowest relaxation time τ is held at a value and all else is fitted anew (profile likelihood, Venzon &
# Moolgavkar, Applied Statistics 37, 1988): it may be τ as long as
#
#     (S(τ) − S)/s² ≤ t²,     S the least sum of squares, s² = S/(N − k), t of Student, one-sided 95 %
#
# A Maxwell body is given a spring beside it: that nothing is left in the end is what such a test cannot show.

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
