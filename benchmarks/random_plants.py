"""Random stable laws H(z) for the benchmarks: coefficients as typed decimals of doubles."""

from __future__ import annotations

import numpy as np


def random_law(rng: np.random.Generator, order: int, radius: float) -> tuple[list[float], list[float]]:
    """Numerator and denominator, descending powers of z; H(1) ≥ 0, poles within `radius`."""
    poles: list[complex] = []
    while len(poles) < order:
        if order - len(poles) >= 2 and rng.random() < 0.8:
            pole = radius * np.sqrt(rng.random()) * np.exp(1j * np.pi * rng.random())
            poles += [pole, np.conj(pole)]
        else:
            poles.append(rng.uniform(-radius, radius))
    denominator = np.real(np.poly(poles))
    numerator = rng.normal(size=order + 1)
    if numerator.sum() * denominator.sum() < 0:
        numerator = -numerator
    return [float(c) for c in numerator], [float(c) for c in denominator]
