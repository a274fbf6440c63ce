"""Grids for laws that relax: one continuous memory.

A Maxwell branch or a one-pole filter gives

    y = g (u_k − a_k),      a_{k+1} = p a_k + (1 − p) u_k

a the average of all readings before, with weights that die out.  V is linear between levels of a as well.  A
move from a leads to an a' that moves by p times as much, so that between two neighbouring levels V(s', a')
has one kink at most: a move that is harmless at both levels and at that kink is harmless between them.

The best moves on the levels make no cycle by themselves, as a lies between them.  So a hand that
follows them is watched, with the average as it really becomes.
"""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from math import ceil, floor
from typing import Any

import numpy as np
from numpy.typing import NDArray

from zwidth.passivity.storage.domain import Integers
from zwidth.passivity.storage.grid import Grid
from zwidth.passivity.storage.hull import NOWHERE
from zwidth.passivity.storage.relaxing_moves import RelaxingForce, best_cycle, follow, sweep_relaxing
from zwidth.passivity.storage.value_iteration import THREADS, Move, Sweep, Until, slices

ONE = 1 << 16
"""Weights of interpolation are whole multiples of 1/ONE, taken from both sides."""

_MOVE = 5e-9  # what a move from a state costs in a round, in the unit of `effort`
_STARTS = 12  # states from which the best moves are followed in one search
_LONGEST = 160  # moves that are followed
_BLOCKS = 8
"""Blocks of cells, each improved by one thread from what the others were before the round: as many on every
machine, so that it ends the same way on each.  (What is raised between levels depends on the order.)"""

_MAX_ROUNDS = {"outer": 300, "inner": 60}
"""Rounds after which the search is given up: energy that only trickles in from level to level."""


