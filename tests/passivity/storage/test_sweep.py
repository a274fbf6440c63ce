"""One sweep against its definition: every state looks at every move, whatever V it starts from."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

from zwidth.passivity.storage.domain import Domain, Losses
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
