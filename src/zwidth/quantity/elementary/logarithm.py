"""ln x and ln (1 + x): a power of two is taken off, then the series of the area tangent.

    x = 2ᵏ (1 + f),  √½ ≤ 1 + f < √2,      s = f/(2 + f)
    ln x = k ln 2 + 2 s (1 + s²/3 + s⁴/5 + … + s²²/23)

s, its product with s²/3 and the sum are kept in two doubles, the rest in one; the terms left out are below
2⁻⁶⁵ of the sum.  The series is Gregory's; f/(2 + f) as its argument: Tang, ACM Trans. Math. Softw. 16 (1990).
"""

from __future__ import annotations

from math import inf, nan

from zwidth.native.compiled import compiled
from zwidth.quantity.elementary.double_double import two_product, two_sum
from zwidth.quantity.elementary.scale import LN_2_HIGH, LN_2_LOW, scaled, unscaled

_OVER = tuple(1.0 / n for n in (1, *range(1, 24)))

_LINEAR_UP_TO = 2.0**-54
"""Up to which ln (1 + x) is x but for rounding."""


@compiled
def _near_one(f: float, rest: float) -> tuple[float, float]:
    """(a, b) with ln (1 + f + rest) = a + b, for √½ ≤ 1 + f < √2."""
    d, missed = two_sum(2.0, f)
    s = f / d
    p, error = two_product(s, d)
    low = (((f - p) - error) + (rest - s * (missed + rest))) / d  # s + low is the quotient
    square, error = two_product(s, s)
    error += 2.0 * s * low
    third = square / 3.0
    fourth = square * square
    odd = _OVER[7] + fourth * (_OVER[11] + fourth * (_OVER[15] + fourth * (_OVER[19] + fourth * _OVER[23])))
    even = _OVER[5] + fourth * (_OVER[9] + fourth * (_OVER[13] + fourth * (_OVER[17] + fourth * _OVER[21])))
    # the first difference is exact: a quotient by 3 is what is left of three thirds when two are gone
    further = (((square - 2.0 * third) - third) + error) / 3.0 + fourth * (even + square * odd)
    twice = 2.0 * s
    q, error = two_product(twice, third)
    a, b = two_sum(twice, q)
    return a, b + (error + (2.0 * low * (1.0 + third) + twice * further))


@compiled
def _joined(k: float, a: float, b: float) -> tuple[float, float]:
    """k ln 2 + a + b in two parts, the second as rounding to the first."""
    high, low = two_sum(k * LN_2_HIGH, a)
    return two_sum(high, low + (b + k * LN_2_LOW))


@compiled
def log_parts(x: float) -> tuple[float, float]:
    """(a, b) with ln x = a + b, for 0 < x < ∞."""
    m, k = unscaled(x)
    a, b = _near_one(m - 1.0, 0.0)
    return _joined(k, a, b)


@compiled
def log(x: float) -> float:
    """ln x to 0.51 units in the last place; −∞ at 0, no number below."""
    if x != x or x == inf:
        return x
    if x <= 0.0:
        return -inf if x == 0.0 else nan
    return log_parts(x)[0]


@compiled
def log1p(x: float) -> float:
    """ln (1 + x) to 0.51 units in the last place, also where x is small; −∞ at −1, no number below."""
    if x != x or x == inf or abs(x) < _LINEAR_UP_TO:
        return x
    if x <= -1.0:
        return -inf if x == -1.0 else nan
    one, missed = two_sum(1.0, x)
    m, k = unscaled(one)
    f, rest = two_sum(m - 1.0, scaled(missed, -k))
    a, b = _near_one(f, rest)
    return _joined(k, a, b)[0]
