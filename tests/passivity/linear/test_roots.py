"""Real roots inside (−1, 1), against places chosen on purpose and against all complex roots."""

from __future__ import annotations

from fractions import Fraction
from math import lcm
from random import Random

import polynomials
import pytest
from flint import fmpz_poly
from strategies import seeds

from zwidth.passivity.linear.exact_algebra import rational_roots_inside, real_roots, roots_inside

TINY = Fraction(1, 10**25)
NEAR = Fraction(1, 2**120)


def product(*factors):
    """The product of factors in ascending rational coefficients, as an integer polynomial."""
    total = polynomials.product(*factors)
    scale = lcm(*(c.denominator for c in total))
    return fmpz_poly([int(c * scale) for c in total])


def root(r):
    """c − r."""
    return (-Fraction(r), 1)


PLACED = {
    "none": [],
    "dyadic, where halving meets them": ["0", "0.5", "-0.5", "0.25"],
    "thirds": ["1/3", "-2/3"],
    "next to each other": [Fraction("0.3"), Fraction("0.3") + TINY],
    "next to the ends": [1 - TINY, TINY - 1],
    "beyond the ends": ["1.5", "-7", "0.1"],
    "at the ends": ["1", "-1", "0.7"],
    "more than once": ["0.4"] * 3 + ["-0.25"] * 2,
}


@pytest.mark.parametrize("name", PLACED)
def test_placed_roots(name):
    """Each root inside is found once, to 120 bits, and those at the ends and beyond are not."""
    places = {Fraction(r) for r in PLACED[name]}
    expected = sorted(r for r in places if -1 < r < 1)
    found = sorted(roots_inside(product(*map(root, PLACED[name]), (7, 0, 3))))
    assert len(found) == len(expected)
    assert all(abs(a - b) < NEAR for a, b in zip(found, expected, strict=True))


@seeds(12)
def test_random_polynomials(seed):
    """The same as from all complex roots."""
    random = Random(seed)
    cosines = [random.randint(-(10**6), 10**6) for _ in range(random.randint(2, 40))]
    p = sum((c * fmpz_poly.chebyshev_t(j) for j, c in enumerate(cosines)), fmpz_poly([]))
    expected = sorted(c for c in real_roots(p) if -1 < c < 1)
    found = sorted(roots_inside(p))
    assert len(found) == len(expected)
    assert all(abs(a - b) < NEAR for a, b in zip(found, expected, strict=True))


def test_rational_roots():
    """The rational ones alone, and of these the simple ones inside."""
    p = product(root("0.123456789"), root("-2/7"), *[root("0.5")] * 2, root(3), (-2, 0, 7), (1, 1, 1))
    assert sorted(rational_roots_inside(p)) == [Fraction(-2, 7), Fraction("0.123456789")]


def test_a_root_that_is_nearly_rational():
    """What agrees with a short fraction to 40 digits and is another number is told apart."""
    near = Fraction(1, 3) + Fraction(1, 10**40)
    assert rational_roots_inside(product(root(near))) == [near]
    assert rational_roots_inside(product((Fraction(-1, 9) - Fraction(1, 10**40), 0, 1))) == []
