"""The energy tank: sample by sample, what it may owe, and the hands that make it owe."""

import numpy as np
import pytest
from tempting import device, energy_in, follow, tempt, wall

import zwidth as zw
from zwidth.model.rendering import EnergyTank


def tank(wish, level, refill, most):
    """The law; `law.parts` are the wall's parts of its forces."""
    last, parts = {"x": None, "f": 0.0, "H": 0.0}, []

    def law(x):
        moved = 0.0 if last["x"] is None else x - last["x"]
        energy = last["H"] + last["f"] * moved
        push = wish(x) if energy > 0 else 0.0
        if moved != 0:
            push = np.clip(push, -abs(energy / moved), abs(energy / moved))
        parts.append(push)
        damping = min(most, refill * max(0.0, level - energy))
        last.update(x=x, H=energy, f=push + damping * moved / 1e-3)
        return last["f"]

    law.parts = parts
    return law


@pytest.mark.parametrize("stiffness", [290, 5000])
@pytest.mark.parametrize("calm", [False, True])
def test_it_owes_at_most_one_leap_and_every_force_is_that_of_a_plain_loop(stiffness, calm):
    """Never below −|f_w| (|Δx'| − |Δx|) of the worst sample so far; not below 0 where the hand never
    goes out faster than in the sample before."""
    paddle, level = device(), 2e-3
    loop = zw.render(zw.Wall(stiffness), EnergyTank(level="0.002"))
    for seed in range(8):
        law = tank(wall(stiffness), level, 0.15 / level, 0.15)
        positions, forces = tempt(law, paddle, 500, seed)
        if calm:
            law = tank(wall(stiffness), level, 0.15 / level, 0.15)
            positions, forces = calmed(law, positions)
        trace = follow(paddle, loop, positions)
        assert trace.commanded_force.to_numpy() == pytest.approx(forces, rel=1e-6, abs=1e-7)
        moves, push = np.diff(positions), np.array(law.parts)
        longer = np.maximum(np.abs(moves[1:]) - np.abs(moves[:-1]), 0.0)
        leaps = np.where(push[1:-1] * moves[1:] < 0, np.abs(push[1:-1]) * longer, 0.0)
        assert (leaps.max() > 0) is not calm
        energy = energy_in(trace)
        worst = np.maximum.accumulate(leaps)
        assert (energy[2:] >= -worst - 1e-10 * np.abs(energy).max()).all()


def calmed(law, wanted):
    """The same hand, but out of the wall no faster than it came, and the forces it then feels."""
    x, moved, positions, forces = wanted[0], 0.0, [], []
    for goal in [*wanted[1:], wanted[-1]]:
        positions.append(x)
        forces.append(law(x))
        step = goal - x
        if law.parts[-1] * step < 0:
            step = np.clip(step, -abs(moved), abs(moved))
        moved, x = step, x + step
    return np.array(positions), np.array(forces)


def leaping(times):
    """Slowly in, still for a sample, and out in one."""
    cycle = [*np.linspace(-1e-3, 1e-3, 200), 1e-3, 0.0]
    return np.array(cycle * times)


def test_a_leap_from_rest_takes_out_twice_what_was_put_in():
    """K x² comes out for ½ K x², less (b/T) x²; no second one follows before that is paid."""
    loop = zw.render(zw.Wall(5000), EnergyTank(level="0.002"))
    energy = energy_in(follow(device(), loop, leaping(1)))
    assert energy[-1] == pytest.approx(-0.5 * 5000e-6 + 150e-6, rel=0.05)
    again = energy_in(follow(device(), loop, leaping(20)))
    assert again.min() == pytest.approx(energy[-1], rel=1e-12)


def test_an_unlimited_damper_gives_out_without_end():
    """A hand that goes to and fro outside the wall, 0.5 mm a sample: d beyond b comes out, and d grows."""
    positions = -2e-3 + 5e-4 * (np.arange(400) % 2)
    for most, least in ((None, 0.0), ("100000", -10.0)):
        law = EnergyTank(level="0.002", refill="150", largest_damping=most)
        energy = energy_in(follow(device(), zw.render(zw.Wall(5000), law), positions))
        assert energy[-1] >= 0 if most is None else energy[-1] < least
