"""The coupling: series stiffness, its own bound, bad input."""

from fractions import Fraction

import control
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import zwidth as zw

T = Fraction(1, 1000)
Z = np.exp(1j * np.linspace(0.05, np.pi, 60))


def evaluate(law, z=Z):
    top, bottom = ([float(c) for c in p] for p in law.pulse_transfer_function(T))
    return np.polyval(top, z) / np.polyval(bottom, z)


@pytest.mark.parametrize(
    "inner",
    [
        zw.Wall(290, 1.3),
        zw.StandardLinearSolid(290, 731, 4, "zoh"),
        zw.PulseTransferFunction([310, -250], [0.7, -0.5]),
    ],
)
def test_compliances_add(inner):
    """1/H = 1/Z_c + 1/E at every frequency."""
    coupling = zw.VirtualCoupling(820, 2.1, inner)
    zc = 820 + 2.1 * (Z - 1) / (1e-3 * Z)
    assert 1 / evaluate(coupling) == pytest.approx(1 / zc + 1 / evaluate(inner), rel=1e-12)


@settings(deadline=None)
@given(st.fractions(1, 900, max_denominator=97), st.fractions(1, 900, max_denominator=97))
def test_two_springs_in_series(k, inner):
    """H = K_c K/(K_c + K), exactly, and memoryless."""
    law = zw.VirtualCoupling(k, 0, zw.Wall(inner))
    top, bottom = law.pulse_transfer_function(T)
    assert len(top) == len(bottom) == 1
    assert top[0] / bottom[0] == k * inner / (k + inner)
    assert law.spring


def required_damping(h):
    """(T/2) Re{(1 − z⁻¹) H}/(1 − cos θ), its largest value over the frequencies."""
    return np.max(5e-4 * np.real((1 - 1 / Z) * h) / (1 - np.real(Z)))


@settings(deadline=None)
@given(st.floats(1, 5000), st.floats(1, 5000), st.floats(0.01, 50))
def test_a_passive_environment_needs_no_more_than_the_coupling_alone(k, mu, eta):
    """Before a solid that is passive in discrete time, K_c T/2 + B_c is always enough."""
    solid = zw.StandardLinearSolid(k, mu, eta, "backward")
    # from velocity (z − 1) x/(T z) to force
    assert np.min(np.real(evaluate(solid) * Z / (Z - 1))) >= 0
    assert required_damping(evaluate(zw.VirtualCoupling(820, 0.3, solid))) <= (820 * 5e-4 + 0.3) * (1 + 1e-9)


def test_a_rigid_environment_needs_what_the_coupling_alone_needs():
    law = zw.VirtualCoupling(820, 0.3, zw.Wall(1e12))
    assert required_damping(evaluate(law)) == pytest.approx(820 * 5e-4 + 0.3, rel=1e-6)


def test_surface_and_rounding_follow_the_environment():
    wall, free = zw.Wall(290, 1.3), zw.PulseTransferFunction([1], [1, 0.5])
    assert zw.VirtualCoupling(820, 2, wall).unilateral
    assert not zw.VirtualCoupling(820, 2, free).unilateral
    assert not zw.VirtualCoupling(820, 2, zw.Wall(290)).spring
    assert not zw.VirtualCoupling(820, 2, wall).coefficients_rounded
    assert zw.VirtualCoupling(820, 2, zw.Maxwell(3, 4, "zoh")).coefficients_rounded
    assert not zw.VirtualCoupling(820, 2, zw.Wall((1, 2))).is_certain


def test_foreign_systems_are_accepted():
    system = control.tf([310.0, -250.0], [0.7, -0.5], 1e-3)
    assert zw.VirtualCoupling(820, 2.1, system).environment == zw.PulseTransferFunction(system)


def test_nested_couplings_are_typed_again():
    law = zw.VirtualCoupling(820, 2, zw.VirtualCoupling(700, 1, zw.Maxwell(3, 4)))
    assert eval(repr(law), vars(zw)) == law
    assert law.replace(stiffness=5).stiffness == 5
