"""The game with a relaxing law played out: a storage function, or a cycle that may gain."""

from __future__ import annotations

import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from itertools import pairwise

import numpy as np

from zwidth.passivity.storage.board import Integers
from zwidth.passivity.storage.relaxing import RelaxingBoard, sweep_relaxing
from zwidth.passivity.storage.solve import THREADS, Played, in_time

_LOOK = 4
"""Rounds between two searches for a cycle."""

_STARTS = 12
"""States from which the best moves are followed in one search."""

_LONGEST = 160
"""Moves that are followed."""

_BLOCKS = 8
"""Blocks of cells, each improved by one thread from what the others were before the round: as many on every
machine, so that a game ends the same way on each.  (What is raised between levels depends on the order.)"""

_UNENDING = {"generous": 300, "strict": 60}
"""Rounds after which the search is given up: energy that only trickles in from level to level."""


def play_relaxing(
    board: RelaxingBoard, deadline: float = float("inf"), progress: Callable[[int], None] | None = None
) -> Played:
    """Improve every state until a storage function is left, or the best moves make a cycle that gains.

    Parameters
    ----------
    board
        The rules, the law and the domain.
    deadline
        When to give up, as `time.monotonic()`.
    progress
        Called after each round with the number of states that improved.
    """
    value = board.relaxing_guess
    inwards, outwards = board.all_forces
    tables = (board.rows, inwards, outwards, *board.images, board.costs, board.knots, board.steps)
    ends = np.linspace(0, board.domain.cells, _BLOCKS + 1).astype(int).tolist()
    parts = [(first, last) for first, last in pairwise(ends) if first < last]
    generous = board.rules == "generous"
    rounds = 0
    with ThreadPoolExecutor(THREADS) as pool:
        while time.monotonic() < deadline and rounds < _UNENDING[board.rules]:
            rounds += 1
            before = value.copy()
            jobs = [
                partial(sweep_relaxing, value, before, *tables, first, last, board.domain.reach, generous)
                for first, last in parts
            ]
            improved = in_time(pool, deadline, jobs)
            if improved is None:
                break
            if progress is not None:
                progress(improved)
            if improved == 0:
                return Played(board, value, (), rounds)
            if rounds % _LOOK == 0:
                moves = _gaining(board, value)
                if moves:
                    return Played(board, None, moves, rounds)
    return Played(board, None, (), rounds)


def _gaining(board: RelaxingBoard, value: Integers) -> tuple[tuple[int, int], ...]:
    """The knots of a cycle that gains, each with its cell; empty if none was met.

    The hand follows the best moves from a few states, with the average as it really
    becomes; wherever it comes back to a knot, what it did since may be a cycle.
    """
    best: tuple[tuple[int, int], ...] = ()
    most = 0.0
    random = np.random.default_rng(1)
    for _ in range(_STARTS):
        path = _followed(board, value, random)
        seen: dict[tuple[int, int], list[int]] = {}
        for k, place in enumerate(path):
            for before in seen.get(place, ())[-3:]:
                moves = path[before:k]
                gain = _settled_gain(board, moves) if len(moves) > 1 else 0.0
                if gain > most:
                    best, most = tuple(moves), gain
            seen.setdefault(place, []).append(k)
    return best


def _followed(board: RelaxingBoard, value: Integers, random: np.random.Generator) -> list[tuple[int, int]]:
    """Knots and cells along the best moves from a state drawn at random."""
    cells, _, levels, edges = value.shape
    low, reach = board.readings[0], board.domain.reach
    law, delay, pole = board.law, board.losses.delay, float(board.pole)
    spring = float(law.taps[0] * board.losses.resolution / board.force_unit)
    branch = float(board.branch_unit * board.levels)
    readings = [int(random.integers(max(0, -board.domain.lowest), cells))] * (delay + 1)
    knot = int(random.integers(edges))
    average = float(low + random.integers(levels) / board.levels)
    path: list[tuple[int, int]] = []
    for _ in range(_LONGEST):
        n, felt = readings[0], readings[-1] + board.domain.lowest
        count = n + board.domain.lowest
        path.append((count * board.steps + int(board.knots[knot]), count))
        u = max(felt, 0) if law.surface == "penetration" else felt
        force = spring * u + branch * (u - average)
        force = max(force, 0.0) if law.clamped else force
        force = force if law.surface == "none" or felt > 0 else 0.0
        average = 0.0 if law.resets and u <= 0 else pole * average + (1 - pole) * u
        level = min((average - low) * board.levels, levels - 1.0)
        below = min(int(level), levels - 2)
        first, last = max(0, n - reach), min(cells - 1, n + reach)
        goals = np.arange(first, last + 1)
        columns = _columns(board, goals, readings)
        lower, upper = value[goals, columns, below], value[goals, columns, below + 1]
        there = lower + (upper - lower) * (level - below)
        d = (goals - n)[:, None] * board.steps + board.knots[None, :] - board.knots[knot]
        far = np.minimum(np.abs(d), len(board.costs) - 1)
        worth = there - board.costs[far] - force * d
        worth[np.abs(d) >= len(board.costs)] = -np.inf
        row, knot = (int(v) for v in np.unravel_index(int(worth.argmax()), worth.shape))
        readings = [int(goals[row]), *readings[:-1]] if delay else [int(goals[row])]
    return path


def _columns(board: RelaxingBoard, goals: Integers, readings: list[int]) -> Integers:
    """The history of each goal: differences of the readings before it."""
    column = np.zeros_like(goals)
    newer = goals
    for reading in readings[: board.losses.delay]:
        column = column * board.width + (reading - newer + board.domain.reach)
        newer = np.full_like(goals, reading)
    return column


def _settled_gain(board: RelaxingBoard, moves: list[tuple[int, int]]) -> float:
    """What a cycle gains in each round when the law has settled to it, in energy units."""
    law, size = board.law, len(moves)
    pole = float(board.pole)
    u = np.array([max(cell, 0) if law.surface == "penetration" else cell for _, cell in moves], dtype=float)
    keeps = np.array([0.0 if law.resets and v <= 0 else 1.0 for v in u])
    scale, shift = 1.0, 0.0  # of one round: a → scale a + shift
    for v, keep in zip(u, keeps, strict=True):
        scale, shift = scale * pole * keep, (shift * pole + (1 - pole) * v) * keep
    a = shift / (1 - scale)
    unit = float(board.losses.resolution / board.force_unit)
    spring, branch = float(law.taps[0]) * unit, float(board.branch_unit * board.levels)
    forces = np.zeros(size)
    for k in range(size):
        f = spring * u[k] + branch * (u[k] - a)
        f = max(f, 0.0) if law.clamped else f
        forces[k] = f if law.surface == "none" or moves[k][1] > 0 else 0.0
        a = (pole * a + (1 - pole) * u[k]) * keeps[k]
    forces = np.roll(forces, board.losses.delay)
    x = np.array([knot for knot, _ in moves])
    d = np.roll(x, -1) - x
    far = np.abs(d)
    return float(-(forces * d).sum() - board.costs[far].sum()) if far.max() < len(board.costs) else 0.0
