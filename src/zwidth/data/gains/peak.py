"""Where a concave function is largest, by a golden section."""

from __future__ import annotations

from collections.abc import Callable
from math import sqrt

_STEPS = 14
"""Of the golden section: a thousandth of its range."""


def peak(value: Callable[[float], float], high: float, start: float) -> float:
    """Where a function on [0, high] is largest that is concave around `start` and 0 elsewhere."""

    def at(x: float) -> tuple[float, float, float]:
        return value(x), -abs(x - start), x

    golden = (sqrt(5) - 1) / 2
    low = 0.0
    left, right = at(high - golden * (high - low)), at(low + golden * (high - low))
    for _ in range(_STEPS):
        if left[:2] >= right[:2]:
            high, right = right[2], left
            left = at(high - golden * (high - low))
        else:
            low, left = left[2], right
            right = at(low + golden * (high - low))
    return max(left, right)[2]
