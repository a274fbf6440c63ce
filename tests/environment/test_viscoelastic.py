"""Springs with Maxwell branches: closed forms, relaxation, bad input."""

import pickle
from fractions import Fraction

import control
import numpy as np
import pytest
import scipy.signal
from hypothesis import given, settings
from hypothesis import strategies as st

import zwidth as zw
from zwidth.model.environment.discretization import CHOICES

T = Fraction(1, 1000)
positive = st.fractions(Fraction(1, 50), 900, max_denominator=997)


def at(transfer, z):
    """H(z), exactly for a rational z."""
    values = []
    for part in transfer:
        total = Fraction(0)
        for c in part:
            total = total * z + c
        values.append(total)
    return values[0] / values[1]


def closed_form(mu0, mu1, eta1, method, period, z):
    """The branch formulas with the substituted operator written out by hand."""
    if method == "backward":
        return mu0 + mu1 * eta1 * (z - 1) / ((mu1 * period + eta1) * z - eta1)
    if method == "forward":
        return mu0 + mu1 * eta1 * (z - 1) / (eta1 * (z - 1) + mu1 * period)
    return mu0 + 2 * mu1 * eta1 * (z - 1) / (2 * eta1 * (z - 1) + mu1 * period * (z + 1))


def response(transfer, inputs):
    """The recursion that a controller runs."""
    top, bottom = (np.array([float(c) for c in p]) for p in transfer)
    top = np.concatenate([np.zeros(len(bottom) - len(top)), top])
    return scipy.signal.lfilter(top, bottom, inputs)


@settings(deadline=None)
@given(positive, positive, positive, st.sampled_from(["backward", "forward", "tustin"]))
def test_standard_linear_solid_is_the_closed_form_exactly(mu0, mu1, eta1, method):
    solid = zw.StandardLinearSolid(mu0, mu1, eta1, method)
    for z in (Fraction(-1), Fraction(7, 3), Fraction(-13, 5)):
        if method == "forward" and eta1 * (z - 1) + mu1 * T == 0:
            continue
        assert at(solid.pulse_transfer_function(T), z) == closed_form(mu0, mu1, eta1, method, T, z)


@settings(deadline=None)
@given(positive, positive, positive)
def test_required_damping_at_nyquist_is_the_published_one(mu0, mu1, eta1):
    """(T/2) H(−1) is μ0 T/2 + μ1 η1 T/(2 η1 + μ1 T) by backward Euler, (μ0 + μ1) T/2 by Tustin."""
    half = T / 2
    backward = zw.StandardLinearSolid(mu0, mu1, eta1).pulse_transfer_function(T)
    tustin = zw.StandardLinearSolid(mu0, mu1, eta1, "tustin").pulse_transfer_function(T)
    assert half * at(backward, -1) == mu0 * half + mu1 * eta1 * T / (2 * eta1 + mu1 * T)
    assert half * at(tustin, -1) == half * (mu0 + mu1)


def test_zero_order_hold_relaxes_as_the_solid_itself():
    """A held position meets the continuous relaxation μ0 + μ1 exp(−t μ1/η1) at every sample."""
    solid = zw.StandardLinearSolid(290, 731, 40, "zoh")
    force = response(solid.pulse_transfer_function(T), np.ones(200))
    assert force == pytest.approx(290 + 731 * np.exp(-np.arange(200) * 1e-3 * 731 / 40), rel=1e-12)


@pytest.mark.parametrize("method", CHOICES)
def test_one_branch_is_the_standard_linear_solid(method):
    solid = zw.StandardLinearSolid(290, 731, 40, method).pulse_transfer_function(T)
    assert zw.GeneralizedMaxwell(290, [(731, 40)], method).pulse_transfer_function(T) == solid
    without = zw.StandardLinearSolid(0, 731, 40, method).pulse_transfer_function(T)
    assert zw.Maxwell(731, 40, method).pulse_transfer_function(T) == without


@settings(deadline=None)
@given(st.lists(st.tuples(positive, positive), min_size=1, max_size=4))
def test_branches_add(branches):
    z = Fraction(-17, 6)
    series = zw.GeneralizedMaxwell(57, branches).pulse_transfer_function(T)
    apart = sum(at(zw.Maxwell(*b).pulse_transfer_function(T), z) for b in branches)
    assert at(series, z) == 57 + apart