@dataclass(frozen=True)
class RelaxingGrid(Grid):
    """A grid with levels of the average reading as a further dimension of its states."""

    levels: int = 1  # levels of a per count

    @property
    def _max_energy(self) -> int:
        """Smaller, because energies are multiplied with weights."""
        return 2**44

    @property
    def pole(self) -> Fraction:
        """p of the relaxing memory."""
        assert self.law.relaxing is not None
        return self.law.relaxing[0]

    @cached_property
    def readings(self) -> tuple[int, int]:
        """The least and the largest u that is averaged, in counts."""
        low = 0 if self.law.surface == "penetration" else self.domain.lowest
        return low, max(self.domain.highest, low + 1)

    @property
    def averages(self) -> int:
        """How many levels of a there are."""
        low, high = self.readings
        return (high - low) * self.levels + 1

    @cached_property
    def branch_unit(self) -> int:
        """g times one level of a, in force units."""
        assert self.law.relaxing is not None
        return floor(self.law.relaxing[1] * self.losses.resolution / self.levels / self.force_unit)

    @property
    def rounding(self) -> int:
        """Units by which a force may be off."""
        return super().rounding + 2 * self.averages + 2

    @cached_property
    def rows(self) -> Integers:
        """Which cell the hand was in when the force was computed, as a row; −1 off the grid."""
        cells = np.arange(self.domain.cells, dtype=np.int64)[:, None]
        acting = cells + self.differences.sum(axis=1)[None, :]
        out: Integers = np.where(self.forces == NOWHERE, -1, acting)
        return out

    @property
    def relaxing_force(self) -> RelaxingForce:
        """The law as a hand that is watched feels it."""
        law, unit = self.law, self.losses.resolution / self.force_unit
        return RelaxingForce(
            spring=float(law.taps[0] * unit),
            branch=float(self.branch_unit * self.levels),
            pole=float(self.pole),
            penetration=law.surface == "penetration",
            everywhere=law.surface == "none",
            clamped=law.clamped,
            resets=law.resets,
        )

    @cached_property
    def all_forces(self) -> tuple[Integers, Integers]:
        """The force of each cell (rows) at each level of a, for a move inwards and for one outwards.

        They differ where a law that never pulls begins to push between two levels:
        there a move inwards is given the cheaper force of the two.
        """
        low, _ = self.readings
        cells = np.arange(self.domain.lowest, self.domain.highest + 1, dtype=np.int64)[:, None]
        u = np.maximum(cells, 0) if self.law.surface == "penetration" else cells
        levels = np.arange(self.averages, dtype=np.int64)[None, :]
        spring = floor(self.law.taps[0] * self.losses.resolution / self.force_unit)
        force = spring * u + self.branch_unit * ((u - low) * self.levels - levels)
        inwards = force
        if self.law.clamped:
            pushes = force > 0
            lonely = np.zeros_like(pushes)  # pushes, and a neighbouring level does not
            lonely[:, 1:] |= pushes[:, 1:] & ~pushes[:, :-1]
            lonely[:, :-1] |= pushes[:, :-1] & ~pushes[:, 1:]
            force = np.where(pushes, force, 0)
            inwards = np.where(lonely, 0, force) if self.approximation == "outer" else force
        if self.law.surface != "none":
            force, inwards = (np.where(cells > 0, f, 0) for f in (force, inwards))
        return inwards, force

    @cached_property
    def images(self) -> tuple[Integers, Integers, Integers]:
        """Where a goes from each level (columns) under each reading (rows): level, and weight of the next.

        The third is the weight rounded up: the truth lies between the two.
        """
        low, _ = self.readings
        shape = (self.domain.cells, self.averages)
        at, below, above = (np.zeros(shape, np.int64) for _ in range(3))
        for row, n in enumerate(range(self.domain.lowest, self.domain.highest + 1)):
            u = max(n, 0) if self.law.surface == "penetration" else n
            forgotten = self.law.resets and u <= 0
            for i in range(self.averages):
                image = self.pole * i + (1 - self.pole) * (u - low) * self.levels
                image = Fraction(-low * self.levels) if forgotten else image
                whole = min(floor(image), self.averages - 2)
                weight = (image - whole) * ONE
                at[row, i], below[row, i], above[row, i] = whole, floor(weight), ceil(weight)
        return at, below, above

    def domain_document(self) -> dict[str, Any]:
        """The same with the levels."""
        return {**super().domain_document(), "levels_per_count": self.levels}

    def remembered(self, value: Integers) -> tuple[str, Any, NDArray[np.float64]]:
        """The level of the average reading [counts], the hand at rest before."""
        levels = self.readings[0] + np.arange(self.averages) / self.levels
        return "average_reading", levels, value[:, self.histories // 2].transpose(1, 0, 2).astype(float)

    def sweep(self) -> Sweep:
        """What value iteration begins with, and the kernel that improves it."""
        return RelaxingSweep(self)

    @property
    def first_guess(self) -> Integers:  # made anew each time: with the levels it is large
        """A start of the search: the energy of the spring."""
        guess = np.ceil(self._spring_energy() * self.steps).astype(np.int64)
        shape = (self.domain.cells, self.histories, self.averages, len(self.nodes))
        return np.broadcast_to(guess[:, None, None, :], shape).copy()


class RelaxingSweep(Sweep):
    """V on the levels while it is improved; cycles that gain are met by following the best moves."""

    def __init__(self, grid: RelaxingGrid) -> None:
        first = grid.first_guess
        work = _MOVE * first.size * grid.width * grid.nodes.size
        super().__init__(first, THREADS, work, _MAX_ROUNDS[grid.approximation])
        self.grid = grid
        self._blocks = slices(0, grid.domain.cells, _BLOCKS)
        self._tables: tuple[Any, ...] = (
            *(grid.rows, *grid.all_forces, *grid.images, grid.costs, grid.nodes),
            *(grid.steps, grid.domain.reach, grid.approximation == "outer"),
        )

    def improve(self, pool: ThreadPoolExecutor, until: Until) -> int | None:
        """One round, block of cells by block."""
        before = self.value.copy()

        def done(block: tuple[int, int]) -> int | None:
            if until.effort.is_late():
                return None
            improved: int = sweep_relaxing(self.value, before, *block, *self._tables)
            return improved

        found = list(pool.map(done, self._blocks))
        counts = [count for count in found if count is not None]
        return sum(counts) if len(counts) == len(found) else None

    def gaining_cycle(self) -> tuple[Move, ...]:
        """The nodes of a cycle that gains, each with its cell; empty if none was met.

        The hand follows the best moves from a few states, with the average as it really
        becomes; wherever it comes back to a node, what it did since may be a cycle.
        """
        best: tuple[Move, ...] = ()
        most = 0.0
        random = np.random.default_rng(1)
        grid, delay, law = self.grid, self.grid.losses.delay, self.grid.relaxing_force
        lowest = grid.domain.lowest
        cells, _, levels, edges = self.value.shape
        frame = lowest, grid.readings[0], grid.levels, grid.steps, grid.domain.reach
        path = np.empty((_LONGEST, 2), np.int64)
        for _ in range(_STARTS):
            cell, node = int(random.integers(max(0, -lowest), cells)), int(random.integers(edges))
            start = cell, node, float(grid.readings[0] + random.integers(levels) / grid.levels)
            follow(law, self.value, start, delay, grid.nodes, grid.costs, frame, path)
            counts = path[:, 0] + lowest
            positions = counts * grid.steps + grid.nodes[path[:, 1]]
            gain, first, last = best_cycle(law, counts, positions, path @ [edges, 1], delay, grid.costs)
            if gain > most:
                most = gain
                best = tuple(zip(positions[first:last].tolist(), counts[first:last].tolist(), strict=True))
        return best
