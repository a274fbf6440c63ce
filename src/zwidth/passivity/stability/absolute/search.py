"""Weights that make the inequality positive: a linear programme over a grid that grows where it is violated.

Nothing found here is believed: it is rounded and proved afterwards.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linprog

from zwidth.passivity.stability.absolute.plant import Plant
from zwidth.passivity.stability.absolute.terms import Array, Criterion, Term, columns, terms_of

_FINE = 6000
_COARSE = 60
_ROUNDS = 30
_LEAST = 1e-2
"""Of sin²(θ/2), below which frequencies count alike: there the circle's term alone is left."""

_KEPT = 0.1
"""Of the margin on the grid, that must be left between its points."""

_PRECISION = 1e-6
"""Relative, of the slope."""


class Found(NamedTuple):
    """A slope and the weights that seem to prove it."""

    slope: float
    weights: dict[Term, float]


def largest_slope(plant: Plant, criterion: Criterion, reach: int, most: float) -> Found | None:
    """The largest slope up to `most` that the criterion seems to prove, by bisection; None if none does."""
    search = _Search(plant, terms_of(criterion, reach))
    low, high = most * 1e-6, most
    best = search.weights(low)
    if best is None:
        return None
    found = Found(low, best)
    while high > low * (1 + _PRECISION):
        middle = (low * high) ** 0.5
        weights = search.weights(middle)
        if weights is None:
            high = middle
        else:
            low, found = middle, Found(middle, weights)
    return found


class _Search:
    def __init__(self, plant: Plant, terms: tuple[Term, ...]) -> None:
        self.terms = terms
        self.angles = frequencies(plant)
        self.response = plant.response(self.angles)
        self.chosen = set(range(0, len(self.angles), _COARSE)) | {len(self.angles) - 1}

    def weights(self, slope: float) -> dict[Term, float] | None:
        """The weights with the largest margin, None where there is none."""
        table = columns(self.terms, self.response, self.angles, slope)
        size = np.abs(1 + slope * self.response) + 1e-9
        table /= (size * (np.sin(self.angles / 2) ** 2 + _LEAST))[:, None]
        scale = np.abs(table).max(axis=0)
        table /= scale
        for _ in range(_ROUNDS):
            margin, weights = _programme(table[sorted(self.chosen)])
            if weights is None or margin <= 0:
                return None
            total = table @ weights
            worst = _valleys(total, margin * _KEPT)
            if not worst:
                break
            self.chosen |= set(worst)
        else:
            return None
        return {t: w / s for t, w, s in zip(self.terms, weights.tolist(), scale.tolist(), strict=True)}


def _programme(table: Array) -> tuple[float, NDArray[np.float64] | None]:
    """max t with table v ≥ t, v ≥ 0 and Σ v = 1."""
    rows, size = table.shape
    cost = np.zeros(size + 1)
    cost[-1] = -1
    total = np.append(np.ones(size), 0.0)[None, :]
    limits = [(0, None)] * size + [(None, None)]
    bound = np.hstack([-table, np.ones((rows, 1))])
    result = linprog(
        cost, A_ub=bound, b_ub=np.zeros(rows), A_eq=total, b_eq=[1.0], bounds=limits, method="highs"
    )
    if not result.success:
        return 0.0, None
    return -result.fun, np.maximum(result.x[:-1], 0.0)


def _valleys(total: Array, level: float) -> list[int]:
    """Where the sum is lowest and below the level: one place in each dip."""
    padded = np.concatenate([[np.inf], total, [np.inf]])
    dips = (padded[1:-1] <= padded[:-2]) & (padded[1:-1] <= padded[2:]) & (total < level)
    return [int(i) for i in np.flatnonzero(dips)]


def frequencies(plant: Plant) -> Array:
    """Even, even in the logarithm, and close about every pole near the circle."""
    even = np.linspace(0.0, np.pi, _FINE)
    low = np.pi * np.logspace(-6, 0, _FINE // 2)
    poles = np.roots(plant.denominator)
    near = [np.abs(np.angle(p)) + (1 - abs(p)) * np.linspace(-20, 20, 801) for p in poles if abs(p) > 0.5]
    return np.unique(np.clip(np.concatenate([even, low, *near]), 0.0, np.pi))
