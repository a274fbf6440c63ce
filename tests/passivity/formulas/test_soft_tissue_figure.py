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
MILLISECOND, HALF = Fraction(1, 1000), Fraction(1, 2)
FIGURES = {
    "a": [(eta, MILLISECOND) for eta in DAMPING_AXIS],
    "b": [(HALF, period) for period in PERIOD_AXIS],
}


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


@pytest.mark.parametrize("figure", FIGURES)
def test_both_roads_agree_at_every_point(figure):
    """To 1e-12; beyond |B| = b no Kelvin–Voigt solid, not even of stiffness 0, is passive."""
    for eta, period in FIGURES[figure]:
        solid = by_engine(lambda k, eta=eta: zw.StandardLinearSolid(k, MU1, eta), period)
        assert solid == pytest.approx(float(standard_linear_solid(eta, period)), rel=1e-12)
        found, closed = by_engine(lambda k, eta=eta: zw.Wall(k, eta), period), kelvin_voigt(eta, period)
        if eta > DAMPING:
            assert closed < 0
            assert found is None
        else:
            assert found == pytest.approx(float(closed), rel=1e-12)


def test_the_ends_of_the_curves():
    """At η1 = B = 0 both of figure 4(a) start at 2b/T = 540 N/m; at B = b no stiffness is left."""
    assert kelvin_voigt(0, MILLISECOND) == 540
    assert by_engine(lambda k: zw.Wall(k, 0), MILLISECOND) == 540
    assert by_engine(lambda k: zw.StandardLinearSolid(k, MU1, 0), MILLISECOND) == 540
    for period in PERIOD_AXIS:
        assert kelvin_voigt(DAMPING, period) == 0
        assert by_engine(lambda k: zw.Wall(k, DAMPING), period) == 0


def test_shapes_of_the_curves():
    """The solid's falls from 540 towards 540 − μ1 = 530 N/m, above Kelvin–Voigt; and it falls with T."""
    over_damping, over_period = ([standard_linear_solid(*at) for at in points] for points in FIGURES.values())
    for curve in (over_damping, over_period):
        assert curve == sorted(curve, reverse=True)
    assert all(530 < k < 540 for k in over_damping)
    assert all(k > kelvin_voigt(*at) for k, at in zip(over_damping, FIGURES["a"], strict=True))
    assert [round(float(k), 3) for k in over_period[:: len(over_period) - 1]] == [1070.050, 98.476]
