"""Energy bounding: sample by sample, its promise, force bounding without credit, and what counts break."""

import numpy as np
import pytest
from tempting import device, energy_in, follow, tempt, wall

import zwidth as zw
from zwidth.model.rendering import EnergyBounding


def bounded(wish, damping=0.15):
    """f + β Δx, with β clipped between its two ends."""
    last = {"x": None, "f": 0.0}

    def law(x):
        moved = 0.0 if last["x"] is None else x - last["x"]
        f, wanted, stiffest = last["f"], wish(x), 2 * damping / 1e-3
        if moved == 0:
            beta, f = 0.0, np.clip(wanted, -abs(f), abs(f))
        else:
            ends = sorted([stiffest, -stiffest - 2 * f / moved])
            beta = np.clip((wanted - f) / moved, *ends)
        last.update(x=x, f=f + beta * moved)
        return last["f"]

    return law


def by_energy(wish, damping=0.15):
    """Force bounding whose energy is set to f² T/(4b) in each sample."""
    last, rate = {"x": None, "f": 0.0}, damping / 1e-3

    def law(x):
        moved = 0.0 if last["x"] is None else x - last["x"]
        energy = last["f"] ** 2 / (4 * rate) + last["f"] * moved + rate * moved**2
        room = 2 * np.sqrt(rate * max(energy, 0.0))
        last.update(x=x, f=np.clip(wish(x), -room, room))
        return last["f"]

    return law


@pytest.mark.parametrize("law", [bounded, by_energy])
@pytest.mark.parametrize("stiffness", [290, 900, 5000])
def test_no_hand_takes_energy_out_and_every_force_is_that_of_a_plain_loop(stiffness, law):
    """What hands that know the law have put in is at least f² T/(4b), the least that the next move takes."""
    paddle = device()
    loop = zw.render(zw.Wall(stiffness), EnergyBounding())
    for seed in range(8):
        positions, forces = tempt(law(wall(stiffness)), paddle, 500, seed)
        trace = follow(paddle, loop, positions)
        assert trace.commanded_force.to_numpy() == pytest.approx(forces, rel=1e-9, abs=1e-9)
        stored = forces**2 / (4 * 150)
        assert (energy_in(trace) - stored).min() >= -1e-13 * energy_in(trace).max()


def climbing(cycles, size, lift):
    """Within one count: slowly up over its lower edge by next to nothing, and out of it in one sample."""
    low, high = (1 + lift) * size, (2 - 1e-6) * size
    cycle = [*np.linspace(low, high, 40), (2 + 1e-6) * size]
    return np.array([*np.linspace(-size, low, 60), *(cycle * cycles), low])


@pytest.mark.parametrize(("friction", "passive"), [(0.95, False), (1.05, True)])
def test_counts_break_it_where_friction_is_less_than_half_a_count_of_damping(friction, passive):
    """Up a count at the lower force, down at the higher: Δ² b/T against 2 f_c Δ, again and again."""
    size = 5e-5
    friction = friction * 150 * size / 2
    paddle = device(friction=repr(friction), resolution="0.00005")
    loop = zw.render(zw.Wall(5000), EnergyBounding())
    lift = max(0.0, 1 - (300 * size - 2 * friction) / 300 / size)
    positions = climbing(400, size, lift)
    energy = energy_in(follow(paddle, loop, positions))
    assert (energy[-1] < 0) is not passive
