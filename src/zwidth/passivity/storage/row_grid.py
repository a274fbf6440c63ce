"""The grid of laws in a chain: the states of their table, and nodes within each count.

Moves cost what they do on a grid of counts, outer or inner.  A state of the table is a vertex with a
count and a force; within the count the hand stands on a node.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from math import floor
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from zwidth.native.compiled import compiled
from zwidth.passivity.storage.domain import Integers
from zwidth.passivity.storage.grid import Grid
from zwidth.passivity.storage.law import FiniteLaw
from zwidth.passivity.storage.row_table import Table
from zwidth.passivity.storage.value_iteration import BestMoves, Move, Sweep

if TYPE_CHECKING:
    pass


_MOVE = 2.5e-9
"""What a move from a state costs in a round, in the unit of `effort`."""

NO_LAW = FiniteLaw((), "none")
"""In place of a law that can be written down: its forces stand in the table."""


@dataclass(frozen=True, kw_only=True)
class RowGrid(Grid):
    """A grid whose states are those of a table."""

    table: Table  # states, forces, and where each reading leads

    @property
    def _max_force(self) -> Fraction:
        drag = (
            self.losses.max_friction[1]
            / self.losses.period
            * (self.domain.reach + 1)
            * self.losses.resolution
        )
        return Fraction(float(np.abs(self.table.forces).max())) + drag

    @property
    def rounding(self) -> int:
        """Units by which a force may be off: it is rounded down once."""
        return 1

    def remembered(self, value: Integers) -> tuple[str, Any, NDArray[np.float64]]:
        """The least and the most over all that the law may remember."""
        counts = range(self.domain.lowest, self.domain.highest + 1)
        found = np.full((2, len(counts), self.nodes.size), np.nan)
        for i, count in enumerate(counts):
            here = value[self.table.counts == count]
            if len(here):
                found[:, i] = here.min(axis=0), here.max(axis=0)
        return "remembered", ["least", "most"], found

    def sweep(self) -> Sweep:
        """What value iteration begins with, and the kernel that improves it."""
        tables = self.table.successors, self.forces, self.costs, self.nodes
        moves = self.table.successors.shape[1] * self.nodes.size
        return BestMoves(
            self.first_guess.copy(), self.table.states, self.move_at, sweep_table, tables, _MOVE * moves
        )

    def move_at(self, state: int) -> Move:
        """The node, in steps from the lower edge of cell 0, and the state of the table."""
        row, node = divmod(state, self.nodes.size)
        return int(self.table.counts[row]) * self.steps + int(self.nodes[node]), row

    @cached_property
    def forces(self) -> Integers:
        """Force in units of each state."""
        several, where = np.unique(self.table.forces, return_inverse=True)
        units = np.array([floor(Fraction(float(f)) / self.force_unit) for f in several], dtype=np.int64)
        out: Integers = units[where.ravel()]
        return out

    @cached_property
    def first_guess(self) -> Integers:
        """Nothing."""
        return np.zeros((self.table.states, self.nodes.size), np.int64)


# One sweep over the states of a table.
#
#     V(s, x) ← max( V(s, x), max over x' of  −f(s) d − C(d) + V(s', x') )
#
# s' is where the reading of x' leads from s.


@compiled
def sweep_table(
    value: Integers,
    choice: Integers,
    first: int,
    last: int,
    successors: Integers,
    forces: Integers,
    costs: Integers,
    nodes: Integers,
) -> int:
    """Improve the states first … last − 1; returns how many nodes improved.

    value and choice are (states, nodes); choice holds the flat index of the best move.
    """
    width, edges = successors.shape[1], nodes.size
    reach, steps = width // 2, nodes[edges - 1]
    improved = 0
    for s in range(first, last):
        force = forces[s]
        for j in range(edges):
            best, goal = value[s, j], -1
            for move in range(width):
                then = successors[s, move]
                if then < 0:
                    continue
                way = (move - reach) * steps - nodes[j]
                for j2 in range(edges):
                    d = way + nodes[j2]
                    far = abs(d)
                    if far < costs.size:
                        worth = value[then, j2] - force * d - costs[far]
                        if worth > best:
                            best, goal = worth, then * edges + j2
            if goal >= 0:
                value[s, j], choice[s, j] = best, goal
                improved += 1
    return improved
