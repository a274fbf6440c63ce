"""Stability decided exactly: the prover's Schur–Cohn, the checker's Routh table, and known roots."""

from __future__ import annotations

from fractions import Fraction
from itertools import product as choices
from math import lcm
from random import Random

import pytest
from polynomials import product
from strategies import seeds

from zwidth.checker.exact.roots import inside_unit_circle
from zwidth.passivity.linear.exact_algebra import is_schur


def polynomial(*factors):
    """The product of factors in descending coefficients, as integers."""
    total = product(*factors)
    scale = lcm(*(c.denominator for c in total))
    return [int(c * scale) for c in total]


def pair(radius, cosine):
    """z² − 2 r cos φ z + r²: a complex pair."""
    r = Fraction(radius)
    return (1, -2 * r * Fraction(cosine), r * r)


def assert_stable(descending, expected):
    """Both roads give the expected answer."""
    assert is_schur(descending[::-1]) is expected
    assert inside_unit_circle([Fraction(c) for c in descending]) is expected


HAIR = Fraction(1, 10**12)
KNOWN = {
    "real, a hair inside": ([(1, HAIR - 1)], True),
    "real, a hair outside": ([(1, -1 - HAIR)], False),
    "pair, a hair inside": ([pair(1 - HAIR, "0.3")], True),
    "pair, a hair outside": ([pair(1 + HAIR, "0.3")], False),
    "at 1": ([(1, -1), (1, "-0.4")], False),
    "at −1": ([(1, 1), (1, "-0.4")], False),
    "pair on the circle": ([pair(1, "-0.7"), (1, "0.2")], False),
    "double pair on the circle": ([pair(1, "0.6"), pair(1, "0.6")], False),
    "reciprocal pair": ([(1, "-0.4"), (1, "-2.5")], False),
    "reciprocal complex pairs": ([pair("0.8", "0.1"), pair("1.25", "0.1")], False),
    "reciprocal with opposite signs": ([(1, "-0.5"), (1, 2)], False),
    "product of roots −1": ([(1, "-0.5"), (1, 2), (1, "0.1")], False),
    "roots at zero": ([(1, 0), (1, 0), (1, "0.9")], True),
    "a constant": ([(7,)], True),
    "negative leading coefficient": ([(-3, 2)], True),
    "order 40, all close to the circle": ([pair("0.9999", Fraction(k, 21)) for k in range(1, 21)], True),
    "order 40, one pair outside": (
        [pair("0.9999", Fraction(k, 21)) for k in range(1, 20)] + [pair("1.0001", "0.95")],
        False,
    ),
    "order 40, one pair on the circle": (
        [pair("0.99", Fraction(k, 21)) for k in range(1, 20)] + [pair(1, "0.95")],
        False,
    ),
}


@pytest.mark.parametrize("name", KNOWN)
def test_known_roots(name):
    """Roots placed on purpose, within 1e-12 of the circle and on it."""
    factors, expected = KNOWN[name]
    assert_stable(polynomial(*factors), expected)


def test_zero_is_not_stable():
    """The zero polynomial has roots everywhere."""
    assert not is_schur([])
    assert not is_schur([0, 0])


@seeds(20)
def test_random_roots(seed):
    """Products of random factors: stable exactly if every factor is."""
    random = Random(seed)
    factors, stable = [], True
    for _ in range(random.randint(1, 6)):
        radius = Fraction(f"{random.choice([random.uniform(0, 1), random.uniform(0.99, 1.005)]):.4f}")
        cosine = Fraction(f"{random.uniform(-1, 1):.3f}")
        factors.append(
            pair(radius, cosine) if random.random() < 0.6 else (1, random.choice([1, -1]) * radius)
        )
        stable &= radius < 1
    assert_stable(polynomial((Fraction("-2.3"),), *factors), stable)


def test_every_small_cubic():
    """Small whole numbers make a reflection of exactly 1 on the way, which no balls decide."""
    for descending in choices(range(-3, 4), repeat=4):
        if descending[0]:
            expected = inside_unit_circle([Fraction(c) for c in descending])
            assert is_schur(descending[::-1]) is expected, descending


@pytest.mark.parametrize(("furthest", "expected"), [(1 - HAIR, True), (1 + HAIR, False)])
def test_order_one_hundred_and_ten(furthest, expected):
    """A cluster of poles near 1 and one pole a hair inside or outside: decided, whatever the digits."""
    assert is_schur(polynomial(*[(1, Fraction("-0.99"))] * 109, (1, -furthest))[::-1]) is expected
