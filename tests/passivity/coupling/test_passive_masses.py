"""Masses of a body behind a coupling: ends from both sides, a grid of frequencies, theorems."""

from __future__ import annotations

import random
from fractions import Fraction
from math import inf
from typing import get_args

import numpy as np
import pytest
from stepped_body import forces
from strategies import seeds

import zwidth as zw
from zwidth.checker import judge
from zwidth.model.environment.bodies import Integrator

passive_masses, heavy_body_damping = zw.coupling.passive_masses, zw.coupling.heavy_body_damping
T = Fraction(1, 1000)
B = Fraction(3, 20)
DEVICE = zw.Device(damping=B, sample_period=T)
INTEGRATORS = get_args(Integrator)
EXPLICIT = INTEGRATORS[:5]
IMPLICIT = INTEGRATORS[5:7]


def body(stiffness, damping, **more):
    """A body of a gram behind K_c and B_c."""
    return zw.coupling.CoupledBody(stiffness, damping, "1 g", **more)


def masses(stiffness, damping, device=DEVICE, **more):
    return passive_masses(device, body(stiffness, damping, **more))


def passive_on_a_grid(law, device, points=6000):
    """The criterion and the poles, with numpy, near every resonance too."""
    num, den = ([float(c) for c in side] for side in law.pulse_transfer_function(T))
    poles = np.roots(den)
    if np.max(np.abs(poles)) >= 1:
        return False
    near = np.abs(np.angle(poles))[:, None] + (1 - np.abs(poles))[:, None] * np.linspace(-3, 3, 61)
    theta = np.concatenate((np.linspace(0, np.pi, points + 1)[1:], near.ravel()))
    z = np.exp(1j * theta[(theta > 1e-6) & (theta <= np.pi)])
    late = z ** -float(device.exact("delay") / T)
    h = np.polyval(num, z) / np.polyval(den, z)
    need = float(T) / 2 * np.real((1 - 1 / z) * late * h) / (1 - z.real)
    return bool(np.max(need) <= float(device.exact("damping")) * (1 + 1e-9))


CASES = {
    "semi-implicit": (DEVICE, body(100, "0.05")),
    "Verlet": (DEVICE, body(200, "0.02", integrator="velocity-verlet")),
    "held": (DEVICE, body(50, "0.06", integrator="runge-kutta-4", body_damping="0.2", body_stiffness=90)),
    "forward": (DEVICE, body(50, "0.06", integrator="forward-euler")),
    "two intervals": (DEVICE, body(200, "0.02", integrator="trapezoidal")),
    "two samples late": (DEVICE.replace(delay="2 ms"), body(41, "0.0024")),
    "part of a sample late": (DEVICE.replace(delay="0.4 ms"), body(60, "0.03")),
    "another process": (DEVICE, body(10, "0.12", exchange_delay=2)),
    "through a line": (DEVICE, body(100, "0.05", exchange_delay=3, wave_impedance=1)),
}


@pytest.mark.parametrize("case", CASES)
def test_both_sides_of_every_end(case):
    """A certificate at it, energy out a millionth beyond; a grid agrees a thousandth off."""
    device, law = CASES[case]
    found = passive_masses(device, law)
    assert found.limits
    for limit in found.limits:
        assert limit.passive.outcome == "passive"
        assert limit.passive.certificate.verify()
        assert limit.beyond.outcome == "active"
        assert limit.beyond.violation.verify()
    if device.exact("delay") % T:
        return  # the grid knows whole samples
    for low, high in found.intervals:
        for end, outward in ((low, -1), (high, 1)):
            if 0 < end < inf:
                for part, expected in ((outward, False), (-outward, True)):
                    there = law.replace(virtual_mass=end * (1 + part * min(1e-3, (high - low) / end / 3)))
                    assert passive_on_a_grid(there, device) is expected


def test_both_kinds_of_window():
    """Two samples late there is a heaviest mass; by the trapezoidal rule masses in between fail."""
    late = masses(41, "0.0024", DEVICE.replace(delay="2 ms"))
    ((low, high),) = late.intervals
    assert (low, high) == (pytest.approx(1.351298e-5, rel=1e-6), pytest.approx(1.379386e-5, rel=1e-6))
    light, heavy = masses(200, "0.02", integrator="trapezoidal").intervals
    assert light == (0, pytest.approx(3.32887e-5, rel=1e-5))
    assert heavy == (pytest.approx(6.77575e-5, rel=1e-5), inf)


