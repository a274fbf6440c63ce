"""The game played out: a storage function, or a cycle of moves that gains.

Bellman and Ford: improve every state until nothing improves, which is a storage
function, or until the best moves close a cycle, which then gains.  All numbers
are whole, so that "nothing improves" is exact.
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import partial

import numpy as np

from zwidth.errors import InputError
from zwidth.passivity.worst_hand.board import Board, Integers
from zwidth.passivity.worst_hand.gpu import OnCard
from zwidth.passivity.worst_hand.parts import sweep_parts
from zwidth.passivity.worst_hand.sweep import best_cycle, sweep

THREADS = min(os.cpu_count() or 1, 8)

ALONE = 100_000
"""States up to which one thread plays: several improve the same values in an order of their own, and then the
same game may end in another motion each time."""

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
            improved = _round(pool, board, value, choice) if card is None else card.round()
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


def _round(pool: ThreadPoolExecutor, board: Board, value: Integers, choice: Integers) -> int:
    """Improve every state, on all threads; returns how many improved."""
    groups = len(value) * (board.histories // board.width if board.memory else 1)
    parts = np.linspace(0, groups, THREADS * 4 + 1).astype(int)
    tables: tuple[Integers, ...] = board.forces, board.costs, board.knots
    improve: Callable[..., int] = partial(sweep, squares=board.losses.curve is None)
    if board.losses.part < 1:
        tables, improve = (*tables, board.later_forces, board.later_costs), sweep_parts
    jobs = [
        pool.submit(improve, value, choice, *tables, first, last, board.domain.reach)
        for first, last in zip(parts[:-1], parts[1:], strict=True)
        if first < last
    ]
    return sum(job.result() for job in jobs)


def _gaining(board: Board, choice: Integers) -> tuple[tuple[int, int], ...]:
    """The moves of a cycle among the best moves, if there is one."""
    moves = []
    for state in best_cycle(choice):
        cell, _, knot = np.unravel_index(state, choice.shape)
        count = int(cell) + board.domain.lowest
        moves.append((count * board.steps + int(board.knots[knot]), count))
    return tuple(moves)
