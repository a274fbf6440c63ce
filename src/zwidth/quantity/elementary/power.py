"""xⁿ of numbers that are not negative.

    xⁿ = e^(n ln x),   n ln x in two doubles

The exponents ½, 1, 3/2 and 2 take a square root and products: √x = s + (x − s²)/(2 s), x − s² without error.
"""

from __future__ import annotations

from math import inf, nan, sqrt

from zwidth.native.compiled import compiled
from zwidth.quantity.elementary.double_double import two_product
from zwidth.quantity.elementary.exponential import OVERFLOWS, UNDERFLOWS, exp_of_sum
from zwidth.quantity.elementary.logarithm import log_parts

_SMALLEST, _LARGEST = 1e-180, 1e180
"""Between them no product that x^1.5 takes leaves the range."""


@compiled
def power(x: float, n: float) -> float:
    """xⁿ for x ≥ 0; 0 for x = 0 and n > 0.

    To 0.55 units in the last place for n up to 10, to 0.8 below 2⁻¹⁰²² and for larger ones.
    """
    if n == 1.0 or x != x:
        return x
    if n != n:
        return n
    if n == 2.0:
        return x * x
    if n == 0.0:
        return 1.0
    if x <= 0.0 or x == inf:
        return _at_the_ends(x, n)
    if n == 0.5:
        return sqrt(x)
    if n == 1.5 and _SMALLEST < x < _LARGEST:
        return _three_halves(x)
    a, b = log_parts(x)
    p = n * a
    if p > OVERFLOWS:
        return inf
    if p < UNDERFLOWS:
        return 0.0
    p, error = two_product(n, a)
    return exp_of_sum(p, error + n * b)


@compiled
def _three_halves(x: float) -> float:
    s = sqrt(x)
    square, missed = two_product(s, s)
    low = ((x - square) - missed) / (2.0 * s)
    p, error = two_product(x, s)
    return p + (error + x * low)


@compiled
def _at_the_ends(x: float, n: float) -> float:
    if x < 0.0:
        return nan
    if x == 0.0:
        return 0.0 if n > 0.0 else inf
    return inf if n > 0.0 else 0.0
