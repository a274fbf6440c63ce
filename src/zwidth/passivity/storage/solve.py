"""The game played out: a storage function, or a cycle of moves that gains.

Bellman and Ford: improve every state until nothing improves, which is a storage
function, or until the best moves close a cycle, which then gains.  All numbers
are whole, so that "nothing improves" is exact.
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import partial
from itertools import pairwise
from typing import Any

import numpy as np

from zwidth.errors import InputError
from zwidth.passivity.storage.board import Board, Integers
from zwidth.passivity.storage.coarse_board import CoarseBoard, sweep_line, sweep_line_parts
from zwidth.passivity.storage.gpu import OnCard
from zwidth.passivity.storage.parts import sweep_parts, sweep_turning
from zwidth.passivity.storage.sweep import best_cycle, sweep

Tell = Callable[[int], None]

THREADS = min(os.cpu_count() or 1, 8)

ALONE = 100_000
"""States up to which one thread plays: several improve the same values in an order of their own, and then the
same game may end in another motion each time."""

AT_ONCE = 20_000
"""States that are improved before the clock is looked at."""

_LOOK = 4
"""Rounds between two searches for a cycle: a search costs less than a round."""


@dataclass(frozen=True)
class Played:
    """How a game ended.

    Parameters
    ----------
    board
        What was played.
    value
        V of each cell, history and knot in energy units, if no motion gains.
    cycle
        Otherwise the moves of a motion that gains in every round: knots, in steps
        from the lower edge of cell 0, each with its cell; both empty if the time ran out.
    rounds
        Sweeps over the board.
    """

    board: Board
    value: Integers | None
    cycle: tuple[tuple[int, int], ...]
    rounds: int


def play(
    board: Board,
    deadline: float = float("inf"),
    progress: Callable[[int], None] | None = None,
    on: str = "cpu",
) -> Played:
    """Improve every state until a storage function or a gaining cycle is left.

    Parameters
    ----------
    board
        The rules, the law and the domain.
    deadline
        When to give up, as `time.monotonic()`.
    progress
        Called after each round with the number of states that improved.
    on
        "cpu", or "gpu" for a graphics card with CUDA.

    Raises
    ------
    InputError
        If `on` is neither, or there is no card or no CUDA.
    """
    if on not in ("cpu", "gpu"):
        raise InputError(f'on is "cpu" or "gpu", got {on!r}')
    if on == "gpu" and (board.losses.part < 1 or board.losses.curve is not None):
        raise InputError(
            "delays of part of a sample and friction curves are played on the processor: leave out on"
        )
    value = board.first_guess.copy()
    choice = np.full(value.shape, -1, np.int64)
    card = OnCard(board, value, choice) if on == "gpu" else None
    rounds = 0
    with ThreadPoolExecutor(threads_for(value)) as pool:
        while time.monotonic() < deadline:
            rounds += 1
            improved = _round(pool, board, value, choice, deadline) if card is None else card.round()
            if improved is None:
                break
            if progress is not None:
                progress(improved)
            if card is not None and (improved == 0 or rounds % _LOOK == 0):
                card.fetch()
            if improved == 0:
                return Played(board, value, (), rounds)
            if rounds % _LOOK == 0:
                moves = _gaining(board, choice)
                if moves:
                    return Played(board, None, moves, rounds)
    return Played(board, None, (), rounds)


def threads_for(value: Integers) -> int:
    """How many threads play a board."""
    return 1 if value.size <= ALONE else THREADS


def in_time(pool: ThreadPoolExecutor, deadline: float, jobs: Iterable[Callable[[], int]]) -> int | None:
    """What all jobs improve together; None if the deadline came before the last of them had begun."""

    def done(job: Callable[[], int]) -> int | None:
        return None if time.monotonic() >= deadline else job()

    found = list(pool.map(done, jobs))
    return None if None in found else sum(count for count in found if count is not None)


def slices(items: int, states: int) -> list[tuple[int, int]]:
    """The groups of a board, first and last, in parts that each take a fraction of a second."""
    parts = max(THREADS * 4, states // AT_ONCE)
    ends = np.linspace(0, items, parts + 1).astype(int).tolist()
    return [(first, last) for first, last in pairwise(ends) if first < last]


def _round(
    pool: ThreadPoolExecutor, board: Board, value: Integers, choice: Integers, deadline: float
) -> int | None:
    """Improve every state, on all threads; returns how many improved, None if the time ran out."""
    groups = len(value) * (board.histories // board.width if board.memory else 1)
    tables: tuple[Any, ...] = board.forces, board.costs, board.knots, board.steps
    improve: Callable[..., int] = partial(sweep, squares=board.losses.curve is None)
    if isinstance(board, CoarseBoard):
        tables = board.forces, board.costs, board.places
        improve = sweep_line
        if board.losses.part < 1:
            tables, improve = (*tables, board.later_forces, board.later_costs), sweep_line_parts
    elif board.losses.part < 1:
        tables, improve = (*tables, board.later_forces, board.later_costs), sweep_parts
        if board.every > 1:
            improve = partial(sweep_turning, **_turning(board))
    jobs = [
        partial(improve, value, choice, *tables, first, last, board.domain.reach)
        for first, last in slices(groups, value.size)
    ]
    return in_time(pool, deadline, jobs)


def _turning(board: Board) -> dict[str, Any]:
    """Where a hand turns within a sample, in steps and force units; of no use without damping."""
    losses, domain = board.losses, board.domain
    step = losses.resolution / board.steps
    swing = losses.period / (2 * losses.damping) * losses.part * (1 - losses.part) if losses.damping else 0
    top = domain.highest + 1 if domain.deepest is None else domain.deepest
    return {
        "part": float(losses.part),
        "swing": float(swing * board.force_unit / step),
        "friction": int(losses.coulomb_friction / board.force_unit),
        "deepest": int((top - domain.lowest) * board.steps),
    }


def _gaining(board: Board, choice: Integers) -> tuple[tuple[int, int], ...]:
    """The moves of a cycle among the best moves, if there is one."""
    moves = []
    for state in best_cycle(choice):
        cell, _, knot = np.unravel_index(state, choice.shape)
        count = int(cell) + board.domain.lowest
        moves.append((count * board.steps + int(board.knots[knot]), count))
    return tuple(moves)
