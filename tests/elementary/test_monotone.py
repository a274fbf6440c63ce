"""The elementary functions never turn back from one double to the next."""

from __future__ import annotations

from math import inf, nextafter
from random import Random

import numpy as np
import pytest
from points import both, even, wide

from zwidth.native.compiled import Array
from zwidth.quantity.elementary import exp, expm1, log, log1p, power, tanh

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
