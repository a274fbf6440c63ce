"""The passive leap: sample by sample, what it may owe, and the leap that makes it owe just that."""

import numpy as np
import pytest
from tempting import device, energy_in, follow, tempt, wall

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
