"""How well the parameters are known: their covariance where the noise has a memory.

The residuals e are taken as an autoregressive process, A e = ε with ε white of variance σ², of the order
that BIC prefers; 0 is white noise.  The estimate is that of ordinary least squares, whose covariance then
is

    (JᵀJ)⁻¹ Jᵀ Ω J (JᵀJ)⁻¹,     Ω = σ² A⁻¹ A⁻ᵀ

J the derivatives of the prediction by the logarithms of the parameters.  White noise gives the usual σ²
(JᵀJ)⁻¹.  A memory leaves fewer independent samples than there are, N_e = N γ0 A(1)²/σ² ≤ N with γ0 the
variance of e: the fit has taken k of them, so that Ω is multiplied by N_e/(N_e − k) and Student's t has N_e
− k degrees of freedom. Assumed: the model is right, the noise of zero mean, stationary and as likely in
every sample, small enough for the linear J, and the input free of it.
"""

from __future__ import annotations

from math import log
from typing import NamedTuple

import numpy as np

from zwidth.native.compiled import Array, compiled

LARGEST_ORDER = 12
"""Of the noise; a memory longer than so many samples is cut."""

_SMALLEST = 1e-12
"""Singular values below this share of the largest are rounding."""


class Noise(NamedTuple):
    """A e = ε: 1, a1 … ap; the variance of ε; and how many samples would say as much without memory, N_e."""

    coefficients: Array
    variance: float
    samples: float

    @property
    def order(self) -> int:
        """p; 0 for white noise."""
        return self.coefficients.size - 1


def noise_of(residuals: Array, largest_order: int = LARGEST_ORDER) -> Noise:
    """The autoregressive process of the order that BIC prefers, by Levinson's recursion."""
    n = residuals.size
    largest = min(largest_order, n // 20)
    covariances = [float(residuals[k:] @ residuals[: n - k]) / n for k in range(largest + 1)]
    floor = np.finfo(float).tiny
    a, variance = np.ones(1), max(covariances[0], floor)
    best, score = Noise(a, variance, n), n * log(variance)
    for p in range(1, largest + 1):
        reflection = -sum(a[i] * covariances[p - i] for i in range(p)) / variance
        a = np.append(a, 0.0) + reflection * np.append(a, 0.0)[::-1]
        variance = max(variance * (1.0 - reflection**2), floor)
        if n * log(variance) + p * log(n) < score:
            fewer = n * min(covariances[0] * float(a.sum()) ** 2 / variance, 1.0)
            best, score = Noise(a, variance, fewer), n * log(variance) + p * log(n)
    return best


def coloured(coefficients: Array, white: Array) -> Array:
    """Noise of white noise, column by column: y(k) = w(k) − Σ a_i y(k − i)."""
    found = np.empty(white.shape)
    _colour(coefficients, np.ascontiguousarray(white), found)
    return found


@compiled
def _colour(coefficients: Array, white: Array, found: Array) -> None:
    for k in range(white.shape[0]):
        for column in range(white.shape[1]):
            before = 0.0
            for i in range(min(k, coefficients.shape[0] - 1), 0, -1):
                before -= coefficients[i] * found[k - i, column]
            found[k, column] = before + white[k, column]


def by_chance(value: float, degrees: int) -> float:
    """How seldom a sum of so many squares of white noise, each of variance 1, is larger."""
    from scipy.special import chdtrc  # scipy.stats, which has it too, takes four times as long to load

    return float(chdtrc(degrees, max(value, 0.0))) if degrees > 0 else float("nan")


def covariance(jacobian: Array, noise: Noise) -> tuple[Array, float]:
    """The covariance of the parameters, and the condition number of the Jacobian."""
    u, s, vt = np.linalg.svd(jacobian, full_matrices=False)
    largest = s[0] if s.size and s[0] > 0.0 else 1.0
    kept = np.maximum(s, _SMALLEST * largest)
    back = coloured(noise.coefficients, u[::-1])
    k = jacobian.shape[1]
    scale = noise.variance * noise.samples / max(noise.samples - k, 1.0)
    half = back / kept @ vt
    return scale * half.T @ half, float(largest / s[-1]) if s[-1] > 0.0 else float("inf")
