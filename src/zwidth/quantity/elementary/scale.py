"""Powers of two put on and taken off, and ln 2: products with powers of two are exact within the range.

The exponent is a whole number in a double, as a floor is.  Of ln 2 the high part has 32 bits, so that its
product with such an exponent is exact: Cody & Waite, Software Manual for the Elementary Functions (1980).
"""

from __future__ import annotations

from zwidth.native.compiled import compiled

LN_2_HIGH = 0.69314718036912382
LN_2_LOW = 1.9082149292705877e-10
PER_LN_2 = 1.4426950408889634

_ROOT_OF_2 = 1.4142135623730951
_ROOT_OF_HALF = 0.5 * _ROOT_OF_2

_UP_BY_64, _DOWN_BY_64 = 2.0**64, 2.0**-64
_UP_BY_8, _DOWN_BY_8 = 2.0**8, 2.0**-8
_DOWN_BY_128 = 2.0**-128

_NEARLY_SUBNORMAL = -900.0


@compiled
def scaled(x: float, k: float) -> float:
    """x 2ᵏ for a whole k, rounded once at most, for |x| in [0.5, 2] or below; ∞ beyond the range."""
    y, left, last = x, k, 1.0
    if left < _NEARLY_SUBNORMAL:  # the last product alone leaves the range of full precision
        left += 128.0
        last = _DOWN_BY_128
    while left >= 64.0:
        y *= _UP_BY_64
        left -= 64.0
    while left >= 8.0:
        y *= _UP_BY_8
        left -= 8.0
    while left >= 1.0:
        y *= 2.0
        left -= 1.0
    while left <= -64.0:
        y *= _DOWN_BY_64
        left += 64.0
    while left <= -8.0:
        y *= _DOWN_BY_8
        left += 8.0
    while left <= -1.0:
        y *= 0.5
        left += 1.0
    return y * last


@compiled
def unscaled(x: float) -> tuple[float, float]:
    """(m, k), x = m 2ᵏ with √½ ≤ m < √2, for 0 < x < ∞."""
    m, k = x, 0.0
    while m >= _UP_BY_64:
        m *= _DOWN_BY_64
        k += 64.0
    while m >= _UP_BY_8:
        m *= _DOWN_BY_8
        k += 8.0
    while m >= _ROOT_OF_2:
        m *= 0.5
        k += 1.0
    while m < _DOWN_BY_64:
        m *= _UP_BY_64
        k -= 64.0
    while m < _DOWN_BY_8:
        m *= _UP_BY_8
        k -= 8.0
    while m < _ROOT_OF_HALF:
        m *= 2.0
        k -= 1.0
    return m, k
