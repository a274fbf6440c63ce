"""When waves without a ledger are passive, from both sides of the limit; and what waves feel like."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

import zwidth as zw
from zwidth.links import HeldWaves, NaiveWaves, Schedule, WavePort, felt_mass, felt_stiffness

DAMPING = Fraction(3, 20)


def arm(**more: object) -> zw.Device:
    return zw.Device(**{"mass": 0.05, "damping": DAMPING, "rate": 1000, "delay": 0, **more})


@pytest.mark.parametrize("friction", [0, "0.12"])
@pytest.mark.parametrize("delay", [0, "5 ms"])
def test_waves_are_passive_up_to_the_damping_of_the_device(delay: object, friction: object) -> None:
    """w ≤ b is a theorem; a thousandth more, and a motion takes energy out, whatever friction there is."""
    device = arm(coulomb_friction=friction)
    link = Schedule(delay=delay)
    at = zw.links.check(HeldWaves(device, impedance=DAMPING), link)
    beyond = zw.links.check(HeldWaves(device, impedance=DAMPING * Fraction(1001, 1000)), link)
    assert (at.outcome, beyond.outcome) == ("theorem", "active")
    assert beyond.witness.exact_energy > 0


@pytest.mark.parametrize("damping", ["0.1", "0.3", "0.7", "1e-3"])
def test_the_limit_is_that_of_the_decimal_that_was_typed(damping: str) -> None:
    """w = b, whichever way its double is rounded."""
    device = arm(damping=damping)
    assert zw.links.check(HeldWaves(device, impedance=damping)).outcome == "theorem"
    assert zw.links.check(WavePort(device)).outcome == "passive"


@pytest.mark.parametrize("friction", [0, "0.12", "0.5"])
def test_an_encoder_makes_waves_without_a_ledger_active(friction: object) -> None:
    device = arm(coulomb_friction=friction, resolution="22.4 um")
    assert zw.links.check(HeldWaves(device)).outcome == "active"
    assert zw.links.check(WavePort(device)).outcome == "passive"


@pytest.mark.parametrize("late", [0, 2, 10])
def test_waves_of_the_textbook_diverge_in_samples(late: int) -> None:
    device = arm(mass="0.1 kg", coulomb_friction=0, resolution=0)
    push = zw.operators.RecordedForce(np.r_[np.full(50, 0.1), np.zeros(1950)])
    link = Schedule(delay=Fraction(late, 1000))
    naive, kept = (port(device, impedance=5) for port in (NaiveWaves, WavePort))
    wild, calm = (zw.links.simulate(port, port, link, push, None, 2) for port in (naive, kept))
    assert np.abs(wild["velocity"].values).max() > 10
    assert np.abs(calm["velocity"].values).max() < 0.1


@pytest.mark.parametrize(("late", "smoothed"), [(0, 0), (4, 0), (20, 0), (20, 5)])
def test_a_clamped_follower_feels_as_w_over_tau(late: int, smoothed: int) -> None:
    """Force over depth of the leader at rest; what smooths the force is so much more delay."""
    device = arm(coulomb_friction="0.001")
    port = WavePort(device, smoothing=Fraction(smoothed, 1000))
    push = zw.operators.RecordedForce(0.05 * np.minimum(np.arange(4000) / 1000, 1.0))
    clamp = zw.operators.PrescribedMotion(lambda t: 0.0)
    trace = zw.links.simulate(port, port, Schedule(delay=Fraction(late, 1000)), push, clamp, 4)
    felt = trace.zwidth.felt_stiffness
    assert felt == pytest.approx(float(felt_stiffness(DAMPING, late + smoothed, Fraction(1, 1000))), rel=2e-3)


def test_a_free_follower_adds_its_mass_and_w_tau() -> None:
    """A constant push, w = b: no damping is felt, and the three masses share the force."""
    device = arm(coulomb_friction=0)
    port, late, push = WavePort(device), 20, 0.1
    trace = zw.links.simulate(port, port, Schedule(delay="20 ms"), zw.operators.ConstantForce(push), None, 2)
    speed = trace["velocity"].values.mean(axis=0)
    found = push / ((speed[-1] - speed[-1001]) / 1.0)
    mass = 2 * 0.05 + float(felt_mass(DAMPING, late, Fraction(1, 1000)))
    assert found == pytest.approx(mass, rel=0.02)


def test_arms_do_not_drift_apart_when_half_is_lost() -> None:
    device = arm(coulomb_friction="5 mN")
    stroke = lambda t: 0.02 * np.sin(np.pi * min(t, 1.0)) ** 2 + 0.01 * min(t, 1.0)  # noqa: E731
    link = Schedule(delay="2 ms", jitter="5 ms", loss=0.5, burst=4)
    apart = []
    for port in (WavePort(device), HeldWaves(device)):
        trace = zw.links.simulate(port, port, link, zw.operators.PrescribedMotion(stroke), None, 3)
        apart.append(abs(np.diff(trace["position"].values[:, -500:], axis=0)).mean())
    assert apart[0] < 1e-4
    assert apart[1] > 5e-3


def test_smoothing_takes_the_chatter_of_jitter() -> None:
    device = arm(coulomb_friction="0.05", resolution="22.4 um")
    link = Schedule(delay="20 ms", jitter="10 ms", loss=0.5, burst=4)
    path = zw.operators.PrescribedMotion(lambda t: 0.02 * np.sin(np.pi * min(t, 1.0)) ** 2)
    steps = []
    for smoothing in (0, "2 ms"):
        port = WavePort(device, smoothing=smoothing)
        trace = zw.links.simulate(port, port, link, path, None, 1.5)
        steps.append(float(np.diff(trace["actuator_force"].values[1]).std()))
    assert steps[1] < 0.5 * steps[0]
