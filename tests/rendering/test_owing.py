"""Energy bounding, passive leap, tank: by plain loops, what they may owe, the hands that make them owe it."""

import numpy as np
import pytest
from prescribed import device, energy_in, follow, tempt, wall

import zwidth as zw
from zwidth.model.rendering import EnergyBounding, EnergyTank, PassiveLeap


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
def test_a_passive_leap_owes_at_most_one_leap_and_is_a_plain_loop(stiffness, friction, resets):
    """f² (T/(4b) − 1/(2K)) at most; nothing where K ≤ 2b/T = 300 N/m."""
    paddle = device(friction=repr(friction))
    loop = zw.render(zw.Wall(stiffness), PassiveLeap(resets=resets))
    for seed in range(6):
        positions, forces = tempt(leapt(wall(stiffness), stiffness, friction, resets), paddle, 500, seed)
        trace = follow(paddle, loop, positions)
        assert trace.commanded_force.to_numpy() == pytest.approx(forces, rel=1e-6, abs=1e-7)
        energy = energy_in(trace)
        assert (energy[1:] >= -owed(forces, stiffness)[:-1] - 1e-12 * energy.max()).all()


def best_leap(stiffness):
    """Slowly in and then the best leap out."""
    press = np.linspace(-1e-3, 1e-3, 2000)
    law = leapt(wall(stiffness), stiffness, resets=True)
    force = [law(x) for x in press][-1]
    return np.array([*press, press[-1] - force / 300]), force


@pytest.mark.parametrize(("stiffness", "sign"), [(299, 1), (301, -1), (5000, -1)])
def test_the_best_leap_takes_out_just_that(stiffness, sign):
    """f² (T/(4b) − 1/(2K)) comes out since the touch; it goes in where the device can pay."""
    positions, force = best_leap(stiffness)
    energy = energy_in(follow(device(), zw.render(zw.Wall(stiffness), PassiveLeap(resets=True)), positions))
    since_the_touch = energy[-1] - energy[positions < 0][-2]
    assert since_the_touch == pytest.approx(force**2 * (1 / (2 * stiffness) - 1 / 600), rel=0.02)
    assert np.sign(since_the_touch) == sign


def test_after_a_leap_the_wall_is_gone_until_friction_has_paid():
    positions, _ = best_leap(5000)
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
def test_a_tank_owes_at_most_one_leap_and_is_a_plain_loop(stiffness, calm):
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
