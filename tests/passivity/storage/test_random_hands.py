"""Soundness by another road: random, greedy and learning hands get nothing out of what is proved passive."""

from __future__ import annotations

from fractions import Fraction
from functools import cache

import numpy as np
import pytest
from crowd import Crowd

import zwidth as zw
from zwidth.passivity.storage import available_storage
from zwidth.passivity.storage.program import program_of

BOUNDS = {"penetration": "0.0012", "speed": "0.6"}


def device(damping, friction, delay=0, **more):
    """A device of 0.1 mm a count at 1 kHz, the delay in samples."""
    return zw.Device(
        damping=damping,
        coulomb_friction=friction,
        resolution="0.0001",
        sample_period="0.001",
        delay=Fraction(delay, 1000),
        **more,
    )


LOOPS = {
    "spring": (device("0.16", "0.0165"), zw.Wall(300)),
    "spring, too stiff for a fast hand": (device("0.1", "0.04"), zw.Wall(240)),
    "damped": (device("0.26", "0.027"), zw.Wall(300, "0.1")),
    "damped and clamped": (device("0.26", "0.027"), zw.Wall(300, "0.1", clamped=True)),
    "negative damping": (device("0.27", "0.020"), zw.Wall(350, "-0.1")),
    "window": (device("0.21", "0.022"), zw.Wall(300, "0.1", zw.rendering.Window(2))),
    "spring with a delay": (device("0.45", "0.0165", 1), zw.Wall(300)),
    "damped with a delay": (device("0.4", "0.0275", 1), zw.Wall(300, "0.1")),
    "force limit": (device("0.16", "0.0165", force_limit="0.2"), zw.Wall(300)),
    "contact": (device("2.2", "0.24"), zw.HuntCrossley(20000, "1.5", 2)),
    "contact that pulls, with a delay": (
        device("1.6", "0.085", 1),
        zw.HuntCrossley(20000, "1.7", 4, clamped=False),
    ),
    "converter": (device("0.36", "0.036", force_resolution="0.07"), zw.Wall(300)),
    "damped behind a converter": (
        device("0.4", "0.043", force_resolution="0.04", force_limit="0.23"),
        zw.Wall(300, "0.1"),
    ),
    "detents": (device("0.16", "0.0165"), zw.NonlinearSpring.detents(2, "0.0012", "0.08")),
    "spring, slow hand": (device("0.1", "0.04"), zw.Wall(395)),
    "damped, slow hand": (device("0.26", "0.027"), zw.Wall(327, "0.1")),
}
"""Loops near the limit; some of them active for a faster or deeper hand."""

SLOW = {"spring, slow hand": "0.237", "damped, slow hand": "0.13"}
"""Speeds that are no whole counts a sample; the spring is active at three counts a sample."""


def bounds(name):
    """Of the hand."""
    return {**BOUNDS, "speed": SLOW.get(name, BOUNDS["speed"])}


def counted(loop):
    """Of the actuator, what is known."""
    return {f"force_{key}": getattr(loop, f"force_{key}") is not None for key in ("limit", "resolution")}


@cache
def proved(name):
    """The dynamic program and the storage function."""
    loop, law = LOOPS[name]
    found = available_storage(loop, law, **counted(loop), **bounds(name))
    assert found.outcome == "passive"
    return program_of(loop, law, **counted(loop), **bounds(name)), found.storage


def weaker(name, share):
    """The same on a device with a share of the damping and friction."""
    loop, law = LOOPS[name]
    less = {key: loop.exact(key) * share for key in ("damping", "coulomb_friction")}
    return program_of(loop.replace(**less), law, **counted(loop), **bounds(name))


def left_over(crowd, state, move):
    """V before less what the move takes out less V after, and the scale of these energies [J]."""
    cells, _, before = state
    out = crowd.energy(*state, *move)
    later = crowd.stored(*move, crowd.after(cells, before))
    now = crowd.stored(*state)
    return now - out - later, abs(now) + abs(out) + abs(later)


@pytest.mark.parametrize("name", LOOPS)
def test_no_move_takes_out_more_than_the_storage_falls(name):
    """200 000 moves from states at random, between the nodes too, most of them from edge to edge."""
    crowd = Crowd(*proved(name), seed=1)
    state = crowd.somewhere(200_000)
    left, scale = left_over(crowd, state, crowd.wish(*state))
    assert (left >= -1e-12 * scale.max()).all()


