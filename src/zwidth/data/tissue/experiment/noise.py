"""Noise that forgets: white, or with a memory that fades as exp(−t/τ), at any sampling.

    E e_i e_j = γ exp(−|t_i − t_j|/τ)        white: τ = 0

    ε_0 = e_0,    ε_k = (e_k − ρ_k e_{k−1})/√(1 − ρ_k²),    ρ_k = exp(−h_k/τ)

are white of variance γ.  τ is where the restricted likelihood of what a fit leaves is largest (Patterson &
Thompson, Biometrika 58, 1971): with r the residuals and J the derivatives, both whitened, N samples, k
parameters,

    −2 ln L = (N − k) ln(|r⊥|²/(N − k)) + Σ ln(1 − ρ_k²) + ln |JᵀJ|

which, other than the likelihood, does not take the freedom of the fit for lack of noise.
"""

from __future__ import annotations

from math import log
from typing import NamedTuple

import numpy as np

from zwidth.native.compiled import Array

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
