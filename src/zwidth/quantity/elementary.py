"""exp, expm1, log, log1p, tanh and powers that have the same bits on every machine.

Only sums, products, quotients and square roots of doubles, floor and comparisons: IEEE 754 says what each of
them is to the last bit, where a library's `exp` is its own.  What is simulated here is then what C99 and
JavaScript compute of the same source, as long as no product is contracted with a sum.

Each is the sum of two doubles before it is rounded, so that it errs by little more than half a unit in the
last place.
"""

from __future__ import annotations

from math import factorial, floor, inf, nan, sqrt

from zwidth.native.compiled import compiled

# Powers of two put on and taken off, and ln 2: products with powers of two are exact within the range.
#
# The exponent is a whole number in a double, as a floor is.  Of ln 2 the high part has 32 bits, so that its
# product with such an exponent is exact: Cody & Waite, Software Manual for the Elementary Functions (1980).

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


# A sum and a product without error, as the rounded one and what rounding took from it.
#
# a + b = s + e,   s = fl(a + b)          Knuth, The Art of Computer Programming 2 (1969), 4.2.2
# a b   = p + e,   p = fl(a b)            Dekker, A floating-point technique for extending the available
#                                         precision, Numer. Math. 18 (1971)

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


# eˣ and eˣ − 1: the argument reduced by multiples of ln 2, then Taylor's series.
#
#     x = k ln 2 + r,  |r| ≤ ½ ln 2,      eˣ = 2ᵏ (1 + r + r²/2 + … + r¹⁴/14!)
#
# r, r²/2 and the sum are kept in two doubles, what follows in one; the terms left out are below 2⁻⁶³.
# Reduction in two parts: Cody & Waite, Software Manual for the Elementary Functions (1980); a leading part
# without error and a small correction: Tang, ACM Trans. Math. Softw. 15 (1989).

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


# xⁿ of numbers that are not negative.
#
#     xⁿ = e^(n ln x),   n ln x in two doubles
#
# The exponents ½, 1, 3/2 and 2 take a square root and products: √x = s + (x − s²)/(2 s), x − s² without
# error.

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


# tanh x = e/(e + 2),   e = e²ˣ − 1

_TANH_LINEAR_UP_TO = 2.0**-28
"""Up to which tanh x is x but for rounding."""

_ONE_FROM = 20.0
"""From which tanh x is 1 but for rounding."""


@compiled
def tanh(x: float) -> float:
    """tanh x to 0.6 units in the last place; tanh (−x) = −tanh x to the bit."""
    size = abs(x)
    if size < _TANH_LINEAR_UP_TO or x != x:
        return x
    y = 1.0
    if size < _ONE_FROM:
        a, b = expm1_parts(2.0 * size)
        d, missed = two_sum(2.0, a)
        y = a / d
        p, error = two_product(y, d)
        y += (((a - p) - error) + (b - y * (missed + b))) / d
    return -y if x < 0.0 else y


# ln x and ln (1 + x): a power of two is taken off, then the series of the area tangent.
#
#     x = 2ᵏ (1 + f),  √½ ≤ 1 + f < √2,      s = f/(2 + f)
#     ln x = k ln 2 + 2 s (1 + s²/3 + s⁴/5 + … + s²²/23)
#
# s, its product with s²/3 and the sum are kept in two doubles, the rest in one; the terms left out are below
# 2⁻⁶⁵ of the sum.  The series is Gregory's; f/(2 + f) as its argument: Tang, ACM Trans. Math. Softw. 16
# (1990).

_PER = tuple(1.0 / k for k in (1, *range(1, 24)))

_LOG_LINEAR_UP_TO = 2.0**-54
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
    odd = _PER[7] + fourth * (_PER[11] + fourth * (_PER[15] + fourth * (_PER[19] + fourth * _PER[23])))
    even = _PER[5] + fourth * (_PER[9] + fourth * (_PER[13] + fourth * (_PER[17] + fourth * _PER[21])))
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
    if x != x or x == inf or abs(x) < _LOG_LINEAR_UP_TO:
        return x
    if x <= -1.0:
        return -inf if x == -1.0 else nan
    one, missed = two_sum(1.0, x)
    m, k = unscaled(one)
    f, rest = two_sum(m - 1.0, scaled(missed, -k))
    a, b = _near_one(f, rest)
    return _joined(k, a, b)[0]
