"""A grid against its definition: costs that hold between its nodes, and one sweep of all moves."""

from __future__ import annotations

from fractions import Fraction
from random import Random

import numpy as np
import pytest
from strategies import seeds

import zwidth as zw
from zwidth.passivity.storage.domain import Domain, Losses, losses_of
from zwidth.passivity.storage.grid import Grid
from zwidth.passivity.storage.hull import NOWHERE, ONE_MOVE, sweep
from zwidth.passivity.storage.law import FiniteLaw


def _drawn(rng, memory):
    """A random grid with cells near, between and at the ends of the reach; losses may be 0."""
    taps = tuple(Fraction(f"{tap:.5g}") for tap in 200 * rng.normal(size=memory + 1))
    damping, friction = (
        Fraction(f"{10 ** rng.uniform(low, high):.4g}") * int(rng.random() < 0.7)
        for low, high in ((-3, 1), (-5, -1))
    )
    losses = Losses(damping, friction, Fraction("0.0000224"), Fraction("0.001"), 0)
    domain = Domain(
        -int(rng.integers(0, 9)), int(rng.integers(1, 9)), int(rng.integers(1, (12, 9, 4)[memory]))
    )
    approximation = rng.choice(["outer", "inner"])
    steps = int(rng.integers(1, 7)) if approximation == "outer" else 1024
    surface = rng.choice(["none", "position", "penetration"])
    return Grid(FiniteLaw(taps, surface, bool(rng.integers(2))), losses, domain, steps, approximation)


