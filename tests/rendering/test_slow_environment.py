"""Environments updated every N samples, held or with a local spring in between."""

from fractions import Fraction

import numpy as np
import pytest
from prescribed import T, device, energy_in, follow, tempt, wall

import zwidth as zw
from zwidth.model.rendering import DualRate, EnergyBounding, ForceBounding, Held


def local(wish, samples, slope, jumps=False):
    """A local spring given by where it begins; its potential and what is left of it by name."""
    last = {"k": 0, "begin": None, "spare": 0.0}

    def law(x):
        here = 0.0 if last["begin"] is None else max(slope * (x - last["begin"]), 0.0)
        if last["k"] % samples == 0:
            potential = here**2 / (2 * slope) + last["spare"]
            new = wish(x) if jumps else min(wish(x), np.sqrt(2 * slope * potential))
            last["spare"] = max(potential - new**2 / (2 * slope), 0.0)
            last["begin"] = x - new / slope if wish(x) > 0 else None
            here = new
        last["k"] += 1
        return here

    return law


def test_held_forces_are_those_of_a_plain_loop():
    """Every 15th force of the wall."""
    positions, _ = tempt(wall(400), device(), 400, 1)
    trace = follow(device(), zw.render(zw.Wall(400), Held(samples=15)), positions)
    expected = 400 * np.maximum(positions, 0)[np.arange(positions.size) // 15 * 15]
    assert trace.commanded_force.to_numpy() == pytest.approx(expected, rel=1e-15)


@pytest.mark.parametrize("samples", [1, 4, 15])
def test_a_held_spring_is_one_in_a_slower_loop(samples):
    """In and out, N samples each: passive up to K = 2b/(N T), not beyond."""
    inside = np.repeat([0, 1] * 10, samples) * 1e-3
    positions = np.interp(np.arange(inside.size), np.arange(0, inside.size, samples), inside[::samples])
    positions = positions[: 18 * samples + 1]
    limit = Fraction(3, 10) / (samples * T)
    for share, sign in ((Fraction(999, 1000), 1), (Fraction(1001, 1000), -1)):
        loop = zw.render(zw.Wall(limit * share), Held(samples=samples))
        assert np.sign(energy_in(follow(device(), loop, positions))[-1]) == sign


@pytest.mark.parametrize("samples", [1, 2, 15, 60])
@pytest.mark.parametrize("stiffness", [290, 5000])
def test_no_hand_takes_energy_out_of_local_springs(stiffness, samples):
    """The energy is never below 0, and every force is that of a plain loop."""
    loop = zw.render(zw.Wall(stiffness), DualRate(samples=samples))
    for seed in range(6):
        law = local(wall(stiffness), samples, min(stiffness, 300))
        positions, forces = tempt(law, device(), 600, seed)
        trace = follow(device(), loop, positions)
        assert trace.commanded_force.to_numpy() == pytest.approx(forces, rel=1e-6, abs=1e-7)
        assert energy_in(trace).min() >= -1e-12 * energy_in(trace).max()


def test_nor_where_the_environment_pulls():
    """A filter without a surface: the local springs may pull, and promise the same; so at the force limit."""
    tissue = zw.PulseTransferFunction([900, -700], [1, "-0.8"])
    loop = zw.render(tissue, DualRate(samples=5))
    for seed in range(20):
        paddle = device(force_limit=None if seed < 10 else "0.05")
        positions, _ = tempt(wall(500), paddle, 400, seed % 10)
        trace = follow(paddle, loop, positions)
        assert trace.commanded_force.to_numpy().min() < 0
        assert energy_in(trace).min() >= -1e-12 * energy_in(trace).max()


def test_what_the_amplifier_does_not_give_is_not_counted_as_paid():
    """Pressed far beyond the force limit, then to and fro at a small step, which that would pay for."""
    forces = zw.NonlinearSpring([0, "1e-4", "1e-2", "1.01e-2", "1.2e-2", "1.21e-2"], [0, 10, 10, 0, 0, "0.1"])
    press = np.linspace(0, 1e-2, 1001)
    cycle = [*np.linspace(1.2e-2, 1.21e-2, 6)[:-1], *np.linspace(1.21e-2, 1.2e-2, 6)[:-1]]
    positions = np.array([*press[:-1], *np.linspace(1e-2, 1.2e-2, 11)[:-1], *(cycle * 1500)])
    paddle = device(force_limit="0.05")
    energy = energy_in(follow(paddle, zw.render(forces, DualRate(samples=5)), positions))
    assert energy.min() >= 0


def test_the_force_rises_without_a_jump_and_the_wall_begins_where_it_was_first_seen():
    """One spring of slope 2b/T from the reading of the first update inside."""
    positions = np.concatenate([np.linspace(-1e-3, 2e-3, 100), np.linspace(2e-3, -1e-3, 60)])
    force = follow(device(), zw.render(zw.Wall(5000), DualRate(samples=15)), positions).commanded_force
    seen = positions[45]
    assert positions[30] < 0 < seen
    assert force.to_numpy()[:150] == pytest.approx(np.maximum(300 * (positions - seen), 0)[:150], abs=1e-9)


def test_jumps_at_updates_are_not_passive():
    """In while the update has not seen it, out against the local spring: ½ K x² each time."""
    cycle = np.concatenate([np.linspace(0, 1, 16)[:-1], np.linspace(1, 0, 16)[:-1]]) * 1e-3
    positions = np.tile(cycle, 20)
    jump, continuous = (
        energy_in(follow(device(), zw.render(zw.Wall(300), DualRate(samples=15, updates=word)), positions))
        for word in ("jump", "continuous")
    )
    lost = 2 * 150 * 1e-6 / 15
    each = lost - (150e-6 * (1 + 1 / 15))
    assert jump[-1] == pytest.approx(20 * each, rel=0.05)
    assert continuous.min() >= 0


@pytest.mark.parametrize(("share", "sign"), [("299.9", 1), ("300.1", -1)])
def test_slopes_beyond_the_device_are_not_passive(share, sign):
    positions = np.array([1e-4, *([1e-4, 1e-3] * 50), 1e-4])
    loop = zw.render(zw.Wall(5000), DualRate(samples=1000, slope=share))
    assert np.sign(energy_in(follow(device(), loop, positions))[-1]) == sign


def test_a_wall_at_66_7_hz_that_bounces_for_ever_is_passive_behind_a_law():
    """30 kN/m updated every 15 samples, pushed with 10 N: 200 N and many joules without a law."""
    heavy = zw.Device(
        mass="0.5", damping="0.5", coulomb_friction="0.5", sample_period=T, force_limit=200, resolution=0
    )
    slow, hand = zw.render(zw.Wall(30_000), Held(samples=15)), zw.operators.ConstantForce(10)

    def touch(loop):
        trace = zw.simulate(heavy, loop, hand, 2, initial_position=-0.02, initial_velocity=0.2)
        return trace, energy_in(trace).min()

    trace, least = touch(slow)
    assert least < -10
    assert trace.actuator_force.max() == 200
    for law, quiet in ((EnergyBounding(), True), (ForceBounding(), False)):
        trace, least = touch(zw.render(slow, law))
        assert least >= -1e-12
        assert (float(np.ptp(trace.position.to_numpy()[-500:])) < 1e-3) is quiet
    assert touch(zw.render(zw.Wall(30_000), DualRate(samples=15)))[1] >= -1e-12
