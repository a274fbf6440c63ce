"""Force bounding: sample by sample, its promise against hands that tempt it, and what counts break."""

from __future__ import annotations

import numpy as np
import pytest
from tempting import LENGTH, device, energy_in, follow, same_in_other_units, tempt, wall

import zwidth as zw
from zwidth.model.rendering import ForceBounding

DEVICES = [
    (0, 0),
    ("0.12", "0.0000224"),
    ("0.02", "0.0000224"),
    (0, "0.00005"),
    ("0.05", 0),
]


def bounded(wish, device, counted=True, resets=False):
    """The law in other words: of all slopes g' at which the least energy may change its shape, the best."""
    keys = ("damping", "coulomb_friction", "resolution")
    b, fc, size = (float(device.exact(key)) for key in keys)
    fc, size = (fc, size) if counted else (0.0, 0.0)
    rate, last = b / 1e-3, {"q": None, "E": 0.0, "g": 0.0, "f": 0.0}

    def law(q):
        energy, g, f = last["E"], last["g"], last["f"]
        moved = 0.0 if last["q"] is None else q - last["q"]
        if resets and f == 0:
            energy = g = 0.0
        if moved == 0:
            slopes = [f - fc, f + fc, *([g] if abs(g - f) <= fc else [])]
        else:
            kinks = [f + np.sign(moved) * fc + 2 * rate * (moved + part * size / 2) for part in (-1, 1)]
            slopes = [g, *kinks]
        left = [
            (energy + n * moved - max(abs(n - f) - fc, 0) ** 2 / (4 * rate) - abs(n - g) * size / 2, n)
            for n in slopes
        ]
        energy, g = max(left)
        if energy < abs(g) * size / 2:
            energy = g = 0.0
        room = fc + 2 * np.sqrt(rate * (energy - abs(g) * size / 2))
        last.update(q=q, E=energy, g=g, f=min(max(wish(q), -room), room))
        return last["f"]

    return law


@pytest.mark.parametrize("resets", [False, True])
@pytest.mark.parametrize(("friction", "size"), DEVICES)
@pytest.mark.parametrize("stiffness", [290, 5000])
def test_no_hand_takes_energy_out_and_every_force_is_that_of_a_plain_loop(stiffness, friction, size, resets):
    """The energy is never below 0, with counts and friction, for hands that know the law."""
    paddle = device(friction=friction, resolution=size)
    loop = zw.render(zw.Wall(stiffness), ForceBounding(resets=resets))
    for seed in range(6):
        positions, forces = tempt(bounded(wall(stiffness), paddle, resets=resets), paddle, 500, seed)
        trace = follow(paddle, loop, positions)
        # where next to nothing is left, the hair that pays for rounding is seen through a square root
        assert trace.commanded_force.to_numpy() == pytest.approx(forces, rel=1e-9, abs=1e-7)
        assert energy_in(trace).min() >= -1e-13 * energy_in(trace).max()


def test_the_bound_is_reached():
    """The best move of one sample after a touch takes out all that was put in, to the last digits."""
    paddle = device()
    rest = np.linspace(-1e-3, 4e-4, 9)
    law = bounded(wall(1e5), paddle)
    force = [law(x) for x in rest][-1]
    trace = follow(
        paddle, zw.render(zw.Wall(100_000), ForceBounding()), [*rest, rest[-1] - force * 1e-3 / 0.3]
    )
    energy = energy_in(trace)
    assert energy[-2] > 1e-6
    assert abs(energy[-1]) < 1e-12 * energy[-2]


def test_a_wall_that_the_device_can_pay_is_not_changed():
    """K ≤ 2b/T, an encoder without counts, from outside: the wall's own force."""
    paddle = device()
    positions = np.concatenate([[-1e-3], np.random.default_rng(5).normal(0, 1e-3, 800)])
    alone, behind = (follow(paddle, law, positions).commanded_force for law in _with_and_without(300))
    assert behind.to_numpy() == pytest.approx(alone.to_numpy(), rel=1e-9)


