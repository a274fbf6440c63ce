"""Value iteration on any grid: a storage function, or a cycle of moves that gains; and how much it may do.

    V(s) ← max( V(s), max over moves of  −f Δx − cost(Δx) + V(s') )

until nothing improves, which is a storage function, or until the best moves close a cycle, which then gains
(Bellman and Ford).  All numbers are whole, so that "nothing improves" is exact.

What differs from grid to grid is its sweep: the kernel that improves a part of V, and how
a gaining cycle is read from what the kernel leaves.
"""

from __future__ import annotations

import os
import time
from abc import ABC, abstractmethod
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from itertools import pairwise
from math import inf
from typing import Any, Generic, NamedTuple, Protocol, TypeVar

import numpy as np

from zwidth.errors import InputError
from zwidth.native.compiled import compiled
from zwidth.passivity.storage.domain import Integers

Progress = Callable[[int], None]
"""Told, after each round, how many states improved in it."""

Move = tuple[int, int]
"""A node, in steps from the lower edge of cell 0, and the cell or the state that it belongs to."""

THREADS = min(os.cpu_count() or 1, 8)

ALONE = 100_000
"""States up to which a grid is one block: more of them cost rounds."""

BLOCKS = 8
"""Of a larger grid, improved side by side, however many threads there are: another number, another motion."""

AT_ONCE = 20_000
"""States that are improved before the clock is looked at, where time may end a search."""

ROUND = 3e-4
"""What a round costs beside its states, in the unit of `effort`."""

_LOOK = 4  # rounds between two searches for a cycle: a search costs less than a round


class Sweep(ABC):
    """V on one grid while it is improved, and how.

    `value`: V at the start, in energy units; improved in place; `threads`: how many improve it at once;
    `work`: what a round costs, in the unit of `effort`; `max_rounds`: rounds after which the search is given
    up.
    """

    def __init__(self, value: Integers, threads: int, work: float, max_rounds: float = inf) -> None:
        self.value, self.threads, self.max_rounds = value, threads, max_rounds
        self.work = ROUND + work

    @abstractmethod
    def improve(self, pool: ThreadPoolExecutor, until: Until) -> int | None:
        """One round; returns how many states improved, None if the time was over before its end."""

    @abstractmethod
    def gaining_cycle(self) -> tuple[Move, ...]:
        """The moves of a cycle that gains, if there is one among the best moves."""


