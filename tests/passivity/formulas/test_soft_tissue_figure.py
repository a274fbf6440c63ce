"""The critical stiffness of "A passivity criterion for real-time haptic simulation of viscoelastic
soft tissues", figure 4(a) and (b), recomputed by two roads.

A PHANToM with b = 0.27 N·s/m renders a standard linear solid (backward Euler, μ1 = 10 N/m) or a
Kelvin–Voigt solid of the same damping.  The critical stiffness is the largest passive K or μ0: from
the closed forms, and by halving the doubles with the exact engine.
"""

from __future__ import annotations

from fractions import Fraction

import pytest

import zwidth as zw
from zwidth.passivity import formulas as forms
from zwidth.passivity.linear.boundary import largest_holding
from zwidth.passivity.linear.criterion import LinearProof, decide_linear
from zwidth.passivity.linear.loop import loop_from

DAMPING = Fraction("0.27")
MU1 = Fraction(10)
DAMPING_AXIS = [Fraction(i, 100) for i in range(1, 27, 5)] + [Fraction(i, 2) for i in range(1, 29)]
PERIOD_AXIS = [Fraction(i, 4000) for i in range(2, 21)]
FIGURE_A = [(eta, Fraction(1, 1000)) for eta in DAMPING_AXIS]
FIGURE_B = [(Fraction(1, 2), period) for period in PERIOD_AXIS]


def by_engine(environment, period, guess=100.0):
    """The largest K that the exact engine proves, to the last double; None where K = 0 fails."""

    def holds(stiffness):
        h = environment(stiffness).pulse_transfer_function(period)
        return isinstance(decide_linear(loop_from(h, DAMPING, period, Fraction(0))), LinearProof)

    return largest_holding(holds, guess)


def standard_linear_solid(eta, period):
    """Critical μ0 by the closed form: required damping grows with μ0 by T/2."""
    branch = forms.standard_linear_solid_damping(0, MU1, eta, period).fraction
    return 2 * (DAMPING - branch) / period


def kelvin_voigt(eta, period):
    """Critical K by the closed form; negative where no stiffness is passive."""
    return 2 * (DAMPING - forms.kelvin_voigt_damping(0, eta, period).fraction) / period


@pytest.mark.parametrize(("eta", "period"), FIGURE_A + FIGURE_B)
def test_standard_linear_solid_curve(eta, period):
    """Both roads agree to 1e-12 at every point of both figures."""
    found = by_engine(lambda k: zw.StandardLinearSolid(k, MU1, eta), period)
    assert found == pytest.approx(float(standard_linear_solid(eta, period)), rel=1e-12)


@pytest.mark.parametrize(("eta", "period"), FIGURE_A + FIGURE_B)
def test_kelvin_voigt_curve(eta, period):
    """Both roads agree to 1e-12 up to |B| = b; beyond it no stiffness, not even 0, is passive."""
    found, closed = by_engine(lambda k: zw.Wall(k, eta), period), kelvin_voigt(eta, period)
    if eta > DAMPING:
        assert closed < 0
        assert found is None
    else:
        assert found == pytest.approx(float(closed), rel=1e-12)


def test_without_environment_damping_both_are_springs():
    """At η1 = B = 0 both curves of figure 4(a) start at 2b/T = 540 N/m."""
    period = Fraction(1, 1000)
    assert kelvin_voigt(0, period) == 540
    assert by_engine(lambda k: zw.Wall(k, 0), period) == 540
    assert by_engine(lambda k: zw.StandardLinearSolid(k, MU1, 0), period) == 540


def test_kelvin_voigt_curve_ends_at_the_device_damping():
    """At B = b = 0.27 the critical stiffness is exactly 0, in figure 4(a) and for every T."""
    for period in PERIOD_AXIS:
        assert kelvin_voigt(DAMPING, period) == 0
        assert by_engine(lambda k: zw.Wall(k, DAMPING), period) == 0


def test_shape_of_figure_a():
    """The solid's curve falls from 540 towards 540 − μ1 = 530 N/m and stays above Kelvin–Voigt."""
    period = Fraction(1, 1000)
    curve = [standard_linear_solid(eta, period) for eta in DAMPING_AXIS]
    assert curve == sorted(curve, reverse=True)
    assert all(530 < k < 540 for k in curve)
    assert all(k > kelvin_voigt(eta, period) for k, eta in zip(curve, DAMPING_AXIS, strict=True))


def test_shape_of_figure_b():
    """The solid's curve falls with T; Kelvin–Voigt with B = 0.5 > b is negative at every T."""
    eta = Fraction(1, 2)
    curve = [standard_linear_solid(eta, period) for period in PERIOD_AXIS]
    assert curve == sorted(curve, reverse=True)
    assert (round(float(curve[0]), 3), round(float(curve[-1]), 3)) == (1070.050, 98.476)
    assert all(kelvin_voigt(eta, period) < 0 for period in PERIOD_AXIS)
