"""A body behind a coupling: H(z) against the program that steps it, and what is refused."""

import random
from fractions import Fraction
from typing import get_args

import pytest
from stepped_body import forces

import zwidth as zw
from zwidth.model.environment.bodies import Integrator
from zwidth.model.environment.environment import multiply

T = Fraction(1, 1000)
INTEGRATORS = get_args(Integrator)
NUMBERS = {"body_damping": "0.3", "body_stiffness": 40}
EXCHANGES = {
    "at once": {},
    "naive": {"exchange_delay": 2},
    "waves": {"exchange_delay": 2, "wave_impedance": "0.7"},
}


def response(law, positions):
    """The forces of H(z), by its difference equation."""
    num, den = law.pulse_transfer_function(T)
    num = (*[Fraction(0)] * (len(den) - len(num)), *num)
    found = []
    for k in range(len(positions)):
        total = sum(c * positions[k - i] for i, c in enumerate(num) if k >= i)
        total -= sum(c * found[k - i] for i, c in enumerate(den) if i and k >= i)
        found.append(total / den[0])
    return found


@pytest.mark.parametrize("exchange", EXCHANGES)
@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.parametrize("body", [{}, NUMBERS], ids=["free", "held"])
def test_it_is_what_the_program_does(integrator, body, exchange):
    law = zw.coupling.CoupledBody(130, "0.06", "0.8 g", integrator=integrator, **body, **EXCHANGES[exchange])
    draw = random.Random(7)
    positions = [Fraction(draw.randint(-9, 9), 1000) for _ in range(14)]
    assert response(law, positions) == forces(law, T, positions)
    assert any(response(law, positions))


def test_without_own_losses_both_runge_kutta_methods_are_the_motion_itself():
    two, four = (
        zw.coupling.CoupledBody(130, "0.06", "0.8 g", integrator=f"runge-kutta-{order}") for order in (2, 4)
    )
    assert two.pulse_transfer_function(T) == four.pulse_transfer_function(T)


def test_behind_the_coupling_stands_the_same_body():
    """By backward differences of both ends it is `VirtualCoupling` before E(z) = M (z − 1)²/(T² z²)."""
    rate = Fraction(1, 1000) / T**2
    body = zw.PulseTransferFunction([rate, -2 * rate, rate], [1, 0, 0])
    whole = zw.coupling.CoupledBody(130, "0.06", "1 g", integrator="backward-euler")
    parts = zw.VirtualCoupling(130, "0.06", body)
    device = zw.Device(damping="0.15", rate=1000)
    assert zw.check(device, whole).required_damping == zw.check(device, parts).required_damping


def test_a_scene_steps_its_bodies_by_the_implicit_midpoint():
    parts = [
        zw.scene.Mass("tip", "1 g"),
        zw.scene.Damper("tip", "ground", "0.3"),
        zw.scene.Spring("tip", "ground", 40),
    ]
    there = zw.VirtualCoupling(130, "0.06", zw.Scene(parts, port="tip"))
    here = zw.coupling.CoupledBody(130, "0.06", "1 g", integrator="implicit-midpoint", **NUMBERS)
    a, b = (law.pulse_transfer_function(T) for law in (there, here))
    tops = [(*[Fraction(0)] * (len(h.denominator) - len(h.numerator)), *h.numerator) for h in (a, b)]
    assert multiply(tops[0], b.denominator) == multiply(tops[1], a.denominator)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"virtual_mass": 0}, "virtual_mass must be > 0"),
        ({"damping": -1}, "damping must be ≥ 0"),
        ({"body_stiffness": -1}, "body_stiffness must be ≥ 0"),
        ({"integrator": "euler"}, "integrator is one of"),
        ({"exchange_delay": "1.5"}, "whole number of samples"),
        ({"exchange_delay": 41}, "up to 40, got 41"),
        ({"wave_impedance": 1}, "without exchange_delay there is none"),
        ({"wave_impedance": 0, "exchange_delay": 1}, "wave_impedance must be > 0"),
    ],
)
def test_what_is_no_such_body_is_refused(changes, message):
    with pytest.raises(zw.InputError, match=message):
        zw.coupling.CoupledBody(**{"stiffness": 100, "damping": 0, "virtual_mass": 1, **changes})


def test_it_says_its_numbers():
    """Those that are not 0."""
    law = zw.coupling.CoupledBody(100, "0.05", 1, "0.2", 3, exchange_delay=2, wave_impedance=4)
    assert law.describe() == (
        "virtual coupling, 100 N/m, 0.05 N·s/m, before a mass of 1 kg, on 0.2 N·s/m and 3 N/m, "
        "by semi implicit euler, 2 samples away, through a line of 4 N·s/m"
    )
