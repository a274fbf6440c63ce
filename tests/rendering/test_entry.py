"""What happens once, when the hand enters: braking pulses and transients."""

import numpy as np
import pytest
from prescribed import DEVICE, PERIOD, commands, wandering

import zwidth as zw
from zwidth.model.rendering import AdaptiveWindow, BrakingPulse, EventTransient

ONE = AdaptiveWindow(longest=1)
FREE = zw.Device(mass=0.07, damping=0, sample_period=PERIOD)
NO_HAND = zw.operators.ConstantForce(0.0)


def entries(read):
    """The samples at which the hand is inside for the first time, and the speeds there."""
    speed = np.diff(read, prepend=read[0]) / PERIOD
    inside = read > 0
    at = np.flatnonzero(inside & ~np.append(inside[:1], inside[:-1]))
    return at, speed[at], inside


def transients(read, table):
    """g_n v after each entry while the hand is inside."""
    force = np.zeros(len(read))
    at, speeds, inside = entries(read)
    for k, v in zip(at, speeds, strict=True):
        for n, g in enumerate(table):
            if k + n >= len(read) or not inside[k + n]:
                break
            force[k + n] += g * v
    return force


def test_a_braking_pulse_is_one_sample_of_force():
    """m v/T at most F, at entry only."""
    read, force = commands(wandering(900), BrakingPulse(0.11, "2.6", ONE))
    at, speeds, _ = entries(read)
    expected = np.zeros(len(read))
    expected[at] = np.minimum(0.11 * speeds / PERIOD, 2.6)
    assert force == pytest.approx(expected, abs=1e-9)
    assert len(at) > 2
    assert {2.6} < set(np.round(expected[at], 9))


def test_the_device_says_mass_and_limit():
    x = np.array([-2e-3, -1e-3, 1e-3, 3e-3])
    assert commands(x, BrakingPulse(velocity=ONE))[1] == pytest.approx([0, 0, 9, 0])
    free = DEVICE.replace(force_limit=None)
    assert commands(x, BrakingPulse(velocity=ONE), device=free)[1] == pytest.approx([0, 0, 140, 0])


TABLES = {
    "fixed": (EventTransient("fixed", amplitude=21, duration="0.004", velocity=ONE), [21.0] * 4),
    "decaying": (
        EventTransient(amplitude=30, frequency=180, time_constant="0.003", duration="0.009", velocity=ONE),
        [30 * np.exp(-n / 3) * np.sin(2 * np.pi * 0.18 * n) for n in range(9)],
    ),
    "record": (
        EventTransient("acceleration", record=[10, "70.5", -20], mass="0.3", velocity=ONE),
        [3, 21.15, -6],
    ),
    "half sine": (
        EventTransient("acceleration", duration="0.005", velocity=ONE),
        [70 * (np.cos(np.pi * n / 5) - np.cos(np.pi * (n + 1) / 5)) / 2 for n in range(5)],
    ),
}


@pytest.mark.parametrize("law", TABLES)
def test_the_transients_are_those_of_the_law(law):
    stage, table = TABLES[law]
    read, force = commands(wandering(900), stage, environment=zw.Wall(150))
    expected = transients(read, table)
    assert len(entries(read)[0]) > 2
    assert np.abs(expected).max() > 0.2
    assert force == pytest.approx(np.where(read > 0, 150 * read, 0) + expected, abs=1e-9)


def test_armed_again_only_outside():
    """Once per contact, also when the speed changes inside; not for a hand that begins inside."""
    tap = EventTransient("fixed", amplitude=10, duration="0.002", velocity=ONE)
    x = np.array([1, 3, 5, -2, -1, 1, 2, 3, 5, 8, 9, 0.9, -1, 2, -1]) * 1e-3
    _, force = commands(x, tap)
    assert np.flatnonzero(force).tolist() == [5, 6, 13]
    assert force[[5, 6, 13]] == pytest.approx([20, 20, 30])


@pytest.mark.parametrize(
    ("stage", "left"),
    [
        (BrakingPulse(), 0),
        (BrakingPulse(limit=3), 0.13 - 3 * PERIOD / 0.07),
        (EventTransient("fixed"), 0),
        (EventTransient("fixed", duration="0.003"), 0),
        (EventTransient("decaying"), 0),
        (EventTransient("decaying", frequency=230, time_constant="0.02"), 0),
        (EventTransient("acceleration"), 0),
        (EventTransient("acceleration", duration="0.0234"), 0),
    ],
)
def test_by_default_they_take_the_momentum(stage, left):
    """A free mass that enters a wall of nothing is at rest when it is over; a pulse takes F T at most."""
    law, start = zw.render(zw.Wall(0), stage), {"initial_position": -0.0042, "initial_velocity": 0.13}
    trace = zw.simulate(FREE, law, NO_HAND, 0.3, **start)
    outside = trace.position.values <= 0
    assert outside.tolist() == sorted(outside, reverse=True)
    assert trace.velocity.values[outside] == pytest.approx(0.13)
    assert float(trace.velocity[-1]) == pytest.approx(left, abs=1e-12)
    if isinstance(stage, BrakingPulse):
        assert trace.velocity.values[np.argmin(outside) + 1 :] == pytest.approx(left, abs=1e-12)
