"""The least that friction takes between two points: lemmas of Abbott & Okamura (2005), appendix.

docs/theory/available-storage.md proves them; here random motions are added in fractions and by quadrature.
"""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from strategies import seeds

from zwidth.passivity.storage.domain import Losses

FRICTION, DAMPING, PERIOD = Fraction("0.12"), Fraction("0.15"), Fraction("0.003")
PAID = Losses(DAMPING, FRICTION, Fraction("0.00224"), PERIOD, 1)

speeds = st.fractions(-3, 3, max_denominator=1000)
shares = st.fractions(Fraction(1, 50), 1, max_denominator=50)
pieces = st.lists(st.tuples(speeds, shares), min_size=1, max_size=12)


def motion(made: list[tuple[Fraction, Fraction]]) -> list[tuple[Fraction, Fraction]]:
    whole = sum(share for _, share in made)
    return [(speed, PERIOD * share / whole) for speed, share in made]


def loss(ways: list[tuple[Fraction, Fraction]]) -> Fraction:
    """∫ f_c |v| + b v² dt, piece by piece."""
    return sum((FRICTION * abs(v) + DAMPING * v * v) * t for v, t in ways)


@given(pieces)
def test_no_motion_loses_less(made):
    """Of a random motion; what it loses beyond the least is what the theory says, to the last digit."""
    ways = motion(made)
    far, length = sum(v * t for v, t in ways), sum(abs(v) * t for v, t in ways)
    uneven = sum((v - far / PERIOD) ** 2 * t for v, t in ways)
    beyond = FRICTION * (length - abs(far)) + DAMPING * uneven
    assert beyond >= 0
    assert loss(ways) == PAID.lost(far, Fraction(1)) + beyond


@given(pieces, shares)
def test_turning_back_and_resting_cost(made, rest):
    """The constructions of the paper: run forwards, (19), and stretched over a rest, (21)."""
    ways = motion(made)
    far, length = sum(v * t for v, t in ways), sum(abs(v) * t for v, t in ways)
    assume(0 < abs(far) < length)
    forwards = [(abs(v) * far / length, t) for v, t in ways]
    assert sum(v * t for v, t in forwards) == far
    assert loss(forwards) < loss(ways)
    part = 1 / (1 + rest)
    rested = [*((v / part, t * part) for v, t in ways), (Fraction(0), PERIOD * (1 - part))]
    assert sum(v * t for v, t in rested) == far
    assert loss(rested) > loss(ways)


NODES, WEIGHTS = np.polynomial.legendre.leggauss(400)


@seeds(12)
def test_smooth_motions_by_quadrature(seed):
    """Polynomials of degree 6 with random speeds at both ends: above the least by more than rounding."""
    rng = np.random.default_rng(seed)
    rate = np.polynomial.Polynomial(rng.normal(size=6))  # velocity over t/T
    v, t = rate((NODES + 1) / 2), float(PERIOD)
    found = t / 2 * WEIGHTS @ (float(FRICTION) * np.abs(v) + float(DAMPING) * v**2)
    far = Fraction(t * (rate.integ()(1) - rate.integ()(0)))
    assert found > float(PAID.lost(far, Fraction(1))) * (1 + 1e-6)


@pytest.mark.parametrize("end", [1e-2, 1e-4, 1e-6])
def test_given_speeds_at_the_ends_are_approached_and_not_attained(end):
    """In from 2 m/s and out at −1 m/s: the excess falls with the time of the change."""
    before, after, far, t = 2.0, -1.0, 1e-3, float(PERIOD)
    short = end * t
    middle = (far - short * (before + after) / 2) / (t - short)
    ramps = [np.linspace(before, middle, 2001), np.linspace(middle, after, 2001)]
    power = [float(FRICTION) * np.abs(v) + float(DAMPING) * v**2 for v in ramps]
    found = sum(short * np.trapezoid(p, dx=1 / 2000) for p in power)
    found += (float(FRICTION) * abs(middle) + float(DAMPING) * middle**2) * (t - 2 * short)
    least = float(PAID.lost(Fraction(far), Fraction(1)))
    assert least < found < least * (1 + 40 * end)