def test_python_control_makes_the_same_pulse_transfer_function():
    """control.sample_system of the sum of branches, by Tustin and by the hold."""
    s = control.tf("s")
    law = 57 + 731 * 40 * s / (731 + 40 * s) + 95 * 2.5 * s / (95 + 2.5 * s)
    solid = zw.GeneralizedMaxwell(57, [(731, 40), (95, 2.5)])
    z = np.exp(1j * np.array([0.2, 1.1, 3.0]))
    for method in ("tustin", "zoh"):
        theirs = control.sample_system(law, 1e-3, method)(z)
        top, bottom = solid.replace(discretization=method).pulse_transfer_function(T)
        ours = np.polyval([float(c) for c in top], z) / np.polyval([float(c) for c in bottom], z)
        assert ours == pytest.approx(theirs, rel=1e-8)


def test_void_branches_leave_a_spring():
    """μ1 = 0 or η1 = 0 is a memoryless spring, and says so."""
    for solid in (
        zw.StandardLinearSolid(290, 0, 40, "zoh"),
        zw.StandardLinearSolid(290, 731, 0),
        zw.GeneralizedMaxwell(290, [(0, 3), (5, 0)]),
        zw.GeneralizedMaxwell(290, []),
    ):
        assert solid.spring
        assert not solid.coefficients_rounded
        assert solid.pulse_transfer_function(T) == ((Fraction(290),), (Fraction(1),))
    assert zw.Maxwell(290, 0).pulse_transfer_function(T) == ((Fraction(0),), (Fraction(1),))
    assert not zw.StandardLinearSolid(290, 731, 40).spring


def test_negative_damping_has_an_unstable_pole_or_no_transfer_function():
    """η1 < 0 puts the pole η1/(μ1 T + η1) outside the unit circle; at η1 = −μ1 T there is none."""
    den = zw.StandardLinearSolid(290, 731, -40).pulse_transfer_function(T).denominator
    assert -den[1] / den[0] > 1
    with pytest.raises(zw.InputError, match="infinity"):
        zw.StandardLinearSolid(290, 731, "-0.731").pulse_transfer_function(T)


def test_solids_are_values_that_say_their_numbers():
    solid = zw.StandardLinearSolid(290, (731, 740), 0.5)
    assert solid.describe() == (
        "standard linear solid, 290 N/m beside (731 … 740 N/m in series with 0.5 N·s/m), "
        "discretization backward"
    )
    assert "N·m/rad" in solid.describe("rotary")
    assert (
        zw.Maxwell(7, 2).describe() == "Maxwell body, (7 N/m in series with 2 N·s/m), discretization backward"
    )
    series = zw.GeneralizedMaxwell(290, [(731, 40)])
    assert series.describe().startswith("generalized Maxwell, 290 N/m beside (731 N/m")
    assert eval(repr(series), vars(zw)) == pickle.loads(pickle.dumps(series)) == series
    for own in (solid, zw.Maxwell(7, 2), series):
        assert (own.unilateral, own.coefficients_rounded) == (True, False)
        assert own.replace(discretization="zoh").coefficients_rounded


def test_intervals_are_kept_and_not_evaluated():
    series = zw.GeneralizedMaxwell(290, [(731, 40), (5, (1, 2))])
    assert not series.is_certain
    with pytest.raises(zw.InputError, match=r"branches\[1\] damping is the interval 1 … 2"):
        series.pulse_transfer_function(T)
    with pytest.raises(zw.InputError, match="branch_stiffness is the interval"):
        zw.StandardLinearSolid(290, (1, 2), 3).pulse_transfer_function(T)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: zw.StandardLinearSolid(-1, 2, 3), "stiffness must be ≥ 0"),
        (lambda: zw.StandardLinearSolid(1, (-2, 2), 3), "branch_stiffness must be ≥ 0"),
        (lambda: zw.StandardLinearSolid(1, 2, "x"), r"branch_damping is in N\*s/m; got .x.: expected"),
        (lambda: zw.StandardLinearSolid(1, 2, 3, "euler"), 'one of "backward"'),
        (lambda: zw.Maxwell(float("nan"), 3), "stiffness is in N/m: expected a finite number"),
        (lambda: zw.Maxwell(1, 3, None), 'one of "backward"'),
        (lambda: zw.GeneralizedMaxwell(1, [(2, 3, 4)]), r"branches\[0\] is a pair"),
        (lambda: zw.GeneralizedMaxwell(1, [(2, 3), (-2, 3)]), r"branches\[1\] stiffness must be ≥ 0"),
        (lambda: zw.GeneralizedMaxwell(1, "23"), "list of pairs"),
        (lambda: zw.GeneralizedMaxwell(1, 23), "list of pairs"),
        (lambda: zw.GeneralizedMaxwell(1, [(1, 1)] * 61), "61 pairs; at most 60"),
    ],
)
def test_bad_input_has_one_clear_message(make, message):
    with pytest.raises(zw.InputError, match=message):
        make()