@seeds(12)
def test_random_bodies_against_a_grid(seed):
    """Inside an interval passive, outside active, for masses that are nowhere near an end."""
    draw = random.Random(seed)
    device = DEVICE.replace(delay=draw.choice([0, 0, 1, 2]) * T)
    damped = draw.random() < 0.5
    found = masses(
        round(draw.uniform(1, 300), 1),
        round(draw.uniform(0, 0.12), 4),
        device,
        integrator=draw.choice(INTEGRATORS),
        exchange_delay=draw.choice([0, 0, 1]),
        body_damping=draw.choice([0, "0.1"]) if damped else 0,
        body_stiffness=draw.choice([0, 70]) if damped else 0,
    )
    for exponent in np.arange(-6.05, 0, 0.7):
        mass = float(10**exponent)
        if any(abs(mass / end - 1) < 0.02 for pair in found.intervals for end in pair if 0 < end < inf):
            continue
        inside = any(low <= mass <= high for low, high in found.intervals)
        assert passive_on_a_grid(found.body.replace(virtual_mass=mass), device) is inside


@seeds(10)
def test_the_closed_form_of_semi_implicit_euler(seed):
    """M = (T/2) σ b/(b − σ), σ = K_c T/2 + B_c, where the quadratic of the proof has no root beyond it."""
    draw = random.Random(seed)
    kappa = Fraction(draw.randint(1, 190), 100) * B
    damper = Fraction(draw.randint(1, 99), 100) * B
    sigma = kappa / 2 + damper
    found = masses(kappa / T, damper)
    if sigma >= B or kappa**2 > 16 * B * damper:
        assert not found.intervals
        return
    closed = float(T / 2 * sigma * B / (B - sigma))
    middle = 2 * (2 * damper - kappa) - 4 * damper * (damper + kappa) / B
    if middle >= 0 or middle**2 <= 32 * kappa**2 * damper / B:
        assert found.smallest == pytest.approx(closed, rel=1e-12)
    assert found.smallest >= closed * (1 - 1e-12)
    assert len(found.intervals) == 1
    assert found.largest == inf


@pytest.mark.parametrize("integrator", EXPLICIT)
def test_a_spring_alone_before_an_explicit_integrator(integrator):
    for damping in ("0.15", 15):
        assert masses(20, 0, DEVICE.replace(damping=damping), integrator=integrator).intervals == ()


@pytest.mark.parametrize("integrator", IMPLICIT)
@pytest.mark.parametrize(
    "exchange", [{}, {"exchange_delay": 7, "wave_impedance": "0.4"}], ids=["at once", "waves"]
)
def test_an_implicit_body_behind_a_coupling_that_is_right(integrator, exchange):
    """Every mass, at the limit b = K_c T/2 + B_c too, and through a line; past it no heavy one."""
    numbers = {"integrator": integrator, "body_damping": "0.1", "body_stiffness": 30, **exchange}
    assert masses(200, "0.05", **numbers).intervals == ((0.0, inf),)
    beyond = masses(200, "0.050001", **numbers)
    assert not any(high == inf for _, high in beyond.intervals)


@pytest.mark.parametrize("delay", [0, 1, 3])
@pytest.mark.parametrize("exchange", [0, 1])
@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_what_heavy_bodies_ask_of_the_coupling(integrator, exchange, delay):
    """A thousandth more than the closed form will do from some mass on, one less for no heavy one."""
    device = DEVICE.replace(delay=delay * T)
    stiffness = Fraction(8)
    need = heavy_body_damping(device, stiffness, integrator, exchange).fraction
    at = {"integrator": integrator, "exchange_delay": exchange}
    assert masses(stiffness, need * Fraction(1001, 1000), device, **at).largest == inf
    if need:
        below = masses(stiffness, need * Fraction(999, 1000), device, **at)
        assert below.largest is None or below.largest < inf


