"""The slope at which a linear spring in the place of the wall makes the loop unstable: no proof goes beyond.

K = −1 / G(e^{jθ}) where G is real and < 0, the smallest over θ in [0, π]
"""

from __future__ import annotations

from math import inf
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq

from zwidth.passivity.stability.absolute.plant import Plant
from zwidth.passivity.stability.absolute.search import frequencies


class LinearLimit(NamedTuple):
    """`slope` K, inf for none, and `angle` θ = ωT of the vibration there."""

    slope: float
    angle: float


def linear_limit(plant: Plant) -> LinearLimit:
    """The smallest slope with a closed-loop pole on the unit circle."""

    def imaginary(angle: float) -> float:
        return plant.response_at(angle).imag

    angles = frequencies(plant)[1:-1]
    sides = plant.response(angles).imag
    places = np.flatnonzero(np.sign(sides[:-1]) * np.sign(sides[1:]) < 0)
    crossings = [brentq(imaginary, angles[i], angles[i + 1], xtol=1e-15) for i in places]
    candidates = np.array([0.0, *crossings, np.pi])
    values = plant.response(candidates).real
    slopes = [(float(-1 / g), float(a)) for g, a in zip(values, candidates, strict=True) if g < 0]
    return LinearLimit(*min(slopes, default=(inf, 0.0)))
