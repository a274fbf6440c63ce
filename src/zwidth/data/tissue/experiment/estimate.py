"""One model fitted to one test: generalized least squares, the noise estimated with it.

    min  | W (y − ŷ(θ, zero, surface, held)) |²

ŷ is the model under the measured history (`prediction`), so that a ramp counts as it was; W whitens the
noise, whose memory is estimated from what is left (`noise`), until both agree.  Fitted besides the
logarithms θ of the parameters: the zero of the response, the depth of the surface where the probe came from
outside, and what each branch holds after a hole.  Every model of a test has the same of them, so that none
may take for a fault of the sensor what another explains.

    cov = s² (JᵀWᵀWJ)⁻¹,    s² = |W r|²/(N − k)
"""

from __future__ import annotations

from math import log, sqrt
from typing import NamedTuple

import numpy as np

from zwidth.data.tissue.experiment.prediction import Task, derivatives, predicted
from zwidth.data.tissue.model import starting_points
from zwidth.errors import InputError
from zwidth.native.compiled import Array

REACH = 14.0
"""How far the logarithm of a parameter may go from where it began."""

AGREED = 0.05
"""Relative change of the memory below which fit and noise agree."""

SHARES = (0.4, 1.6)
"""Of the depth where the surface seems to be, from which it is searched too: after a ramp of few samples
several depths leave less than those beside them."""

ROUNDS = 4
FIRST, MOST = 8, 60
"""Evaluations of a search from each start, and of that from the best of them."""


class Solved(NamedTuple):
    """What was fitted, what is left, the derivatives, and the noise; all in parts of the output's size."""

    point: Array
    left: Array
    jacobian: Array
    noise: Noise

    @property
    def deviance(self) -> float:
        """−2 ln of the likelihood, up to a constant of the test."""
        return likelihood(self.noise, self.left)

    @property
    def whitened(self) -> tuple[Array, Array]:
        return self.noise.whitened(self.left), self.noise.whitened(self.jacobian)

    @property
    def numbers(self) -> int:
        """Fitted, with the noise's own."""
        return self.point.size + 1 + bool(self.noise.memory)


def solved(task: Task, near: Solved | None = None) -> Solved:
    """The fit of a task, from that of one much like it where there is one."""
    white = with_memory(task.test.time, 0.0)
    numbers = task.own + task.zero + task.surface + task.held
    if numbers >= task.test.time.size:
        raise InputError(
            f"{numbers} numbers are not fitted to {task.test.time.size} samples: take a model with fewer "
            "branches, or give a part with fewer holes in time"
        )
    if near is None:
        first = [_searched(task, start, white, FIRST) for start in _starts(task)]
        best = min(first, key=lambda each: each[1])[0]
        found = _with_noise(task, _searched(task, best, white)[0])
    else:
        found = _with_noise(task, _searched(task, near.point, near.noise)[0])
    for _ in range(ROUNDS):
        if not found.noise.memory and not _changed(found.noise, white):
            break
        before = found.noise
        found = _with_noise(task, _searched(task, found.point, before)[0])
        if not _changed(before, found.noise):
            break
    return found


def _changed(before: Noise, after: Noise) -> bool:
    largest = max(before.memory, after.memory)
    return largest > 0 and abs(before.memory - after.memory) > AGREED * largest


def _with_noise(task: Task, point: Array) -> Solved:
    left = predicted(task, point) - task.output / task.size
    jacobian = derivatives(task, point)
    return Solved(point, left, jacobian, noise_of(task.test.time, left, jacobian))


def _starts(task: Task) -> list[Array]:
    """Where the surface seems to be, several tissues; at other depths, the first of them."""
    surface = task.test.surface if task.surface else None
    tissues = [np.log(start) for start in starting_points(task.model, task.record(surface or 0.0))]
    if surface is None:
        return [_start(task, tissue, []) for tissue in tissues]
    at = [(tissue, 1.0) for tissue in tissues] + [(tissues[0], share) for share in SHARES]
    return [_start(task, tissue, [share * surface / task.way]) for tissue, share in at]


def _start(task: Task, tissue: Array, surface: list[float]) -> Array:
    return np.concatenate([tissue, np.zeros(int(task.zero)), surface, np.zeros(task.held)])


def _searched(task: Task, start: Array, noise: Noise, most: int = MOST) -> tuple[Array, float]:
    """The best point from a start, and the sum of squares there."""
    from scipy.optimize import least_squares

    output = task.output / task.size
    reach = np.where(np.arange(start.size) < task.own, REACH, np.inf)

    def within(point: Array) -> Array:
        return np.asarray(np.clip(point, start - reach, start + reach))

    found = least_squares(
        lambda p: noise.whitened(predicted(task, within(p)) - output),
        start,
        jac=lambda p: noise.whitened(derivatives(task, within(p))),
        method="lm",
        x_scale="jac",
        xtol=1e-9,
        ftol=1e-7,
        gtol=1e-12,
        max_nfev=most,
    )
    return within(found.x), float(found.cost)


def covariance(found: Solved) -> tuple[Array, float]:
    """Of what was fitted, and the condition number of the whitened derivatives."""
    left, jacobian = found.whitened
    n, k = jacobian.shape
    variance = float(left @ left) / max(n - k, 1)
    _, s, vt = np.linalg.svd(jacobian, full_matrices=False)
    kept = np.maximum(s, 1e-12 * s[0]) if s[0] > 0 else np.full(k, 1e-12)
    half = vt / kept[:, None]
    return variance * half.T @ half, float(s[0] / s[-1]) if s[-1] > 0 else float("inf")


