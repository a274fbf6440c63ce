"""The last value that holds, found from wherever the search begins; values at which a verdict may change."""

from __future__ import annotations

from fractions import Fraction
from math import inf

import pytest
from hypothesis import given
from hypothesis import strategies as st

import zwidth as zw
from zwidth.model.environment import RationalFunction
from zwidth.passivity.linear.boundary import COARSE, largest_holding, smallest_holding
from zwidth.passivity.linear.critical_values import critical_values
from zwidth.passivity.linear.loop import linear_loop

ANYWHERE = st.floats(1e-14, 1e14)


@given(limit=ANYWHERE, guess=ANYWHERE, likely=st.none() | ANYWHERE | st.sampled_from([0.0, inf]))
def test_what_is_likely_changes_no_answer(limit: float, guess: float, likely: float | None) -> None:
    """However wrong it is: to the last double the limit is found, from both sides."""
    at = Fraction(repr(limit))
    assert largest_holding(lambda value: value <= at, guess, likely=likely) == limit
    assert smallest_holding(lambda value: value >= at, guess, likely=likely) == limit


@given(limit=ANYWHERE, guess=ANYWHERE, off=st.floats(-1e-9, 1e-9))
def test_in_coarse_steps_it_holds_and_is_near(limit: float, guess: float, off: float) -> None:
    at = Fraction(repr(limit))
    near = limit * (1 + off)
    low = largest_holding(lambda value: value <= at, guess, COARSE, near)
    high = smallest_holding(lambda value: value >= at, guess, COARSE, near)
    assert limit * (1 - 5e-7) <= low <= limit <= high <= limit * (1 + 5e-7)


@pytest.mark.parametrize("likely", [None, 0.0, 3.0, inf])
def test_where_all_or_nothing_holds_it_is_said(likely: float | None) -> None:
    assert largest_holding(lambda value: True, 2.0, likely=likely) == inf
    assert largest_holding(lambda value: value == 0, 2.0, likely=likely) == 0
    assert largest_holding(lambda value: False, 2.0, likely=likely) is None
    assert smallest_holding(lambda value: True, 2.0, likely=likely) == 0
    assert smallest_holding(lambda value: False, 2.0, likely=likely) is None


def test_where_it_is_likely_few_decisions_do() -> None:
    """Four in place of thirty."""
    asked = []

    def holds(value: Fraction) -> bool:
        asked.append(value)
        return value <= Fraction("312.5")

    assert largest_holding(holds, 7.0, COARSE, 312.5) == 312.5
    assert len(asked) <= 4


T = Fraction(1, 1000)
BOTH_SIDES = zw.PulseTransferFunction([1], [1])


def device(delay):
    return zw.Device(damping="0.15", sample_period=T, delay=delay * T)


def h(numerator, denominator):
    """H(z) of descending coefficients."""
    return RationalFunction(tuple(map(Fraction, numerator)), tuple(map(Fraction, denominator)))


LAWS = {
    "spring": lambda m: ((m,), (1,)),
    "damper": lambda m: ((40 * T + m, -m), (T, 0)),
    "relaxing": lambda m: ((90, -90), (1, -m)),
    "sinking": lambda m: ((m - 100,), (1,)),
}
"""H = m; 40 + m (z − 1)/(T z); 90 (z − 1)/(z − m), a pole that leaves the circle at m = 1; m − 100."""


@pytest.mark.parametrize(
    ("law", "delay", "limit"),
    [
        ("spring", 0, 300.0),
        ("spring", 2, 60.0),
        ("spring", Fraction(1, 2), float(zw.check(device(Fraction(1, 2)), zw.Wall(1)).max_stiffness)),
        ("damper", 0, 0.13),
        ("relaxing", 0, 1.0),
        ("sinking", 0, 100.0),
        ("sinking", 0, 400.0),
    ],
)
def test_a_limit_that_is_known_is_found(law, delay, limit):
    """Of a spring 2b/((2d + 1) T), of a damper b − K T/2, of a pole 1, of a sum 0."""
    loop = linear_loop(device(delay), BOTH_SIDES)
    found = critical_values(lambda m: h(*LAWS[law](m)), 1, loop, Fraction(10))
    assert any(abs(float(value) - limit) <= 1e-12 * limit for value in found)
    assert found == sorted(found)
    assert all(value > 0 for value in found)


def test_where_nothing_changes_there_is_none_or_one_to_spare():
    """H = 1/m is passive from some m on; the degree may be given too high."""
    loop = linear_loop(device(0), BOTH_SIDES)
    found = critical_values(lambda m: h((1,), (m,)), 3, loop, Fraction(1))
    assert [float(value) for value in found] == pytest.approx([1 / 300])
