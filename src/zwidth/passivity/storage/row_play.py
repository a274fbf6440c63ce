"""The game against laws in a row: Bellman and Ford over the states of a table.

    V(s, x) ← max( V(s, x), max over x' of  −f(s) d − C(d) + V(s', x') )

s' is where the reading of x' leads from s.  As in `solve` all numbers are whole, and the game
ends with a storage function, or with best moves that close a cycle.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import partial

import numpy as np

from zwidth.compiled import compiled
from zwidth.passivity.storage.board import Integers
from zwidth.passivity.storage.row_board import RowBoard
from zwidth.passivity.storage.solve import Played, in_time, slices, threads_for
from zwidth.passivity.storage.sweep import best_cycle

_LOOK = 4
"""Rounds between two searches for a cycle."""


def play_row(
    board: RowBoard, deadline: float = float("inf"), progress: Callable[[int], None] | None = None
) -> Played:
    """Improve every state until a storage function or a gaining cycle is left; as `solve.play`.

    A cycle's moves are pairs of a knot, in steps from the lower edge of cell 0, and a state.
    """
    value = board.first_guess.copy()
    choice = np.full(value.shape, -1, np.int64)
    parts = slices(len(value), value.size)
    tables = board.table.successors, board.forces, board.costs, board.knots
    rounds = 0
    with ThreadPoolExecutor(threads_for(value)) as pool:
        while time.monotonic() < deadline:
            rounds += 1
            jobs = [partial(sweep_row, value, choice, *tables, first, last) for first, last in parts]
            improved = in_time(pool, deadline, jobs)
            if improved is None:
                break
            if progress is not None:
                progress(improved)
            if improved == 0:
                return Played(board, value, (), rounds)
            if rounds % _LOOK == 0:
                moves = _gaining(board, choice)
                if moves:
                    return Played(board, None, moves, rounds)
    return Played(board, None, (), rounds)


@compiled
def sweep_row(
    value: Integers,
    choice: Integers,
    successors: Integers,
    forces: Integers,
    costs: Integers,
    knots: Integers,
    first: int,
    last: int,
) -> int:
    """Improve the states first … last − 1; returns how many knots improved.

    value and choice are (states, knots); choice holds the flat index of the best move.
    """
    width, edges = successors.shape[1], knots.size
    reach, steps = width // 2, knots[edges - 1]
    improved = 0
    for s in range(first, last):
        force = forces[s]
        for j in range(edges):
            best, goal = value[s, j], -1
            for move in range(width):
                then = successors[s, move]
                if then < 0:
                    continue
                way = (move - reach) * steps - knots[j]
                for j2 in range(edges):
                    d = way + knots[j2]
                    far = abs(d)
                    if far < costs.size:
                        worth = value[then, j2] - force * d - costs[far]
                        if worth > best:
                            best, goal = worth, then * edges + j2
            if goal >= 0:
                value[s, j], choice[s, j] = best, goal
                improved += 1
    return improved


def _gaining(board: RowBoard, choice: Integers) -> tuple[tuple[int, int], ...]:
    """The moves of a cycle among the best moves, if there is one."""
    moves = []
    for at in best_cycle(choice):
        state, knot = divmod(at, choice.shape[1])
        moves.append((int(board.table.counts[state]) * board.steps + int(board.knots[knot]), state))
    return tuple(moves)
