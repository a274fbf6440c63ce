"""Periodic motions of a piecewise linear loop: guessed by simulation, corrected, and then certain.

For a given pattern of samples inside the equation of a periodic motion is linear.  Solve it, take the pattern
of the solution, and solve again (Newton's method for a piecewise linear equation) until the two agree.  Then
it is solved once more with error bounds, and the signs of all x − g are certain.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.signal import tf2ss

from zwidth.passivity.stability.absolute.plant import Plant

_STARTS = 36
_SETTLING = 6000
_CANDIDATES = 10
_CORRECTIONS = 40
_PRECISION = 256
_LOST = 1e300

Array = NDArray[np.float64]


def simulated(plant: Plant, slope: float, gap: float) -> list[Array]:
    """The last samples of motions from starts all around."""
    a, b, c, _ = tf2ss(plant.numerator, plant.denominator)
    rng = np.random.default_rng(0)
    state = rng.normal(size=(len(a), _STARTS))
    reach = np.zeros(_STARTS)
    free = state.copy()
    for _ in range(200):  # the scale of a start is how far it would swing without a wall
        reach = np.maximum(reach, np.abs(c @ free)[0])
        free = a @ free
    state *= abs(gap) * np.logspace(0.2, 3.5, _STARTS) / reach
    kept = np.empty((_SETTLING, _STARTS))
    with np.errstate(over="ignore", invalid="ignore"):
        for j in range(_SETTLING):
            kept[j] = (c @ state)[0]
            state = a @ state - b @ (slope * np.maximum(kept[j] - gap, 0.0))[None, :]
    kept = np.nan_to_num(kept[-_SETTLING // 4 :], nan=_LOST, posinf=_LOST, neginf=-_LOST)
    return [kept[:, i] for i in range(_STARTS)]


def returns(run: Array, longest: int) -> list[int]:
    """Periods after which the run nearly repeats, the best first."""
    errors = {n: float(np.abs(run[n:] - run[:-n]).max()) for n in range(2, longest + 1)}
    return sorted(errors, key=errors.__getitem__)[:_CANDIDATES]


def corrected(plant: Plant, slope: float, gap: float, positions: Array) -> Array | None:
    n = len(positions)
    angles = 2 * np.pi * np.arange(n) / n
    kernel = np.fft.ifft(plant.response(angles)).real
    moved = kernel[(np.arange(n)[:, None] - np.arange(n)[None, :]) % n]
    inside = positions > gap
    tried: set[bytes] = set()
    while inside.tobytes() not in tried and len(tried) < _CORRECTIONS:
        tried.add(inside.tobytes())
        force = moved * (slope * inside)
        try:
            positions = np.linalg.solve(np.eye(n) + force, gap * force.sum(axis=1))
        except np.linalg.LinAlgError:
            return None
        if ((positions > gap) == inside).all():
            return positions
        inside = positions > gap
    return None


def growth_of(plant: Plant, slope: float, inside: NDArray[np.bool_]) -> float:
    a, b, c, _ = tf2ss(plant.numerator, plant.denominator)
    total = np.eye(len(a))
    for touches in inside:
        total = (a - slope * b @ c if touches else a) @ total
    return float(np.abs(np.linalg.eigvals(total)).max())
