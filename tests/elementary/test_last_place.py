"""The elementary functions against mpmath, in units of the last place, over their whole range."""

from fractions import Fraction
from random import Random

import mpmath
import pytest
from points import both, error_of, even, wide

from zwidth.quantity.elementary import exp, expm1, log, log1p, power, tanh, two_product, two_sum

POINTS = 3000

RANGES = [
    (exp, mpmath.exp, even(-708.0, 709.78), 0.53),
    (exp, mpmath.exp, even(-2.0, 2.0), 0.53),
    (exp, mpmath.exp, both(wide(1e-20, 1.0)), 0.53),
    (exp, mpmath.exp, even(-746.0, -708.0), 0.8),
    (expm1, mpmath.expm1, even(-45.0, 709.78), 0.65),
    (expm1, mpmath.expm1, even(-2.0, 2.0), 0.65),
    (expm1, mpmath.expm1, both(wide(1e-320, 1.0)), 0.65),
    (expm1, mpmath.expm1, even(0.34, 0.37), 0.65),
    (log, mpmath.log, wide(1e-307, 1e308), 0.51),
    (log, mpmath.log, wide(5e-324, 1e-307), 0.51),
    (log, mpmath.log, even(0.5, 2.0), 0.51),
    (log, mpmath.log, wide(1e-15, 0.5, 1.0), 0.51),
    (log1p, mpmath.log1p, wide(1e-320, 1e308), 0.51),
    (log1p, mpmath.log1p, even(-1.0, 2.0), 0.51),
    (log1p, mpmath.log1p, both(wide(1e-320, 0.99)), 0.51),
    (log1p, mpmath.log1p, wide(1e-15, 0.5, -1.0), 0.51),
    (tanh, mpmath.tanh, both(even(0.0, 21.0)), 0.6),
    (tanh, mpmath.tanh, both(wide(1e-320, 3.0)), 0.6),
]

EXPONENTS = [even(0.25, 10.0), *(lambda _, n=n: n for n in (0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 9.5, 10.0))]


@pytest.fixture(autouse=True)
def _digits():
    with mpmath.workprec(200):
        yield


@pytest.mark.parametrize(("function", "exact", "draw", "bound"), RANGES)
def test_error_in_the_last_place(function, exact, draw, bound):
    random = Random(31)
    points = [draw(random) for _ in range(POINTS)]
    assert max(error_of(function(x), exact(mpmath.mpf(x))) for x in points) < bound


@pytest.mark.parametrize("exponent", EXPONENTS)
@pytest.mark.parametrize("draw", [wide(1e-300, 1e6), wide(1e-6, 1e3), even(0.5, 2.0)])
def test_error_of_powers(exponent, draw):
    """The same for every power that is not below 2⁻¹⁰²², and less than 0.8 there."""
    random = Random(32)
    for _ in range(POINTS // 5):
        x, n = draw(random), exponent(random)
        exact = mpmath.power(mpmath.mpf(x), mpmath.mpf(n))
        assert error_of(power(x, n), exact) < (0.55 if exact > 2.0**-1022 else 0.8), (x, n)


def test_powers_beyond_the_range_that_laws_use():
    """Large exponents of numbers near 1, negative ones, and numbers up to the largest."""
    random = Random(33)
    for draw, exponent in [
        (wide(1e-9, 1e-3, 1.0), wide(1.0, 1e5)),
        (wide(1e-3, 1e3), both(even(0.0, 90.0))),
        (wide(1e6, 1e300), even(0.1, 1.5)),
    ]:
        for _ in range(POINTS // 5):
            x, n = draw(random), exponent(random)
            assert error_of(power(x, n), mpmath.power(mpmath.mpf(x), mpmath.mpf(n))) < 0.8, (x, n)


def test_two_doubles_hold_a_sum_and_a_product():
    random = Random(34)
    draw = both(wide(1e-120, 1e120))
    for _ in range(POINTS):
        a, b = draw(random), draw(random)
        assert sum(map(Fraction, two_sum(a, b))) == Fraction(a) + Fraction(b)
        assert sum(map(Fraction, two_product(a, b))) == Fraction(a) * Fraction(b)