def _start(rng, grid):
    """V as an iteration may begin and go on, hills that are worth a walk, or any whole numbers."""
    guess = grid.first_guess
    some = (guess * rng.random(guess.shape)).astype(np.int64)
    x = np.arange(grid.domain.cells)[:, None] * grid.steps + grid.nodes
    length = grid.steps * rng.uniform(2, 9)
    force = np.abs(grid.forces[grid.forces != NOWHERE]).max() + abs(grid.costs[-1] / (grid.costs.size - 1))
    hills = force * length * rng.uniform(0.1, 1) * np.cos(x / length + rng.uniform(0, 6))
    hills = np.repeat(hills.astype(np.int64)[:, None, :], grid.histories, axis=1)
    any_ = rng.integers(0, 4, guess.shape) * max(1, int(guess.max()) // int(rng.integers(2, 50)))
    return [0 * guess, guess.copy(), some, hills, hills + some, any_][rng.integers(6)]


def _by_definition(grid, value, choice):
    """Group by group and node by node; of equal moves the least d, and of one d the cell below."""
    cells, histories, edges = value.shape
    reach, nodes, steps = grid.domain.reach, grid.nodes, grid.steps
    alike = grid.width if grid.memory else 1
    per_cell = histories // alike
    for n, newer, j in np.ndindex(cells, per_cell, edges):
        targets = [
            (n2, ((n - n2 + reach) * per_cell + newer) if grid.memory else 0, j2)
            for n2 in range(max(0, n - reach), min(cells, n + reach + 1))
            for j2 in range(edges)
        ]
        d = np.array([(n2 - n) * steps + nodes[j2] - nodes[j] for n2, _, j2 in targets])
        near = np.abs(d) < len(grid.costs)
        d, targets = d[near], np.array(targets)[near]
        height = value[tuple(targets.T)] - grid.costs[np.abs(d)]
        for h in range(newer * alike, (newer + 1) * alike):
            if grid.forces[n, h] == NOWHERE:
                continue
            energy = height - grid.forces[n, h] * d
            best = int(energy.argmax())
            if energy[best] > value[n, h, j]:
                value[n, h, j] = energy[best]
                choice[n, h, j] = np.ravel_multi_index(targets[best], value.shape)


@pytest.mark.parametrize("memory", [0, 1, 2])
def test_a_sweep_finds_the_best_move_of_every_state(memory: int) -> None:
    """V and the best moves, to the last bit: what is left out of the hulls is never best."""
    rng = np.random.default_rng(memory)
    improved = 0
    for _ in range((60, 25, 8)[memory]):
        grid = _drawn(rng, memory)
        value = _start(rng, grid)
        choice = np.full(value.shape, -1, np.int64)
        own_value, own_choice = value.copy(), choice.copy()
        groups = len(value) * (grid.histories // grid.width if memory else 1)
        tables = grid.forces, grid.costs, grid.nodes, grid.places, grid.domain.reach, grid.steps
        improved += sweep(own_value, own_choice, 0, groups, *tables, *ONE_MOVE)
        _by_definition(grid, value, choice)
        assert (own_value == value).all()
        assert (own_choice == choice).all()
    assert improved > 1000


def lost(distance):
    """L(D): nothing up to one step, D² − ¼ beyond."""
    return Fraction(0) if distance <= 1 else distance**2 - Fraction(1, 4)


@seeds(15)
def test_every_move_between_nodes_is_covered(seed):
    """V and V' drawn at random, just large enough at the nodes: then nowhere between them too small."""
    random = Random(seed)
    steps, drag, force = 5, Fraction(random.randint(0, 9), 4), Fraction(random.randint(-9, 9), 2)
    friction = Fraction(random.randint(0, 4), 2)
    there = [Fraction(random.randint(-20, 20)) for _ in range(steps + 1)]

    def left(x, y, here, spent):
        return here + force * (y - x) + friction * abs(y - x) + spent - _linear(there, y)

    needed = [
        max(-left(Fraction(x), Fraction(y), 0, drag * lost(abs(y - x))) for y in range(steps + 1))
        for x in range(steps + 1)
    ]
    for _ in range(400):
        x, y = (Fraction(random.randint(0, 1000 * steps), 1000) for _ in range(2))
        assert left(x, y, _linear(needed, x), drag * (y - x) ** 2) >= 0


def _linear(values, x):
    at = min(int(x), len(values) - 2)
    return values[at] + (values[at + 1] - values[at]) * (x - at)


@seeds(12)
def test_the_costs_of_a_grid_are_these(seed):
    """Outer: at most φ D + β L(D) of the true friction and drag; inner: at least φ D + β D²."""
    random = Random(seed)
    paid = (Fraction(random.randint(1, 10**6), 10**6) for _ in range(2))
    losses = Losses(*paid, Fraction(1, 9973), Fraction(1, 3000), 0)
    law = FiniteLaw((Fraction(random.randint(1, 3000)),), "position")
    for approximation in ("outer", "inner"):
        grid = Grid(law, losses, Domain(-4, 4, 3), 8, approximation)
        drag = losses.damping / losses.period * (losses.resolution / 8) / grid.force_unit
        friction = losses.coulomb_friction / grid.force_unit
        for distance, cost in enumerate(grid.costs.tolist()):
            if approximation == "outer":
                assert cost <= friction * distance + drag * lost(distance)
                least = (friction - grid.rounding - 1) * distance + drag * lost(distance)
                assert cost >= least - distance**2 - 1
            else:
                assert cost >= friction * distance + drag * distance**2
                assert cost <= (friction + grid.rounding + 1) * distance + (drag + 1) * distance**2
    assert np.all(np.diff(grid.nodes) > 0)


def test_the_losses_are_hardly_touched_by_rounding():
    """A force unit is so small that rounding takes less than a millionth off the friction."""
    law = FiniteLaw((Fraction(700), Fraction(-300)), "position")
    losses = losses_of(zw.catalogue.device("haptic-paddle").replace(delay="1 ms"))
    grid = Grid(law, losses, Domain(-47, 64, 16), 64, "outer")
    friction = int(grid.costs[1]) * grid.force_unit
    assert friction > losses.coulomb_friction * (1 - Fraction(1, 10**6))