def _with_and_without(stiffness):
    return zw.Wall(stiffness), zw.render(zw.Wall(stiffness), ForceBounding())


def test_a_force_that_is_held_still_costs_nothing():
    """With counts too: a hand that stays keeps its force, whole seconds long."""
    paddle = device(friction="0.12", resolution="0.0000224")
    positions = np.concatenate([np.linspace(-5e-3, 2e-3, 100), np.full(3000, 2e-3)])
    force = follow(paddle, zw.render(zw.Wall(1500), ForceBounding()), positions).commanded_force.to_numpy()
    assert force[101] > 1
    assert (force[101:] == force[101]).all()


def jittering(samples, size):
    """To and fro over an edge outside, then one count in and the best leap out."""
    edge = -size
    jitter = edge + 1e-6 * size * np.where(np.arange(samples) % 2, 1, -1)
    force = 2 * 150 * size * np.sqrt(samples)
    return np.array([*jitter, 2.5 * size, 2.5 * size - force / 300])


@pytest.mark.parametrize("samples", [100, 400, 1600])
def test_counts_break_the_public_law_as_much_as_the_hand_likes(samples):
    """(b/T) Δ² per sample of jitter, nearly all of it; with counts in the law, nothing."""
    size = 5e-5
    paddle = device(friction="0.0001", resolution="0.00005")
    positions = jittering(samples, size)
    public, counted = (
        energy_in(follow(paddle, zw.render(zw.Wall(100_000), ForceBounding(encoder=word)), positions))
        for word in ("ideal", "counted")
    )
    assert public[-1] < -0.9 * samples * 150 * size**2
    assert counted.min() >= 0


@pytest.mark.parametrize("resets", [False, True])
def test_nor_do_resets_help_against_counts(resets):
    """Up within a count at the lower force, out of it at the higher, as energy bounding is broken."""
    paddle = device(friction="0.0001", resolution="0.00005")
    cycle = [*np.linspace(1, 2 - 1e-6, 40), 2 + 1e-6]
    positions = 5e-5 * np.array([*np.linspace(-1, 1, 60), *(cycle * 400), 1])
    public, counted = (
        energy_in(
            follow(paddle, zw.render(zw.Wall(5000), ForceBounding(encoder=word, resets=resets)), positions)
        )
        for word in ("ideal", "counted")
    )
    assert public[-1] < -1e-4
    assert counted.min() >= 0


def test_converter_steps_are_kept_below_the_bound():
    """Rounding to the device's own steps does not take energy out either, nor between samples."""
    paddle = device(force_resolution="0.05")
    loop = zw.render(zw.Wall(5000), ForceBounding())
    for seed in range(20):
        positions, _ = tempt(bounded(wall(5000), paddle), paddle, 400, seed)
        energy = energy_in(follow(paddle, loop, positions, points_per_sample=3))
        assert energy.min() >= -1e-13 * energy.max()


@pytest.mark.parametrize("resets", [False, True])
def test_units_do_not_matter(resets):
    """Length, force and time in other units: the same loop."""
    paddle = device(friction="0.0625", resolution="0.00005")
    law = ForceBounding(resets=resets)
    positions, _ = tempt(bounded(wall(2048), paddle, resets=resets), paddle, 300, 3)
    elsewhere = zw.Wall(2048 / 2**5 / LENGTH)
    assert same_in_other_units(paddle, law, law, zw.Wall(2048), elsewhere, positions)


def test_messages():
    """What is wrong is said."""
    with pytest.raises(zw.InputError, match="encoder is one of 'counted', 'ideal', got 'real'"):
        ForceBounding(encoder="real")
    with pytest.raises(zw.InputError, match="resets is True to forget"):
        ForceBounding(resets=1)
    loop = zw.render(zw.Wall(300), ForceBounding())
    with pytest.raises(zw.InputError, match="force bounding pays for the force with the device's damping"):
        follow(device(damping=0), loop, [0.0, 0.001])
    assert loop.describe() == "wall, 300 N/m, with force bounding (counted encoder)"
