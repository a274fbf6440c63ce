"""The solid as a recursion and back; and what the printed five parameters leave open."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import zwidth as zw
from zwidth.data.tissue import (
    coefficients,
    five_parameters,
    force_response,
    solid_of,
    solid_of_five,
)

T = Fraction(1, 1000)
positive = st.fractions(Fraction(1, 50), 900, max_denominator=997)


@given(positive, positive, positive, st.sampled_from(["bilinear", "backward"]))
def test_there_and_back_exactly(mu0, mu1, eta1, rule):
    """For every rational solid, without rounding."""
    assert solid_of(*coefficients(mu0, mu1, eta1, T, rule), T, rule) == (mu0, mu1, eta1)


@given(positive, positive, positive)
def test_there_and_back_of_the_material(mu0, mu1, eta1):
    """With an exponential: to the rounding that 1 + p leaves."""
    solid = [float(v) for v in (mu0, mu1, eta1)]
    back = solid_of(*coefficients(*solid, 1e-3), 1e-3)
    lost = 1 + solid[2] / solid[1] / 1e-3 + solid[1] / solid[0] * solid[2] / solid[1] / 1e-3
    assert back == pytest.approx(solid, rel=1e-14 * lost * (1 + solid[0] / solid[1]))


@pytest.mark.parametrize(("rule", "method"), [("bilinear", "tustin"), ("backward", "backward")])
def test_the_recursion_is_the_transfer_function_of_the_environment(rule, method):
    """H(z) = (b0 + b1 z⁻¹)/(1 + p z⁻¹), exactly."""
    solid = Fraction(31, 7), Fraction(13, 3), Fraction(2, 9)
    num, den = zw.StandardLinearSolid(*solid, method).pulse_transfer_function(T)
    p, b0, b1 = coefficients(*solid, T, rule)
    assert (num[0] / den[0], num[1] / den[0], den[1] / den[0]) == (b0, b1, p)


def test_the_ramp_recursion_is_the_material_under_straight_lines():
    """Sample by sample, as the continuous-time response has it."""
    x = np.cumsum(np.random.default_rng(2).normal(0, 1e-3, 300))
    p, b0, b1 = coefficients(310.0, 150.0, 4.1, 1e-3)
    expected = force_response(zw.StandardLinearSolid(310, 150, 4.1), 1e-3 * np.arange(300), x)
    assert expected[1:] == pytest.approx(-p * expected[:-1] + b0 * x[1:] + b1 * x[:-1], abs=1e-12)


@given(positive, positive, positive)
def test_the_printed_inversion_is_right_with_the_printed_factor(mu0, mu1, eta1):
    """Equation (32), with the slip in a1 corrected: c = 1 gives the solid back exactly."""
    a1, _, b1, _, b3 = five_parameters(mu0, mu1, eta1, T)
    assert solid_of_five(a1, b1, b3, T) == (mu0, mu1, eta1)


def test_the_printed_parameters_are_one_of_a_line():
    """Any factor (1 + c z⁻¹) explains the same forces exactly, and another c gives another solid."""
    solid = Fraction(300), Fraction(150), Fraction(15)
    x = [Fraction(int(v), 10**6) for v in np.random.default_rng(4).integers(0, 9000, 30)]
    p, b0, b1 = coefficients(*solid, T, "bilinear")
    force = [b0 * x[0]]
    for now, before in zip(x[1:], x, strict=False):
        force.append(-p * force[-1] + b0 * now + b1 * before)
    for c in (Fraction(1), Fraction(0), Fraction(-3, 7)):
        five = five_parameters(*solid, T, c)
        for k in range(2, 30):
            terms = (-force[k - 1], -force[k - 2], x[k], x[k - 1], x[k - 2])
            assert force[k] == sum(a * b for a, b in zip(five, terms, strict=True))
        assert (solid_of_five(five[0], five[2], five[4], T) == solid) is (c == 1)


def test_bad_input():
    """A recursion that is no solid's."""
    with pytest.raises(zw.InputError, match="p is > −1 and < 1 for a solid that relaxes, got 1"):
        solid_of(Fraction(1), Fraction(1), Fraction(1), T, "bilinear")
    with pytest.raises(zw.InputError, match="p is > −1 and < 0 for a solid that relaxes"):
        solid_of(0.2, 1.0, 1.0, 1e-3)
