"""The spring that slips: its law, its loop, what it pays for."""

import numpy as np
import pytest
from prescribed import DEVICE, PERIOD, commands, touched, wandering

import zwidth as zw
from zwidth.model.rendering import Hysteresis, Saturation

IDEAL = DEVICE.replace(resolution=0)


def slipping(readings, width, stiffness):
    """s of each sample, relaxed at the surface."""
    s, before, result = 0.0, max(readings[0], 0.0), []
    for x in readings:
        u = max(x, 0.0)
        s = float(np.clip(s + stiffness * (u - before), -width, width)) if x > 0 else 0.0
        before = u
        result.append(s)
    return np.array(result)


@pytest.mark.parametrize("clamped", [False, True])
def test_the_commands_are_those_of_the_law(clamped):
    read, force = commands(wandering(), Hysteresis("0.31", 870, clamped=clamped), environment=zw.Wall(400))
    slip = slipping(read, 0.31, 870)
    expected = np.where(read > 0, 400 * read + slip, 0)
    assert expected.min() < -0.01
    assert np.abs(slip).max() == 0.31
    assert force == pytest.approx(np.maximum(expected, 0) if clamped else expected, abs=1e-12)


def test_without_a_surface_it_acts_everywhere():
    x = wandering()
    read, force = commands(x, Hysteresis("0.2", 500), environment=zw.PulseTransferFunction([70], [1]))
    s, expected = 0.0, []
    for now, before in zip(read, np.append(read[:1], read), strict=False):
        s = float(np.clip(s + 500 * (now - before), -0.2, 0.2))
        expected.append(70 * now + s)
    assert force == pytest.approx(np.array(expected), abs=1e-12)


@pytest.mark.parametrize("speed", [0.02, 0.1])
def test_the_force_depends_on_the_way_and_not_on_the_speed(speed):
    x = np.concatenate((np.arange(1, 101), np.arange(99, 0, -1))) * 1e-4
    slow = np.repeat(x, round(0.1 / speed))
    _, quick_force = commands(x, Hysteresis("0.3", 900), device=IDEAL)
    _, slow_force = commands(slow, Hysteresis("0.3", 900), device=IDEAL)
    assert np.unique(np.round(slow_force, 9)) == pytest.approx(np.unique(np.round(quick_force, 9)))


def work_out(stiffness, speed, depth, *stages):
    """Energy that a hand puts in on the way to a depth and back, behind a hold, friction aside [J]."""
    x = np.arange(0, depth, speed * PERIOD)
    way = np.concatenate((x, x[::-1]))
    trace = touched(way, *stages, environment=zw.Wall(stiffness), device=IDEAL)
    return float(-trace.actuator_work[-1])


def test_the_width_pays_for_the_hold_up_to_its_speed():
    """½ K v T D leaks each way; h D each way is paid: a gain above v_max, a loss below."""
    k, fastest, depth = 2000, 0.1, 0.01
    law = Hysteresis(fastest=fastest)
    leak = work_out(k, fastest, depth, Saturation(1e6))
    assert leak == pytest.approx(-k * fastest * PERIOD * depth, rel=0.03)
    assert abs(work_out(k, fastest, depth, law)) < 0.05 * abs(leak)
    assert work_out(k, fastest / 2, depth, law) > 0.4 * abs(leak)
    assert work_out(k, fastest * 2, depth, law) < -0.8 * abs(leak)
    explicit = Hysteresis(k * fastest * PERIOD / 2, k)
    assert work_out(k, 0.07, depth, law) == pytest.approx(work_out(k, 0.07, depth, explicit), rel=1e-9)


def test_a_hand_to_and_fro_finds_the_same_forces_to_the_bit():
    x = np.tile([0.00031, 0.00037, 0.00034, 0.00029], 1000)
    _, force = commands(x, Hysteresis("0.31", 870), device=IDEAL)
    rounds = np.reshape(force[4:], (-1, 4))
    assert (rounds == rounds[0]).all()
    assert len(set(rounds[0])) == 4