# Noise that forgets: white, or with a memory that fades as exp(−t/τ), at any sampling.
#
#     E e_i e_j = γ exp(−|t_i − t_j|/τ)        white: τ = 0
#
#     ε_0 = e_0,    ε_k = (e_k − ρ_k e_{k−1})/√(1 − ρ_k²),    ρ_k = exp(−h_k/τ)
#
# are white of variance γ.  τ is where the restricted likelihood of what a fit leaves is largest (Patterson &
# Thompson, Biometrika 58, 1971): with r the residuals and J the derivatives, both whitened, N samples, k
# parameters,
#
#     −2 ln L = (N − k) ln(|r⊥|²/(N − k)) + Σ ln(1 − ρ_k²) + ln |JᵀJ|
#
# which, other than the likelihood, does not take the freedom of the fit for lack of noise.

SEEN = 4.0
"""Of −2 ln L, by which a memory must do better than none: some 5 % of white noise passes for more."""

LONGEST = 0.1
"""Of the test, beyond which a memory is no noise but a drift."""

_STEPS = 24


class Noise(NamedTuple):
    """The memory τ [s], 0 for white noise, and between samples ρ_k."""

    memory: float
    between: Array

    def whitened(self, values: Array) -> Array:
        """ε of e, along the first axis."""
        if not self.memory:
            return values
        rho = self.between if values.ndim == 1 else self.between[:, None]
        later = (values[1:] - rho * values[:-1]) / np.sqrt(1.0 - rho * rho)
        return np.concatenate([values[:1], later])

    @property
    def log_determinant(self) -> float:
        """Σ ln(1 − ρ_k²)."""
        return float(np.log1p(-self.between * self.between).sum()) if self.memory else 0.0

    @property
    def independent(self) -> float:
        """How many samples without memory would say as much of a constant."""
        if not self.memory:
            return float(self.between.size + 1)
        return 1.0 + float(((1.0 - self.between) / (1.0 + self.between)).sum())


def with_memory(time: Array, memory: float) -> Noise:
    """Noise of a memory τ [s]."""
    steps = np.diff(time)
    return Noise(memory, np.exp(-steps / memory) if memory else np.zeros(steps.size))


def noise_of(time: Array, residuals: Array, jacobian: Array) -> Noise:
    """The noise that the residuals show: white, unless a memory does better by more than `SEEN`."""
    white = with_memory(time, 0.0)
    steps = np.diff(time)
    low, high = (
        log(0.3 * float(np.quantile(steps, 0.1))),
        log(max(LONGEST * float(time[-1]), float(steps.max()))),
    )
    if not low < high:
        return white

    def missed(memory: float) -> float:
        return _restricted(with_memory(time, memory), residuals, jacobian)

    grid = np.linspace(low, high, _STEPS)
    found = [missed(float(np.exp(at))) for at in grid]
    best = int(np.argmin(found))
    if found[best] + SEEN > missed(0.0):
        return white
    return with_memory(time, float(np.exp(_vertex(grid, np.array(found), best))))


def _vertex(grid: Array, values: Array, best: int) -> float:
    """The lowest point of the parabola through three."""
    if best in (0, grid.size - 1):
        return float(grid[best])
    a, b, c = values[best - 1 : best + 2]
    bend = a - 2 * b + c
    return float(grid[best] + 0.5 * (a - c) / bend * (grid[1] - grid[0])) if bend > 0 else float(grid[best])


def _restricted(noise: Noise, residuals: Array, jacobian: Array) -> float:
    """−2 ln of the restricted likelihood, up to a constant."""
    table = noise.whitened(np.column_stack([jacobian, residuals]))
    square: Array = np.linalg.qr(table, mode="r")  # type: ignore[assignment]
    k, n = jacobian.shape[1], residuals.size
    left = max(float(square[k, k]) ** 2, np.finfo(float).tiny)
    sizes = np.abs(np.diag(square)[:k])
    return (
        (n - k) * log(left / (n - k))
        + noise.log_determinant
        + 2 * float(np.log(np.maximum(sizes, 1e-300)).sum())
    )


def likelihood(noise: Noise, residuals: Array) -> float:
    """−2 ln of the likelihood of residuals, its variance the most likely one, up to N (1 + ln 2π)."""
    white = noise.whitened(residuals)
    mean = max(float(white @ white) / white.size, float(np.finfo(float).tiny))
    return white.size * log(mean) + noise.log_determinant


# The ends of the interval of a number that is known to some tens of per cent only, by its likelihood.
#
# Of a branch that relaxes within a sample or two it is nearly the compliance 1/μ that is seen, not μ: an
# interval symmetric in ln μ lies too low, and where the likelihood is flat above it is too short.  So such a
# number is held away from where it was found and all else fitted anew (profile likelihood; Venzon &
# Moolgavkar, Applied Statistics 37, 1988), until the fit is worse by what chance does in one test of twenty:
#
#     (S(ln θ + δ) − S)/s² = t²,     S the least sum of squares, s² its variance, t of Student
#
# With σ the standard deviation of ln θ, δ = ± tσ (1 + c t): c = 0 is the usual interval.  It is found at 95 %
# on each side; at another level c is taken to be the same.

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
