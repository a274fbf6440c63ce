"""Random doubles over a range, evenly or by their size, and how far a double is off in its last place."""

from __future__ import annotations

import math
from collections.abc import Callable
from random import Random

import mpmath


def even(low: float, high: float) -> Callable[[Random], float]:
    return lambda random: random.uniform(low, high)


def wide(low: float, high: float, shift: float = 0.0) -> Callable[[Random], float]:
    """`shift` plus a size from low to high, evenly by its logarithm."""
    return lambda random: shift + math.exp(random.uniform(math.log(low), math.log(high)))


def both(draw: Callable[[Random], float]) -> Callable[[Random], float]:
    """Of either sign."""
    return lambda random: draw(random) if random.random() < 0.5 else -draw(random)


def error_of(found: float, exact: mpmath.mpf) -> float:
    """|found − exact| in units of the last place of a double near `exact`; ∞ where one alone is."""
    rounded = float(exact)  # a double of mpmath rounds to the nearest
    if math.isinf(rounded) or math.isinf(found):
        return 0.0 if rounded == found else math.inf
    place = max(mpmath.frexp(exact)[1] - 53, -1074)
    return float(mpmath.ldexp(abs(mpmath.mpf(found) - exact), -place))
