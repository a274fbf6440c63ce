"""Routh's test for a block of walls, each answer with a bound on its rounding.

    c(w) = c_0 + K c_K + B c_B

The coefficients are doubles within a unit of the last place of the true ones, or within `slack`.

Every number carries a bound e on how far it may be from the true one.  A sign is believed
only where |value| > e; the rest is left to exact arithmetic.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from zwidth.native.compiled import Array, compiled

STABLE, UNSTABLE, UNKNOWN = 1, 0, 2
"""What is known of a cell."""

EPS = 4.5e-16
"""More than four roundings, 4 · 2⁻⁵³: each formula below has at most three."""


@compiled
def decide_block(
    free: Array, stiff: Array, damped: Array, stiffness: Array, damping: Array,
    slack: float, upper: Array, lower: Array, out: NDArray[np.uint8],
) -> None:  # fmt: skip
    """Fill out[i, j] for every K and B; `upper` and `lower` are scratch: a row of values, a row of bounds."""
    for i in range(stiffness.size):
        for j in range(damping.size):
            out[i, j] = decide(free, stiff, damped, stiffness[i], damping[j], slack, upper, lower)


@compiled
def decide(
    free: Array, stiff: Array, damped: Array, k: float, b: float, slack: float, upper: Array, lower: Array
) -> int:
    """One wall: STABLE, UNSTABLE or UNKNOWN."""
    size = free.size
    count_upper, count_lower = (size + 1) // 2, size // 2
    for n in range(size):
        x, y = k * stiff[n], b * damped[n]
        value = free[n] + x + y
        bound = 2.0 * EPS * (abs(free[n]) + abs(x) + abs(y)) + slack * (1.0 + abs(k) + abs(b))
        row = upper if n % 2 == 0 else lower
        row[0, n // 2] = value
        row[1, n // 2] = bound
    while count_upper > 0:
        if not upper[0, 0] > upper[1, 0]:
            return UNSTABLE if upper[0, 0] < -upper[1, 0] else UNKNOWN
        if count_lower == 0:
            return STABLE
        if not lower[0, 0] > lower[1, 0]:
            return UNSTABLE if lower[0, 0] < -lower[1, 0] else UNKNOWN
        a, ea, p, ep = upper[0, 0], upper[1, 0], lower[0, 0], lower[1, 0]
        ratio = a / p
        error = (ea + ratio * ep) / (p - ep) * (1.0 + 8.0 * EPS) + EPS * ratio
        for n in range(count_upper - 1):
            q = lower[0, n + 1] if n + 1 < count_lower else 0.0
            eq = lower[1, n + 1] if n + 1 < count_lower else 0.0
            above, bound = upper[0, n + 1], upper[1, n + 1]
            product = ratio * q
            upper[0, n] = above - product
            grown = bound + ratio * eq + abs(q) * error + error * eq
            upper[1, n] = grown * (1.0 + 8.0 * EPS) + EPS * (abs(above) + abs(product))
        left = count_upper - 1
        # the lower row becomes the upper one
        for n in range(max(count_lower, left)):
            for part in range(2):
                kept = lower[part, n] if n < count_lower else 0.0
                lower[part, n] = upper[part, n] if n < left else 0.0
                upper[part, n] = kept
        count_upper, count_lower = count_lower, left
    return STABLE
