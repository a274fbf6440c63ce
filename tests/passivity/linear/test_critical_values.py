"""Values at which a verdict may change: those that are known are among them."""

from __future__ import annotations

from fractions import Fraction

import pytest

import zwidth as zw
from zwidth.model.environment import RationalFunction
from zwidth.passivity.linear.critical_values import critical_values
from zwidth.passivity.linear.loop import linear_loop

T = Fraction(1, 1000)
BOTH_SIDES = zw.PulseTransferFunction([1], [1])


def device(delay):
    """b = 0.15 N·s/m at 1 kHz, with so many samples of delay."""
    return zw.Device(damping="0.15", sample_period=T, delay=delay * T)


def spring(m):
    """H = m."""
    return RationalFunction((m,), (Fraction(1),))


def damper(m):
    """H = 40 + m (z − 1)/(T z)."""
    return RationalFunction((40 * T + m, -m), (T, Fraction(0)))


def relaxing(m):
    """H = 90 (z − 1)/(z − m): a pole that leaves the circle at m = 1."""
    return RationalFunction((Fraction(90), Fraction(-90)), (Fraction(1), -m))


def sinking(m):
    """H = m − 100, which is a negative spring below 100."""
    return RationalFunction((m - 100,), (Fraction(1),))


@pytest.mark.parametrize(
    ("law", "delay", "limit"),
    [
        (spring, Fraction(0), 300.0),
        (spring, Fraction(2), 60.0),
        (spring, Fraction(1, 2), float(zw.check(device(Fraction(1, 2)), zw.Wall(1)).max_stiffness)),
        (damper, Fraction(0), 0.13),
        (relaxing, Fraction(0), 1.0),
        (sinking, Fraction(0), 100.0),
        (sinking, Fraction(0), 400.0),
    ],
)
def test_a_limit_that_is_known_is_found(law, delay, limit):
    """Of a spring 2b/((2d + 1) T), of a damper b − K T/2, of a pole 1, of a sum 0."""
    loop = linear_loop(device(delay), BOTH_SIDES)
    found = critical_values(law, 1, loop, Fraction(10))
    assert any(abs(float(value) - limit) <= 1e-12 * limit for value in found)
    assert found == sorted(found)
    assert all(value > 0 for value in found)


def test_where_nothing_changes_there_is_none_or_one_to_spare():
    """H = 1/m is passive from some m on; the degree may be given too high."""
    found = critical_values(
        lambda m: RationalFunction((Fraction(1),), (m,)), 3, linear_loop(device(0), BOTH_SIDES), Fraction(1)
    )
    assert [float(value) for value in found] == pytest.approx([1 / 300])
