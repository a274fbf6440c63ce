"""Value iteration on any grid: a storage function, or a cycle of moves that gains.

    V(s) ← max( V(s), max over moves of  −f Δx − cost(Δx) + V(s') )

until nothing improves, which is a storage function, or until the best moves close a
cycle, which then gains (Bellman and Ford).  All numbers are whole, so that "nothing
improves" is exact.

What differs from grid to grid is its sweep: the kernel that improves a part of V, and how
a gaining cycle is read from what the kernel leaves.
"""

from __future__ import annotations

import os
import time
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import partial
from itertools import pairwise
from math import inf
from typing import Any, Generic, Protocol, TypeVar

import numpy as np

from zwidth.errors import InputError
from zwidth.passivity.storage.losses import Integers
from zwidth.passivity.storage.solve.cycle import best_cycle

Progress = Callable[[int], None]
"""Told, after each round, how many states improved in it."""

Move = tuple[int, int]
"""A node, in steps from the lower edge of cell 0, and the cell or the state that it belongs to."""

THREADS = min(os.cpu_count() or 1, 8)

ALONE = 100_000
"""States up to which one thread iterates: several improve the same values in an order of their own, and then
the same grid may leave another motion each time."""

AT_ONCE = 20_000
"""States that are improved before the clock is looked at."""

_LOOK = 4
"""Rounds between two searches for a cycle: a search costs less than a round."""


class Sweep(ABC):
    """V on one grid while it is improved, and how.

    Parameters
    ----------
    value
        V at the start, in energy units; improved in place.
    threads
        How many improve it at once.
    max_rounds
        Rounds after which the search is given up.
    """

    def __init__(self, value: Integers, threads: int, max_rounds: float = inf) -> None:
        self.value, self.threads, self.max_rounds = value, threads, max_rounds

    @abstractmethod
    def jobs(self) -> Iterable[Callable[[], int]]:
        """One round: functions that improve a part of V each and return how many states improved."""

    @abstractmethod
    def gaining_cycle(self) -> tuple[Move, ...]:
        """The moves of a cycle that gains, if there is one among the best moves."""

    def improve(self, pool: ThreadPoolExecutor, deadline: float) -> int | None:
        """One round; returns how many states improved, None if the deadline came before its end."""

        def done(job: Callable[[], int]) -> int | None:
            return None if time.monotonic() >= deadline else job()

        found = list(pool.map(done, self.jobs()))
        return None if None in found else sum(count for count in found if count is not None)


class BestMoves(Sweep):
    """A sweep that keeps the best move of each state: a cycle that they close gains in every round.

    Parameters
    ----------
    value
        V at the start.
    groups
        Groups of states that are improved together.
    move_at
        The move of a state, by its flat index.
    kernel
        Called with V, the best moves, the first group and the last, and the tables.
    tables
        What does not change: forces, costs and where the nodes are.
    """

    def __init__(
        self,
        value: Integers,
        groups: int,
        move_at: Callable[[int], Move],
        kernel: Callable[..., int],
        tables: tuple[Any, ...],
    ) -> None:
        super().__init__(value, 1 if value.size <= ALONE else THREADS)
        self.choice = np.full(value.shape, -1, np.int64)
        self._parts = [
            partial(kernel, value, self.choice, first, last, *tables)
            for first, last in slices(groups, max(THREADS * 4, value.size // AT_ONCE))
        ]
        self._move_at = move_at

    def jobs(self) -> Iterable[Callable[[], int]]:
        """Parts that each take a fraction of a second."""
        return self._parts

    def gaining_cycle(self) -> tuple[Move, ...]:
        """The moves of a cycle among the best moves."""
        return tuple(map(self._move_at, best_cycle(self.choice)))


class Sweepable(Protocol):
    """What value iteration asks of a grid."""

    def sweep(self, backend: str) -> Sweep:
        """V at the start and what improves it, on the "cpu" or the "gpu"; InputError if not there."""


G = TypeVar("G", bound=Sweepable)


@dataclass(frozen=True)
class ValueIteration(Generic[G]):
    """How a value iteration ended.

    Parameters
    ----------
    grid
        On which it ran.
    value
        V of each state in energy units, if no motion gains.
    cycle
        Otherwise the moves of a motion that gains in every round; empty if the time ran out.
    rounds
        Sweeps over the grid.
    """

    grid: G
    value: Integers | None
    cycle: tuple[Move, ...]
    rounds: int


def value_iteration(
    grid: G, deadline: float = inf, progress: Progress | None = None, backend: str = "cpu"
) -> ValueIteration[G]:
    """Improve every state until a storage function or a gaining cycle is left.

    Parameters
    ----------
    grid
        The law, what moves cost, and the states.
    deadline
        When to give up, as `time.monotonic()`.
    progress
        Called after each round with the number of states that improved.
    backend
        "cpu", or "gpu" for a graphics card with CUDA.

    Raises
    ------
    InputError
        If `backend` is neither, the grid is not iterated there, or there is no card or no CUDA.
    """
    if backend not in ("cpu", "gpu"):
        raise InputError(f'backend is "cpu" or "gpu", got {backend!r}')
    sweep = grid.sweep(backend)
    rounds = 0
    with ThreadPoolExecutor(sweep.threads) as pool:
        while time.monotonic() < deadline and rounds < sweep.max_rounds:
            rounds += 1
            improved = sweep.improve(pool, deadline)
            if improved is None:
                break
            if progress is not None:
                progress(improved)
            if improved == 0:
                return ValueIteration(grid, sweep.value, (), rounds)
            if rounds % _LOOK == 0 and (moves := sweep.gaining_cycle()):
                return ValueIteration(grid, None, moves, rounds)
    return ValueIteration(grid, None, (), rounds)


def slices(items: int, parts: int) -> list[tuple[int, int]]:
    """So many parts of a number of items, first and last of each; none that is empty."""
    ends = np.linspace(0, items, parts + 1).astype(int).tolist()
    return [(first, last) for first, last in pairwise(ends) if first < last]
