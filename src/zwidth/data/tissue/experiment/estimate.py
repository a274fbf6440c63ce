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

from typing import NamedTuple

import numpy as np

from zwidth.data.tissue.experiment.noise import Noise, likelihood, noise_of, with_memory
from zwidth.data.tissue.experiment.prediction import Task, derivatives, predicted
from zwidth.data.tissue.start import starting_points
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
        """W r and W J."""
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