class BestMoves(Sweep):
    """A sweep that keeps the best move of each state: a cycle that they close gains in every round.

    A large grid is cut into blocks.  Each is improved on values of its own, those of the others as they were
    before the round, so that no order of threads is seen in what is found.  The values of a round lie between
    those before it and those after it; so a cycle of best moves still gains: around one that did not, each
    state would have been improved after the next one in the same block.

    `value`: V at the start; `groups`: groups of states that are improved together; `move_at`: the move of a
    state, by its flat index; `kernel`: called with V, the best moves, the first group and the last, and the
    tables; `tables`: what does not change: forces, costs and where the nodes are; `work`: what a state costs
    in a round, in the unit of `effort`.
    """

    def __init__(
        self,
        value: Integers,
        groups: int,
        move_at: Callable[[int], Move],
        kernel: Callable[..., int],
        tables: tuple[Any, ...],
        work: float,
    ) -> None:
        blocks = 1 if value.size <= ALONE else BLOCKS
        super().__init__(value, min(blocks, THREADS), work * value.size)
        self.choice = np.full(value.shape, -1, np.int64)
        self._blocks = slices(0, groups, blocks)
        self._in_a_group = value.size // groups
        self._kernel, self._tables = kernel, tables
        self._move_at = move_at

    def improve(self, pool: ThreadPoolExecutor, until: Until) -> int | None:
        """One round, block by block."""
        if len(self._blocks) == 1:
            return self._improved(self.value, self._blocks[0], until)

        def done(block: tuple[int, int]) -> tuple[int | None, Integers]:
            own = self.value.copy()
            improved = self._improved(own, block, until)
            return improved, own.reshape(-1)[self._states(block)].copy()

        found = list(pool.map(done, self._blocks))
        for block, (_, own) in zip(self._blocks, found, strict=True):
            self.value.reshape(-1)[self._states(block)] = own
        counts = [count for count, _ in found if count is not None]
        return sum(counts) if len(counts) == len(found) else None

    def _improved(self, value: Integers, block: tuple[int, int], until: Until) -> int | None:
        """How many states of a block improved, piece by piece; None if the time was over before its end."""
        first, last = block
        improved = 0
        for piece in slices(first, last, 1 + (last - first) * self._in_a_group // AT_ONCE):
            if until.effort.is_late():
                return None
            improved += self._kernel(value, self.choice, *piece, *self._tables)
        return improved

    def _states(self, block: tuple[int, int]) -> slice:
        first, last = block
        return slice(first * self._in_a_group, last * self._in_a_group)

    def gaining_cycle(self) -> tuple[Move, ...]:
        """The moves of a cycle among the best moves."""
        return tuple(map(self._move_at, best_cycle(self.choice)))


class Sweepable(Protocol):
    """What value iteration asks of a grid."""

    def sweep(self) -> Sweep:
        """V at the start and what improves it."""


G = TypeVar("G", bound=Sweepable)


@dataclass(frozen=True)
class ValueIteration(Generic[G]):
    """How a value iteration ended."""

    grid: G  # on which it ran
    value: Integers | None  # V of each state in energy units, if no motion gains
    # otherwise the moves of a motion that gains in every round; empty if the time ran out
    cycle: tuple[Move, ...]
    rounds: int  # sweeps over the grid


def value_iteration(
    grid: G, until: Until | None = None, progress: Progress | None = None
) -> ValueIteration[G]:
    """Improve every state until a storage function or a gaining cycle is left.

    `grid`: the law, what moves cost, and the states; `until`: when to give up; None: never; `progress`:
    called after each round with the number of states that improved.
    """
    sweep = grid.sweep()
    limit = freely() if until is None else until
    rounds = 0
    with ThreadPoolExecutor(sweep.threads) as pool:
        while not limit.is_over and rounds < sweep.max_rounds:
            rounds += 1
            improved = sweep.improve(pool, limit)
            limit.effort.spend(sweep.work)
            if improved is None:
                break
            if progress is not None:
                progress(improved)
            if improved == 0:
                return ValueIteration(grid, sweep.value, (), rounds)
            if rounds % _LOOK == 0 and (moves := sweep.gaining_cycle()):
                return ValueIteration(grid, None, moves, rounds)
    return ValueIteration(grid, None, (), rounds)


def slices(first: int, last: int, parts: int) -> list[tuple[int, int]]:
    """So many parts of the items first … last − 1, ends of each as of those; none that is empty."""
    ends = np.linspace(first, last, parts + 1).astype(int).tolist()
    return [(begin, end) for begin, end in pairwise(ends) if begin < end]


def best_cycle(choice: Integers) -> list[int]:
    """The states of a cycle among the best moves, as flat indices; empty if there is none."""
    flat = choice.reshape(-1)
    start = cycle(flat, np.zeros(flat.size, np.int64))
    if start < 0:
        return []
    states, at = [start], int(flat[start])
    while at != start:
        states.append(at)
        at = int(flat[at])
    return states


@compiled
def cycle(choice: Integers, mark: Integers) -> int:
    """A state on a cycle of chosen moves, or −1; `choice` and the scratch `mark` (zeros) are flat."""
    for start in range(choice.size):
        if choice[start] < 0 or mark[start] != 0:
            continue
        v = start
        while v >= 0 and mark[v] == 0:
            mark[v] = start + 1
            v = choice[v]
        if v >= 0 and mark[v] == start + 1:
            return int(v)
    return -1


# Work is counted in the place of time, so that a search ends alike on every machine.  One unit is about what
# one core of an ordinary processor does in a second; what a round of values costs is counted from the size of
# its grid.  A busy machine takes longer, and finds the same to the last bit.  Time may end a search as well
# where a person asks for it; then it is said that it did.


EFFORT = 60.0
"""Of a limit, or of the available storage of one loop; about as many seconds."""


class Effort:
    """What was done so far, and when the time is over.

    `seconds`: after which it is [s]; inf: never.
    """

    def __init__(self, seconds: float = inf) -> None:
        self.spent = 0.0
        self.is_cut = False
        self._end = inf if seconds == inf else time.monotonic() + seconds

    def __call__(self) -> float:
        """What was done, as a clock would have the time; inf once the time is over."""
        return inf if self.is_late() else self.spent

    def is_late(self) -> bool:
        """Whether the time is over; where one has asked and it was, the search is cut."""
        if self._end < inf and time.monotonic() >= self._end:
            self.is_cut = True
        return self.is_cut

    def spend(self, work: float) -> None:
        """So much more was done."""
        self.spent += work


class Until(NamedTuple):
    """How far a part of a search may go."""

    effort: Effort  # that of the whole
    most: float  # of it, when this part has to end

    @property
    def is_over(self) -> bool:
        """Whether it has to end."""
        return self.effort() >= self.most


def freely() -> Until:
    """As far as it goes."""
    return Until(Effort(), inf)


def checked_effort(effort: float) -> float:
    """How much may be done."""
    if isinstance(effort, bool) or not isinstance(effort, int | float) or not effort >= 0:
        raise InputError(
            f"effort must be a number ≥ 0, got {effort!r}: it is how much may be tried, 1 being about a "
            "second of one core"
        )
    return float(effort)


def time_limit(seconds: float | None) -> float:
    """The time that a search may take [s]; inf where none is given."""
    if seconds is None:
        return inf
    if not isinstance(seconds, int | float) or not seconds >= 0:
        raise InputError(f"seconds must be a number ≥ 0, got {seconds!r}: it is the time that may pass")
    return float(seconds)