@pytest.mark.parametrize("name", LOOPS)
def test_no_move_that_is_sought_downhill_does(name):
    """Places changed at random for less left over: it never becomes negative."""
    crowd = Crowd(*proved(name), seed=2)
    state = crowd.somewhere(4000)
    move = crowd.wish(*state)
    left, scale = left_over(crowd, state, move)
    for size in np.geomspace(0.3, 1e-9, 120):
        other = np.clip(state[1] + size * crowd.random.normal(size=4000), 0, 1 - 1e-12)
        stop = np.clip(move[1] + size * crowd.random.normal(size=4000), 0, 1 - 1e-12)
        far = abs(move[0] - state[0] + stop - other) > float(crowd.domain.speed)
        other, stop = np.where(far, state[1], other), np.where(far, move[1], stop)
        found, _ = left_over(crowd, (state[0], other, state[2]), (move[0], stop))
        less = found < left
        left = np.where(less, found, left)
        state = (state[0], np.where(less, other, state[1]), state[2])
        move = (move[0], np.where(less, stop, move[1]))
    assert left.min() >= -1e-12 * scale.max()
    assert left.min() <= 0.02 * scale.max()  # the search comes close: V is not far too large


@pytest.mark.parametrize("name", LOOPS)
def test_hands_get_out_no_more_than_was_stored_at_the_start(name):
    """3000 hands over 60 samples, half of them greedy for what leaves the most, from rest outside or at 0."""
    crowd = Crowd(*proved(name), seed=3)
    number = 3000
    cells = np.zeros(number, np.int64)
    places = crowd.place(number)
    before = np.zeros((number, crowd.memory), np.int64)
    at_start, out, most = crowd.stored(cells, places, before), np.zeros(number), np.zeros(number)
    for _ in range(60):
        best = crowd.wish(cells, places, before)
        left, _ = left_over(crowd, (cells, places, before), best)
        for _ in range(12):
            other = crowd.wish(cells, places, before)
            found, _ = left_over(crowd, (cells, places, before), other)
            take = (found < left) & (np.arange(number) % 2 == 0)
            best = (np.where(take, other[0], best[0]), np.where(take, other[1], best[1]))
            left = np.where(take, found, left)
        out += crowd.energy(cells, places, before, *best)
        before = crowd.after(cells, before)
        cells, places = best
        most = np.maximum(most, out)
    assert (most <= at_start + 1e-12 * crowd.value.max()).all()


@pytest.mark.parametrize("name", [n for n, (_, law) in LOOPS.items() if law.unilateral])
def test_nor_hands_that_go_far_away_in_between(name):
    """Outside of the grid nothing is stored: a hand that leaves it and comes back takes no more."""
    program, storage = proved(name)
    crowd = Crowd(program, storage, seed=4)
    number, reach = 4000, program.domain.reach
    cells, places = np.zeros(number, np.int64), crowd.place(number)
    before = np.zeros((number, crowd.memory), np.int64)
    at_start, out, most = crowd.stored(cells, places, before), np.zeros(number), np.zeros(number)
    left_the_grid = np.zeros(number, bool)
    for _ in range(80):
        ahead = crowd.random.integers(-reach, reach + 1, number)
        there = np.minimum(cells + ahead, program.domain.highest)
        stop = crowd.place(number)
        too_far = abs(there - cells + (stop - places)) > float(program.domain.speed)
        there, stop = np.where(too_far, cells, there), np.where(too_far, places, stop)
        out += crowd.energy(cells, places, before, there, stop)
        before = crowd.after(cells, before)
        cells, places = there, stop
        most = np.maximum(most, out)
        left_the_grid |= cells < program.domain.lowest
    assert left_the_grid.mean() > 0.3
    assert (most <= at_start + 1e-12 * crowd.value.max()).all()


@pytest.mark.parametrize("name", LOOPS)
def test_no_cycle_is_learned(name):
    """Cycles of two to six samples, changed at random for more energy: none ever gains.

    On a device with seven tenths of damping and friction the same search finds one,
    for it is the losses that hold it back.
    """
    crowd = Crowd(proved(name)[0], seed=5)
    scale = float(crowd.losses.coulomb_friction) * crowd.step
    assert max(crowd.climbed(samples, 300, 150) for samples in range(2, 7)) <= 1e-12 * scale
    blunt = Crowd(weaker(name, Fraction(7, 10)), seed=5)
    assert max(blunt.climbed(samples, 300, 150) for samples in range(2, 7)) > 0
