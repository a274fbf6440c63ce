"""A sum and a product without error, as the rounded one and what rounding took from it.

a + b = s + e,   s = fl(a + b)          Knuth, The Art of Computer Programming 2 (1969), 4.2.2
a b   = p + e,   p = fl(a b)            Dekker, A floating-point technique for extending the available
                                        precision, Numer. Math. 18 (1971)
"""

from __future__ import annotations

from zwidth.native.compiled import compiled

_HALF_OF_THE_DIGITS = 134217729.0
"""2²⁷ + 1: what it multiplies falls into two numbers of 26 bits."""


@compiled
def two_sum(a: float, b: float) -> tuple[float, float]:
    """(s, e), for any two numbers whose sum is finite."""
    s = a + b
    more = s - a
    return s, (a - (s - more)) + (b - more)


@compiled
def two_product(a: float, b: float) -> tuple[float, float]:
    """(p, e), for sizes below 1e300; e is exact where |a b| ≥ 1e-290."""
    p = a * b
    c = _HALF_OF_THE_DIGITS * a
    d = _HALF_OF_THE_DIGITS * b
    a1 = c - (c - a)
    b1 = d - (d - b)
    a2 = a - a1
    b2 = b - b1
    return p, a2 * b2 - (((p - a1 * b1) - a2 * b1) - a1 * b2)
