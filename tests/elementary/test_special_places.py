"""Where an elementary function ends, begins or must be exact; from double to double none turns back."""

from __future__ import annotations

from math import copysign, inf, isnan, nan, nextafter
from random import Random

import numpy as np
import pytest
from points import both, even, wide

from zwidth.native.compiled import Array
from zwidth.quantity.elementary import exp, expm1, log, log1p, power, tanh

LARGEST = 1.7976931348623157e308
SMALLEST = 5e-324

VALUES = {
    (exp, 1.0): [0.0, -0.0, SMALLEST, 2.0**-53, -(2.0**-55)],
    (exp, 1.7976931348622732e308): [709.782712893384],
    (exp, inf): [nextafter(709.782712893384, inf), 1e308, inf],
    (exp, SMALLEST): [-745.1332191019411],
    (exp, 0.0): [-745.14, -1e308, -inf],
    (expm1, 2.0**-30 + 2.0**-61): [2.0**-30],
    (expm1, -1.0): [-37.5, -44.5, -1e308, -inf],
    (expm1, inf): [710.0, inf],
    (log, 0.0): [1.0],
    (log, -744.4400719213812): [2.0**-1074],
    (log, 709.782712893384): [LARGEST],
    (log, -inf): [0.0],
    (log, inf): [inf],
    (log1p, 2.0**-30 - 2.0**-61): [2.0**-30],
    (log1p, 709.782712893384): [LARGEST],
    (log1p, -inf): [-1.0],
    (log1p, inf): [inf],
    (tanh, 1.0): [19.5, 1e308, inf],
    (tanh, -1.0): [-inf],
    **{(own, x): [x] for own in (expm1, log1p, tanh) for x in (SMALLEST, -1e-300, 1e-17)},
}


@pytest.mark.parametrize(("function", "value"), VALUES)
def test_values(function, value):
    for x in VALUES[function, value]:
        assert function(x) == value, x


@pytest.mark.parametrize("function", [expm1, log1p, tanh])
def test_zero_keeps_its_sign(function):
    """As the functions pass through 0 with slope 1."""
    assert [copysign(1.0, function(x)) for x in (0.0, -0.0)] == [1.0, -1.0]
    assert function(0.0) == function(-0.0) == 0.0


def test_powers_of_two_have_their_logarithm():
    """ln 2ᵏ and 2ᵏ⸱ⁿ for every k: the parts of ln 2 add up to it."""
    from mpmath import ln, workprec

    with workprec(200):
        assert all(log(2.0**k) == float(k * ln(2)) for k in range(-1074, 1024))
    assert all(power(2.0**k, 3.0) == 2.0 ** (3 * k) for k in range(-350, 341))
    assert all(power(4.0**k, 2.5) == 2.0 ** (5 * k) for k in range(-200, 200))


def test_no_number_stays_none():
    for function in (exp, expm1, log, log1p, tanh):
        assert isnan(function(nan))
    assert isnan(power(nan, 2.5))
    assert isnan(power(2.5, nan))
    assert isnan(log(-1e-300))
    assert isnan(log1p(-1.5))
    assert isnan(power(-2.5, 0.3))


def test_powers_that_are_exact():
    """0ⁿ = 0, 1ⁿ = 1, ∞ⁿ = ∞; beyond the range ∞ and 0; x, x², √x are those of the machine."""
    for n in (0.25, 0.5, 1.0, 1.5, 2.0, 2.2, 10.0):
        assert (power(0.0, n), power(1.0, n), power(inf, n)) == (0.0, 1.0, inf)
    for x, n in ((1e6, 60.0), (1e300, 1.5), (1e300, 2.0)):
        assert power(x, n) == inf
        assert power(1e-6 if x == 1e6 else 1e-300, n) == 0.0
    assert (power(0.0, -0.5), power(inf, -0.5), power(7.3, 0.0)) == (inf, 0.0, 1.0)
    for x in (1e-300, 3.7e-5, 0.1, 0.7, 1.1, 123.456):
        assert (power(x, 1.0), power(x, 2.0), power(x, 0.5)) == (x, x * x, x**0.5)


LONG = 300
"""Doubles in a neighbourhood."""

SEAMS = (0.34657359027997264, 0.7071067811865476, 1.0, 1.4142135623730951, 2.0, 20.0, 44.0, 2**-28, 2**-54)
"""Where the way of computing changes."""


def neighbours(x: float) -> list[float]:
    """The doubles about x, in order."""
    for _ in range(LONG // 2):
        x = nextafter(x, -inf)
    found = [x]
    for _ in range(LONG):
        found.append(nextafter(found[-1], inf))
    return found


def turns(values: Array) -> bool:
    return bool((np.diff(values) < 0.0).any())


PLACES = [
    (exp, both(even(0.0, 700.0)), -745.0),
    (expm1, both(even(0.0, 60.0)), -745.0),
    (expm1, both(wide(1e-20, 1.0)), -745.0),
    (log, wide(1e-300, 1e300), 1e-300),
    (log, even(0.5, 2.0), 1e-300),
    (log1p, both(wide(1e-20, 0.9)), -0.9999),
    (log1p, wide(1e-3, 1e300), -0.9999),
    (tanh, both(even(0.0, 21.0)), -1e300),
    (tanh, both(wide(1e-20, 1.0)), -1e300),
]


@pytest.mark.parametrize(("function", "draw", "least"), PLACES)
def test_rising(function, draw, least):
    random = Random(41)
    seams = [sign * seam for seam in SEAMS for sign in (1.0, -1.0)]
    for place in [*(draw(random) for _ in range(60)), *(s for s in seams if s > least)]:
        assert not turns(np.array([function(x) for x in neighbours(place)])), place


@pytest.mark.parametrize("n", [0.25, 0.3, 0.5, 1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 10.0])
def test_powers_rise(n):
    random = Random(42)
    draw = wide(1e-29, 1e6)
    for place in [*(draw(random) for _ in range(40)), *SEAMS, *(2.0**k * SEAMS[1] for k in range(-40, 20))]:
        assert not turns(np.array([power(x, n) for x in neighbours(place)])), place


def test_powers_rise_with_their_exponent():
    """Above 1 they do; the exponents that have a way of their own included."""
    for x in (1.0000001, 1.3, 7.7, 1e5):
        for n in (0.5, 1.0, 1.5, 2.0, 2.5, 3.3):
            assert not turns(np.array([power(x, m) for m in neighbours(n)])), (x, n)


def test_tangent_is_odd_and_stays_within_one():
    """tanh (−x) = −tanh x to the bit, |tanh x| ≤ 1."""
    random = Random(43)
    for _ in range(3000):
        x = random.choice((even(0.0, 25.0), wide(1e-30, 1.0)))(random)
        assert tanh(-x) == -tanh(x)
        assert 0.0 <= tanh(x) <= 1.0
