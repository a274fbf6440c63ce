"""Laws in a chain as the simulator packs them, and as a table of all states that readings can lead to.

    s' = step(s, q'),   f = f(s)        s the count and the memory after a sample, to the bit

Behind an encoder a reading is a whole number of counts, and on a bounded grid there are finitely many.  Many
laws then remember one of finitely many things: those are found by stepping the simulator's own compiled law
from rest through every reading that may come next, until nothing new appears.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from math import ceil, floor
from typing import Any

import numpy as np
from numpy.typing import NDArray

from zwidth.errors import InputError
from zwidth.loop.kernel import after_every_reading, after_reading, scratch
from zwidth.loop.law import LIMIT, STEP
from zwidth.loop.setup import prepare
from zwidth.model.device.device import Device
from zwidth.model.environment.environment import Environment
from zwidth.model.operator import PrescribedMotion
from zwidth.model.specification.write import written
from zwidth.native.compiled import compiled
from zwidth.passivity.storage.domain import Domain, Integers
from zwidth.passivity.storage.grid import Grid
from zwidth.passivity.storage.law import FiniteLaw
from zwidth.passivity.storage.value_iteration import BestMoves, Move, Sweep

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class ChainLaw:
    """Laws in a chain as the simulator runs them."""

    packed: Floats  # the numbers of environment and laws, see `loop.law`
    resting: dict[int, Floats]  # what is remembered by a hand that has rested for ever, by count
    waiting: int  # forces that are kept, of which the oldest acts: one, and one more for each sample of delay
    description: str  # environment and laws, on one line
    specification: str  # device, environment and laws in TOML; empty where it has no words for them
    # as the environment
    clamped: bool
    unilateral: bool
    # whether force limit and converter steps of the actuator are counted in
    limited: bool
    stepped: bool

    @property
    def starts(self) -> dict[int, Floats]:
        """Memory, and no force waiting, of a hand that has rested for ever, by count."""
        return {n: np.concatenate([row, np.zeros(self.waiting)]) for n, row in self.resting.items()}


def chain_law(
    device: Device,
    environment: Environment,
    lowest: int,
    *,
    only: bool = False,
    force_limit: bool = False,
    force_resolution: bool = False,
) -> ChainLaw:
    """The law of laws in a chain in a device's loop.

    `device`, `environment`: without intervals; `lowest`: the first count of the grid: the hand begins at rest
    at any count from there to 0, or at 0 only where the environment has no surface; `only`: True for a hand
    that begins at `lowest` and nowhere else; `force_limit`, `force_resolution`: True to count in the
    actuator's force limit, the steps of its converter.
    """
    for counted, key in ((force_limit, "force_limit"), (force_resolution, "force_resolution")):
        if counted and getattr(device, key) is None:
            raise InputError(f"the actuator's {key} is to be counted in, but the device has none")
    delay = device.exact("delay") / device.exact("sample_period")
    if delay.denominator != 1:
        raise InputError(
            f"laws in a chain are looked at with delays of whole samples; this one is {float(delay):.6g}: "
            "the force would change within a sample"
        )
    first = min(lowest, 0) if environment.unilateral else 0
    resting = {}
    for count in (first,) if only else range(first, 1):
        middle = (count + 0.5) * float(device.exact("resolution"))
        hand = PrescribedMotion(np.full(2, middle))
        setup = prepare(device, environment, hand, device.exact("sample_period"))
        resting[count] = setup.memory.copy()
    packed = setup.law.copy()
    for counted, at in ((force_limit, LIMIT), (force_resolution, STEP)):
        packed[at] = packed[at] if counted else 0.0
    return ChainLaw(
        packed=packed,
        resting=resting,
        waiting=ceil(delay) + 1,
        description=environment.describe(device.motion),
        specification=_specification(device, environment),
        clamped=environment.clamped,
        unilateral=environment.unilateral,
        limited=force_limit,
        stepped=force_resolution,
    )


def _specification(device: Device, environment: Environment) -> str:
    """Device, environment and laws in TOML, or nothing."""
    try:
        return written(device, environment)
    except InputError:  # a law of one's own is in no other program
        return ""


MOST_STATES = 100_000
"""States that a law in a chain may have on its grid."""

_MOST_NUMBERS = 20_000_000  # numbers that all states together may remember
_AT_ONCE = 4_000_000  # numbers that are stepped at once


class DoesNotClose(InputError):
    """The law has more states on the grid than are looked at: it remembers too much."""


@dataclass(frozen=True, eq=False)
class Table:
    """The graph of a law in a chain on a grid."""

    # counts of the grid, and the largest difference of two successive readings
    lowest: int
    highest: int
    reach: int
    counts: Integers  # of each state
    # the state after each reading, by state and by how many counts it is further on, from −reach; −1 off the
    # grid
    successors: Integers
    forces: Floats  # what acts until the next sample [N; N·m]
    starts: Integers  # the states after the first sample of a hand that has rested

    @property
    def states(self) -> int:
        """How many there are."""
        return len(self.counts)

    def way(self, goal: int, most: int) -> list[int] | None:
        """The states through which a hand that has rested comes to one, by the fewest samples.

        It goes no more than `most` counts in each; None if it does not come there.
        """
        before = np.full(self.states, -1, np.int64)
        before[self.starts] = self.starts
        newest = np.unique(self.starts)
        most = min(most, self.reach)
        while before[goal] < 0:
            if len(newest) == 0:
                return None
            onward = self.successors[newest, self.reach - most : self.reach + most + 1]
            reached, first = np.unique(onward, return_index=True)
            origin = newest[first // onward.shape[1]]
            new = (reached >= 0) & (before[reached] < 0)
            before[reached[new]] = origin[new]
            newest = reached[new]
        states = [goal]
        while before[states[-1]] != states[-1]:
            states.append(int(before[states[-1]]))
        return states[::-1]


def tabulate(law: ChainLaw, domain: Domain, most: int = MOST_STATES) -> Table:
    """All states of a law on a grid."""
    known: dict[bytes, int] = {}
    found = _Found([], [])
    begun = []
    for count, row in law.starts.items():
        after_reading(law.packed, row, law.waiting, count, scratch())
        begun.append(found.numbered(known, np.array([count]), row[None, :])[0])
    successors: list[Integers] = []
    done = 0
    moves = np.arange(-domain.reach, domain.reach + 1)
    size = len(found.rows[0])
    most = min(most, _MOST_NUMBERS // (size + len(moves)))
    while done < len(found.rows):
        last = done + max(1, _AT_ONCE // (size * len(moves)))
        rows, counts = np.array(found.rows[done:last]), np.array(found.counts[done:last])
        done += len(rows)
        onward = np.zeros((len(rows), len(moves), rows.shape[1]))
        read = counts.astype(float)
        after_every_reading(
            law.packed, rows, read, law.waiting, domain.lowest, domain.highest, scratch(), onward
        )
        then = counts[:, None] + moves
        on_grid = (then >= domain.lowest) & (then <= domain.highest)
        reached = np.full(then.shape, -1, np.int64)
        reached[on_grid] = found.numbered(known, then[on_grid], onward[on_grid])
        successors.append(reached)
        if len(found.rows) > most:
            raise DoesNotClose(
                f"the law does not close within {most:,} states on {domain.cells} counts with moves of up to "
                f"{domain.reach}: it remembers too much to be tabulated; give a smaller penetration or speed"
            )
    forces = np.array(found.rows)[:, -law.waiting]
    if not np.isfinite(forces).all():
        raise InputError("the law gives a force that is no number: value iteration needs one in every state")
    counts = np.array(found.counts, np.int64)
    starts = np.array(begun, np.int64)
    return Table(
        domain.lowest, domain.highest, domain.reach, counts, np.concatenate(successors), forces, starts
    )


@dataclass
class _Found:
    """States in the order in which they were met."""

    rows: list[Floats]
    counts: list[int]

    def numbered(self, known: dict[bytes, int], counts: Integers, rows: Floats) -> Integers:
        """The number of each state; one that is new gets the next."""
        both = np.ascontiguousarray(np.column_stack([counts.astype(float), rows]))
        keys = both.view(np.dtype((np.void, both.itemsize * both.shape[1]))).ravel()
        _, first, inverse = np.unique(keys, return_index=True, return_inverse=True)
        numbers = np.empty(len(first), np.int64)
        for i in np.argsort(first):
            at = int(first[i])
            key = keys[at].tobytes()
            if key not in known:
                known[key] = len(self.rows)
                self.rows.append(rows[at].copy())
                self.counts.append(int(counts[at]))
            numbers[i] = known[key]
        out: Integers = numbers[inverse.ravel()]
        return out


# On the grid moves cost what they do on one of counts, outer or inner.  A state of the table is a vertex with
# a count and a force; within the count the hand stands on a node.


_MOVE = 2.5e-9  # what a move from a state costs in a round, in the unit of `effort`

NO_LAW = FiniteLaw((), "none")
"""In place of a law that can be written down: its forces stand in the table."""


@dataclass(frozen=True, kw_only=True)
class ChainGrid(Grid):
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
