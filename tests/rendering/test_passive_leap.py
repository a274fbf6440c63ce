"""The passive leap: sample by sample, what it may owe, and the leap that makes it owe just that."""

from __future__ import annotations

import numpy as np
import pytest
from tempting import FORCE, LENGTH, device, energy_in, follow, same_in_other_units, tempt, wall

import zwidth as zw
from zwidth.model.rendering import PassiveLeap


def leapt(wish, stiffness, friction=0.0, resets=False):
    """The state of the spring instead of its energy: f = K y where E = ½ K y²."""
    last = {"x": None, "f": 0.0, "E": 0.0}

    def law(x):
        moved = 0.0 if last["x"] is None else x - last["x"]
        energy = min(last["E"], 0.0) if resets and last["f"] == 0 else last["E"]
        energy += last["f"] * moved + 150 * moved**2 + friction * abs(moved)
        state = np.sqrt(2 * energy / stiffness) if energy > 0 else 0.0
        last.update(x=x, E=energy, f=np.clip(wish(x), -stiffness * state, stiffness * state))
        return last["f"]

    return law


def owed(forces, stiffness):
    """f² (T/(4b) − 1/(2K)), of the largest force so far; 0 where the device can pay."""
    return np.maximum.accumulate(forces**2) * max(1 / 600 - 1 / (2 * stiffness), 0.0)


@pytest.mark.parametrize("resets", [False, True])
@pytest.mark.parametrize("friction", [0.0, 0.05])
@pytest.mark.parametrize("stiffness", [290, 300, 900, 5000])
def test_it_owes_at_most_one_leap_and_every_force_is_that_of_a_plain_loop(stiffness, friction, resets):
    """f² (T/(4b) − 1/(2K)) at most; nothing where K ≤ 2b/T = 300 N/m."""
    paddle = device(friction=repr(friction))
    loop = zw.render(zw.Wall(stiffness), PassiveLeap(resets=resets))
    for seed in range(6):
        positions, forces = tempt(leapt(wall(stiffness), stiffness, friction, resets), paddle, 500, seed)
        trace = follow(paddle, loop, positions)
        assert trace.commanded_force.to_numpy() == pytest.approx(forces, rel=1e-6, abs=1e-7)
        energy = energy_in(trace)
        assert (energy[1:] >= -owed(forces, stiffness)[:-1] - 1e-12 * energy.max()).all()


def test_a_wall_that_the_device_can_pay_is_not_changed():
    """K ≤ 2b/T, from outside: the wall's own force."""
    positions = np.concatenate([[-1e-3], np.random.default_rng(5).normal(0, 1e-3, 800)])
    alone, behind = (
        follow(device(), law, positions).commanded_force.to_numpy()
        for law in (zw.Wall(300), zw.render(zw.Wall(300), PassiveLeap()))
    )
    assert behind == pytest.approx(alone, rel=1e-9)


def leaping(stiffness):
    """Slowly in and then the best leap out."""
    press = np.linspace(-1e-3, 1e-3, 2000)
    law = leapt(wall(stiffness), stiffness, resets=True)
    force = [law(x) for x in press][-1]
    return np.array([*press, press[-1] - force / 300]), force


@pytest.mark.parametrize(("stiffness", "sign"), [(299, 1), (301, -1), (5000, -1)])
def test_the_best_leap_takes_out_just_that(stiffness, sign):
    """f² (T/(4b) − 1/(2K)) comes out since the touch; it goes in where the device can pay."""
    positions, force = leaping(stiffness)
    energy = energy_in(follow(device(), zw.render(zw.Wall(stiffness), PassiveLeap(resets=True)), positions))
    since_the_touch = energy[-1] - energy[positions < 0][-2]
    assert since_the_touch == pytest.approx(force**2 * (1 / (2 * stiffness) - 1 / 600), rel=0.02)
    assert np.sign(since_the_touch) == sign


def test_after_a_leap_the_wall_is_gone_until_friction_has_paid():
    """No force inside while it owes; the hand that goes on pays, and the wall is there again."""
    positions, _ = leaping(5000)
    slow = np.linspace(positions[-1], 1e-3, 3000)
    quick = np.tile([-1e-2, 1e-3], 8)
    trace = follow(
        device(), zw.render(zw.Wall(5000), PassiveLeap(resets=True)), [*positions, *slow[1:], *quick]
    )
    f, energy = trace.commanded_force.to_numpy(), energy_in(trace)
    n = len(positions)
    assert energy[n - 1] < 0
    assert (f[n - 1 : n + len(slow) - 1] == 0).all()
    assert f[-1] > 1
    assert energy.min() == pytest.approx(energy[n - 1], rel=1e-9)


def test_units_do_not_matter():
    """Length, force and time in other units: the same loop."""
    paddle = device(friction="0.0625")
    positions, _ = tempt(leapt(wall(2048), 2048), paddle, 300, 3)
    elsewhere = zw.Wall(2048 * FORCE / LENGTH)
    assert same_in_other_units(paddle, PassiveLeap(), PassiveLeap(), zw.Wall(2048), elsewhere, positions)
    given = PassiveLeap(stiffness=500), PassiveLeap(stiffness=500 * FORCE / LENGTH)
    assert same_in_other_units(paddle, *given, zw.Wall(2048), elsewhere, positions)


def test_messages():
    """What is wrong is said."""
    with pytest.raises(zw.InputError, match="stiffness must be > 0, got 0: the spring keeps the energy"):
        PassiveLeap(stiffness=0)
    with pytest.raises(zw.InputError, match="resets is True to forget credit where there was no"):
        PassiveLeap(resets=2)
    loop = zw.render(zw.PulseTransferFunction([310, -250], [1, 0]), PassiveLeap())
    with pytest.raises(zw.InputError, match="stiffness has no default here"):
        follow(device(), loop, [0.0, 0.001])
    with pytest.raises(zw.InputError, match="a passive leap pays for the force with the device's damping"):
        follow(device(damping=0), zw.render(zw.Wall(300), PassiveLeap()), [0.0, 0.001])
    assert PassiveLeap(stiffness=5, resets=True).describe() == "passive leap (a spring of 5 N/m, resets)"