def test_no_damping_of_the_device_makes_up_for_a_naive_exchange():
    """B_c > (φ + 2d) K_c T is asked for by stability alone; a device that damps much does not lower it."""
    firm = DEVICE.replace(damping=1000)
    need = heavy_body_damping(firm, 100, exchange_delay=1)
    assert float(need) == pytest.approx(2 * 100 * 1e-3, rel=1e-3)
    assert masses(100, "0.1999", firm, exchange_delay=1).intervals == ()


@pytest.mark.parametrize("case", ["semi-implicit", "another process"])
def test_a_motion_gains_in_the_program_itself(case):
    device, law = CASES[case]
    light = law.replace(virtual_mass=passive_masses(device, law).smallest * 0.9)
    positions = [Fraction(x) for x in zw.check(device, light).witness.positions]
    found = forces(light, T, positions)
    work = sum(
        f * (b - a) + B / T * (b - a) ** 2 for f, a, b in zip(found, positions, positions[1:], strict=False)
    )
    assert work < 0


@pytest.mark.parametrize(
    ("lag", "integrator", "exchange"), [(1, "forward-euler", 0), (4, "velocity-verlet", 2)]
)
def test_the_stiffest_coupling_before_heavy_bodies(lag, integrator, exchange):
    """K_c T/b = (2/ψ²) [√((1 + ψ)² + ψ²) − (1 + ψ)], ψ = φ − ½: there the device just pays for both needs."""
    psi = lag - 0.5
    limit = 2 / psi**2 * (np.hypot(1 + psi, psi) - 1 - psi) * float(B / T)
    for part, pays in ((0.999, True), (1.001, False)):
        stiffness = Fraction(part * limit)
        left = B - stiffness * T / 2
        need = heavy_body_damping(DEVICE, stiffness, integrator, exchange).fraction
        assert (need < left) is pays
        if pays:
            between = float((need + left) / 2)
            found = masses(float(stiffness), between, integrator=integrator, exchange_delay=exchange)
            assert found.largest == inf


def test_the_limit_of_the_mass_is_the_lightest():
    bracket = zw.limit(DEVICE, body(150, "0.0375"), "virtual_mass", tolerance=1e-3)
    assert bracket.proved_active < 2.25e-4 <= bracket.proved_passive < 2.26e-4


def test_it_is_saved_and_verified():
    """The document holds a verdict for its own mass and for both sides of each end."""
    found = masses(200, "0.02", integrator="trapezoidal")
    document = found.to_dict()
    assert document["intervals_virtual_mass_kg"][1][1] is None
    outcomes = [one["outcome"] for one in document["verdicts"]]
    assert outcomes == ["passive", "passive", "active", "passive", "active"]
    parts = judge(document).parts
    assert all(part.verification.valid for part in parts)
    assert len(parts) >= 5
    document["verdicts"][1]["outcome"] = "active"
    assert not all(part.verification.valid for part in judge(document).parts)


def test_it_says_its_masses():
    assert masses(200, 0).describe().startswith("passive for no mass: virtual coupling")
    assert masses(200, 0, integrator="backward-euler").describe().startswith("passive for every mass")
    two = masses(200, "0.02", integrator="trapezoidal")
    assert two.describe().startswith("passive up to 33.2887 mg and from 67.7575 mg on")
    assert "a millionth beyond" in "".join(str(part) for part in two.report())


def test_the_encoder_is_left_out_and_said_to_be():
    stepped = masses(100, "0.05", zw.catalogue.device("haptic-paddle"))
    assert stepped.intervals == masses(100, "0.05").intervals
    assert any("encoder steps are left out" in line for line in stepped.assumptions)
    assert not any("left out" in line for line in masses(100, "0.05").assumptions)
    assert any("certificates are of the ends" in line for line in stepped.assumptions)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: passive_masses(DEVICE, zw.Wall(3)), "takes a Device and a CoupledBody, got Device and Wall"),
        (lambda: heavy_body_damping(DEVICE.replace(damping=0), 3), "a device with damping"),
        (lambda: heavy_body_damping(DEVICE.replace(delay="0.5 ms"), 3), "got 0.15 and 0.5 samples"),
        (lambda: masses(1, "0.12", exchange_delay=40), "would take minutes to find: give a shorter delay"),
        (lambda: heavy_body_damping(DEVICE, 3, "euler"), "integrator is one of"),
    ],
)
def test_what_has_no_answer_is_refused(call, message):
    with pytest.raises(zw.InputError, match=message):
        call()
