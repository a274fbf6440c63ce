"""The simulator with a Hunt–Crossley contact: commands, collisions, ledger, batches."""

from __future__ import annotations

from math import log1p

import numpy as np
import pytest
from scipy.optimize import brentq

import zwidth as zw

PADDLE = zw.catalogue.device("haptic-paddle")
IDEAL = zw.amplifiers.Ideal()


@pytest.mark.parametrize("clamped", [True, False])
@pytest.mark.parametrize("exponent", [1, 1.5, 2, 3.7])
@pytest.mark.parametrize("resolution", [0.0, 1e-4])
def test_the_commands_are_those_of_the_law(exponent: float, clamped: bool, resolution: float) -> None:
    """K uⁿ (1 + λ v), v from the readings before, on both sides of the surface."""
    period, x = 0.002, 0.002 + 0.006 * np.sin(np.arange(400) * 0.37)
    contact = zw.HuntCrossley(5e3, exponent, 1.7, clamped)
    loop = zw.Device(damping=0.1, sample_period=period, resolution=resolution)
    motion = zw.operators.PrescribedMotion(x)
    trace = zw.simulate(loop, contact, motion, period * (len(x) - 1), amplifier=IDEAL)
    read = trace.measured_position.values
    speed = np.diff(read, prepend=read[0]) / period
    expected = 5e3 * np.maximum(read, 0.0) ** exponent * (1 + 1.7 * speed)
    expected = np.maximum(expected, 0.0) if clamped else expected
    assert trace.commanded_force.values == pytest.approx(expected, rel=1e-12, abs=1e-15)
    assert bool((expected < 0).any()) is not clamped
    exact = [float(contact.force(q, v)) for q, v in zip(read[:20].tolist(), speed[:20].tolist(), strict=True)]
    assert exact == pytest.approx(expected[:20].tolist(), rel=1e-12, abs=1e-15)


def parting_speed(dissipation: float, speed: float) -> float:
    """v_o of a body that meets the contact at v_i, whatever its mass, K and n.

    m v dv/dx = −K uⁿ (1 + λ v) gives ∫ v/(1 + λ v) dv the same over both halves of the collision:
    v_i/λ − ln(1 + λ v_i)/λ² = −v_o/λ − ln(1 − λ v_o)/λ²  (Hunt & Crossley 1975).
    """

    def half(v: float) -> float:
        return v / dissipation - log1p(dissipation * v) / dissipation**2

    limit = min(speed, 1 / dissipation) * (1 - 1e-12)
    return brentq(lambda v: half(-v) - half(speed), 0.0, limit)


@pytest.mark.parametrize("exponent", [1, 1.5, 3])
@pytest.mark.parametrize(("dissipation", "speed"), [(0.3, 0.2), (2.0, 0.2), (2.0, 1.5)])
def test_a_body_bounces_as_hunt_and_crossley_say(exponent: float, dissipation: float, speed: float) -> None:
    """Free of friction and hands, sampled finely; for slow ones v_o ≈ (1 − ⅔ λ v_i) v_i."""
    loop = zw.Device(mass=0.05, damping=0, sample_period=1e-6)
    stiffness = 0.05 * speed**2 / 0.002 ** (exponent + 1)
    contact = zw.HuntCrossley(stiffness, exponent, dissipation)
    free = zw.operators.ConstantForce(0.0)
    trace = zw.simulate(loop, contact, free, 0.012 / speed, initial_velocity=speed, initial_position=-1e-4)
    expected = parting_speed(dissipation, speed)
    assert float(trace.velocity[-1]) == pytest.approx(-expected, rel=2e-3)
    assert float(trace.position[-1]) < 0
    if dissipation * speed < 0.1:
        assert expected == pytest.approx((1 - 2 / 3 * dissipation * speed) * speed, rel=5e-3)


def test_exponent_one_without_dissipation_is_a_spring_wall() -> None:
    """The same motion, to rounding."""
    hand = zw.operators.Dowel()
    one, other = (zw.simulate(PADDLE, law, hand, 0.2) for law in (zw.HuntCrossley(300, 1), zw.Wall(300)))
    assert one.position.values == pytest.approx(other.position.values, abs=1e-12)


@pytest.mark.parametrize("hand", [zw.operators.Finger(), zw.operators.ConstantForce(1.0)])
def test_the_ledger_closes(hand) -> None:
    """Every joule is accounted for, with a delay and in between samples."""
    contact = zw.HuntCrossley(2e4, "1.5", 3)
    loop = PADDLE.replace(delay=4e-4)
    trace = zw.simulate(loop, contact, hand, 0.4, initial_position=-2e-3, points_per_sample=3)
    assert trace.zwidth.energy.closes
    assert trace.attrs["environment"] == contact.describe()


def test_a_touch_that_begins_inside_begins_at_rest() -> None:
    """v = 0 at the first sample: the contact has been where the hand is."""
    contact = zw.HuntCrossley(2e4, 2, 3)
    trace = zw.simulate(PADDLE, contact, zw.operators.ConstantForce(0.1), 0.01, initial_position=0.004)
    read = float(trace.measured_position[0])
    assert float(trace.commanded_force[0]) == pytest.approx(2e4 * read**2, abs=0.0005)


def test_a_missed_sample_leaves_the_contact_as_it_was() -> None:
    """The sample after it sees the way of two periods over one."""
    x = np.array([0.0, 1e-3, 3e-3, 4e-3, 4e-3])
    loop = zw.Device(damping=0.1, sample_period=0.001)
    timing = zw.simulation.Timing(missed=[0, 0, 1, 0, 0])
    contact = zw.HuntCrossley(100, 1, 2)
    motion = zw.operators.PrescribedMotion(x)
    trace = zw.simulate(loop, contact, motion, 0.004, timing=timing)
    assert trace.commanded_force.values[3] == pytest.approx(100 * 4e-3 * (1 + 2 * 3.0))


def test_a_batch_has_the_bits_of_single_loops() -> None:
    """Over stiffness, exponent and dissipation."""
    hand, vary = zw.operators.Dowel(), {"stiffness": [1e3, 3e4], "exponent": [1, 1.5], "dissipation": [0, 2]}
    contact = zw.HuntCrossley(1)
    batch = zw.simulation.simulate_batch(PADDLE, contact, hand, 0.1, vary=vary, workers=2)
    for k in vary["stiffness"]:
        for n in vary["exponent"]:
            for d in vary["dissipation"]:
                alone = zw.simulate(PADDLE, zw.HuntCrossley(k, n, d), hand, 0.1)
                found = batch.position.sel(stiffness=k, exponent=n, dissipation=d)
                assert float(found) == float(alone.position[-1])
