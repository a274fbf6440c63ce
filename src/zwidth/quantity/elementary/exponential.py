"""eˣ and eˣ − 1: the argument reduced by multiples of ln 2, then Taylor's series.

    x = k ln 2 + r,  |r| ≤ ½ ln 2,      eˣ = 2ᵏ (1 + r + r²/2 + … + r¹⁴/14!)

r, r²/2 and the sum are kept in two doubles, what follows in one; the terms left out are below 2⁻⁶³.
Reduction in two parts: Cody & Waite, Software Manual for the Elementary Functions (1980); a leading part
without error and a small correction: Tang, ACM Trans. Math. Softw. 15 (1989).
"""

from __future__ import annotations

from math import factorial, floor, inf

from zwidth.native.compiled import compiled
from zwidth.quantity.elementary.double_double import two_product, two_sum
from zwidth.quantity.elementary.scale import LN_2_HIGH, LN_2_LOW, PER_LN_2, scaled

OVERFLOWS, UNDERFLOWS = 710.0, -746.0
"""Arguments beyond which eˣ is ∞ and 0 in doubles."""

_BECOMES_EXP, _BECOMES_MINUS_ONE = 44.0, -44.0
"""Arguments beyond which eˣ − 1 differs from eˣ, and from −1, by less than rounding does."""

_OVER = tuple(1.0 / factorial(n) for n in range(15))


@compiled
def exp_parts(x: float, rest: float) -> tuple[float, float, float]:
    """(k, a, b) with e^(x + rest) = 2ᵏ (1 + a + b), for |x| ≤ 750 and a rest that is as rounding to x.

    k = 0 for |x| < ½ ln 2.
    """
    k = float(floor(x * PER_LN_2 + 0.5))
    r, missed = two_sum(x - k * LN_2_HIGH, -(k * LN_2_LOW))  # the first difference is exact
    r, missed = two_sum(r, missed + rest)
    square, error = two_product(r, r)
    odd = _OVER[9] + square * (_OVER[11] + square * _OVER[13])
    odd = _OVER[3] + square * (_OVER[5] + square * (_OVER[7] + square * odd))
    even = _OVER[10] + square * (_OVER[12] + square * _OVER[14])
    even = _OVER[4] + square * (_OVER[6] + square * (_OVER[8] + square * even))
    a, b = two_sum(r, 0.5 * square)
    return k, a, b + (r * square * (odd + r * even) + (0.5 * error + missed * (1.0 + a)))


@compiled
def exp_of_sum(x: float, rest: float) -> float:
    """e^(x + rest); 0 and ∞ beyond the range."""
    if x > OVERFLOWS:
        return inf
    if x < UNDERFLOWS:
        return 0.0
    k, a, b = exp_parts(x, rest)
    y, more = two_sum(1.0, a)
    return scaled(y + (more + b), k)


@compiled
def exp(x: float) -> float:
    """eˣ to 0.53 units in the last place, to 0.8 below 2⁻¹⁰²²."""
    return x if x != x else exp_of_sum(x, 0.0)


@compiled
def expm1_parts(x: float) -> tuple[float, float]:
    """(a, b) with eˣ − 1 = a + b, b as rounding to a, for |x| ≤ 44."""
    k, a, b = exp_parts(x, 0.0)
    if k != 0.0:
        y, more = two_sum(1.0, a)
        a, left = two_sum(scaled(y, k), -1.0)
        b = left + scaled(more + b, k)
    return two_sum(a, b)


@compiled
def expm1(x: float) -> float:
    """eˣ − 1 to 0.65 units in the last place, also where x is small; it has the sign of x."""
    if x == 0.0 or x != x:
        return x
    if x > _BECOMES_EXP:
        return exp_of_sum(x, 0.0)
    if x < _BECOMES_MINUS_ONE:
        return -1.0
    a, b = expm1_parts(x)
    return a + b
