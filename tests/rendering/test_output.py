"""The last laws before the converter, slew limit, dither, saturation; and the spring that slips."""

import numpy as np
import pytest
from prescribed import DEVICE, PERIOD, commands, touched, wandering

import zwidth as zw
from zwidth.model.rendering import Dither, Hysteresis, Saturation, SlewLimit

WALL = zw.Wall(3000)
IDEAL = DEVICE.replace(resolution=0)


def wall_force(read):
    return np.where(read > 0, 3000 * read, 0)


def slewed(force, most):
    """Each value at most so far from the one before."""
    result = [force[0]]
    for f in force[1:]:
        result.append(min(max(f, result[-1] - most), result[-1] + most))
    return np.array(result)


@pytest.mark.parametrize("begin", [-1e-3, 2e-3])
def test_the_force_changes_by_a_step_at_most(begin):
    x = begin + wandering() - wandering()[0]
    read, force = commands(x, SlewLimit(130), environment=WALL)
    expected = slewed(wall_force(read), 0.13)
    assert force == pytest.approx(expected, abs=1e-12)
    assert np.abs(np.diff(force)).max() == pytest.approx(0.13)
    assert (np.abs(force - wall_force(read)) > 0.05).any()


def test_the_motor_says_how_fast():
    """(F_max/I_max) U/L = 9/3 · 24/0.001 N/s, 72 N a sample."""
    x = np.array([-1e-3, 0.05, 0.05, 0.05])
    assert commands(x, SlewLimit(), environment=WALL)[1] == pytest.approx([0, 72, 144, 150], abs=0.1)


def test_saturation_goes_before_what_remembers():
    x = np.array([-1e-3, *[0.02] * 9, *[1e-3] * 9])
    alone, behind = (
        touched(x, *stages, environment=WALL, amplifier=None).actuator_force.values
        for stages in ((SlewLimit(9000),), (Saturation(), SlewLimit(9000)))
    )
    assert behind[10] == 3
    assert alone[10] == 9
    assert alone.max() == behind.max() == 9


def test_saturation():
    both = zw.PulseTransferFunction([9000], [1])
    for stage, limit in ((Saturation(), 9), (Saturation("0.7"), 0.7)):
        read, force = commands(wandering(), stage, environment=both)
        assert force == pytest.approx(np.clip(9000 * read, -limit, limit))
        assert np.abs(force).max() == limit
        assert force.min() < 0


def numbers(seed, count):
    """Park & Miller's, in whole numbers."""
    result = []
    for _ in range(count):
        seed = seed * 16807 % (2**31 - 1)
        result.append(seed)
    return np.array(result)


def test_the_generator_is_the_published_one():
    """From 1, the 10 000th number is 1043618065 (Park & Miller 1988)."""
    assert numbers(1, 10000)[-1] == 1043618065


def test_dither_is_the_documented_sequence():
    x = wandering()
    read, force = commands(x, Dither("0.4"), environment=WALL)
    signs = np.where(np.arange(len(x)) % 2, -1, 1)
    assert force == pytest.approx(np.where(read > 0, wall_force(read) + 0.4 * signs, 0))
    read, force = commands(x, Dither("0.4", "random", 77), environment=WALL)
    random = 2 * numbers(77, len(x)) / (2**31 - 1) - 1
    assert force == pytest.approx(np.where(read > 0, wall_force(read) + 0.4 * random, 0), abs=1e-12)
    both = zw.PulseTransferFunction([0], [1])
    assert commands(x, Dither("0.4"), environment=both)[1] == pytest.approx(0.4 * signs)


def test_dither_averages_the_steps_of_the_converter_out():
    """Steps of 0.02 N: the mean is wrong by half of one without, a quarter alternating, nothing random."""
    wrong = {"none": 0.0, "alternating": 0.0, "random": 0.0}
    stages = {"none": Saturation(), "alternating": Dither(), "random": Dither(kind="random")}
    for force in 1 + 0.02 * np.linspace(0, 1, 21):
        for name, stage in stages.items():
            trace = touched(
                np.full(4001, force / 3000), stage, environment=WALL, device=IDEAL, amplifier=None
            )
            mean = float(trace.commanded_force[:4000].mean())
            wrong[name] = max(wrong[name], abs(mean - force))
    assert wrong["none"] == pytest.approx(0.01, rel=1e-6)
    assert wrong["alternating"] == pytest.approx(0.005, rel=1e-6)
    assert wrong["random"] < 5e-4


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
def test_the_spring_that_slips_commands_its_law(clamped):
    read, force = commands(wandering(), Hysteresis("0.31", 870, clamped=clamped), environment=zw.Wall(400))
    slip = slipping(read, 0.31, 870)
    expected = np.where(read > 0, 400 * read + slip, 0)
    assert expected.min() < -0.01
    assert np.abs(slip).max() == 0.31
    assert force == pytest.approx(np.maximum(expected, 0) if clamped else expected, abs=1e-12)


def test_without_a_surface_the_spring_acts_everywhere():
    x = wandering()
    read, force = commands(x, Hysteresis("0.2", 500), environment=zw.PulseTransferFunction([70], [1]))
    s, expected = 0.0, []
    for now, before in zip(read, np.append(read[:1], read), strict=False):
        s = float(np.clip(s + 500 * (now - before), -0.2, 0.2))
        expected.append(70 * now + s)
    assert force == pytest.approx(np.array(expected), abs=1e-12)


def work_out(stiffness, speed, depth, *stages):
    """Energy that a hand puts in on the way to a depth and back, behind a hold, friction aside [J]."""
    x = np.arange(0, depth, speed * PERIOD)
    way = np.concatenate((x, x[::-1]))
    trace = touched(way, *stages, environment=zw.Wall(stiffness), device=IDEAL)
    return float(-trace.actuator_work[-1])


def test_the_width_of_the_spring_pays_for_the_hold_up_to_its_speed():
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
