"""All moves of many states at once, beside one state and one move at a time."""

from __future__ import annotations

from itertools import product
from typing import Any

import numpy as np
import pytest

from zwidth.checker.storage import domain, moves


def one_by_one(value: Any, state: Any, goals: Any, parts: Any) -> bool:
    """Whether some move brings more than it costs: goals and places by place, parts the last first."""
    for force, costs in parts[:0:-1]:
        goals = {m: most(goals, m, force, costs) for m in goals}
    force, costs = parts[0]
    return bool(value < most(goals, state, force, costs))


def most(goals: Any, at: int, force: int, costs: Any) -> Any:
    """Of all moves from one place."""
    within = (p for p in goals if abs(p - at) < len(costs))
    return max((goals[p] - force * (p - at) - costs[abs(p - at)] for p in within), default=-np.inf)


def first(bad: Any) -> int:
    """The first place of many where something is wrong."""
    return int(np.argmax(bad)) if np.any(bad) else -1


def board(rng: Any, line: bool, memory: int) -> Any:
    """Of a few cells, states missing here and there; small numbers, so that many sums are equal."""
    cells, reach = int(rng.integers(1, 6)), int(rng.integers(1, 4))
    nodes = 1 if line else int(rng.integers(2, 5))
    histories = (2 * reach + 1) ** memory
    forces = rng.integers(-3, 4, (2, cells, histories))
    forces[1] = np.repeat(forces[1][:, :: 2 * reach + 1], 2 * reach + 1, axis=1) if memory else 0
    inside = int(rng.integers(0, cells + 1)) if line else 0
    value = rng.integers(0, rng.choice((1, 2, 4)), (cells, histories, nodes)) + rng.integers(0, 30)
    return value, rng.random((cells, histories)) < 0.9, forces, inside, reach


def costs_of(rng: Any, far: int) -> Any:
    """Up to some distance, from a little below 0 on."""
    size = rng.integers(0, far + 1)
    return np.concatenate([[0], rng.integers(-1, 6, size) + rng.integers(0, 6) * np.arange(size)])


def following(n: int, h: int, cells: int, reach: int, memory: int) -> Any:
    """The cells that may follow, and the history then."""
    width = 2 * reach + 1
    for then in range(max(0, n - reach), min(cells, n + reach + 1)):
        yield then, (n - then + reach) * width ** (memory - 1) + h // width if memory else 0


@pytest.mark.parametrize("line", [False, True])
@pytest.mark.parametrize(("memory", "parts"), [(0, 1), (1, 1), (2, 1), (1, 2), (2, 2)])
def test_the_first_state_that_stores_too_little(line: bool, memory: int, parts: int, monkeypatch: Any) -> None:
    """On cells of one force, and on a line whose surface stands there twice; in blocks of any size."""
    rng, found = np.random.default_rng(memory), set()
    for trial in range(60):
        value, exists, forces, inside, reach = board(rng, line, memory)
        cells, histories, nodes = value.shape
        step = max(1, nodes - 1)
        told = [(forces[p], costs_of(rng, reach * step)) for p in range(parts)]
        bad = np.zeros(value.shape, np.bool_)
        for n, h in product(range(cells), range(histories)):
            goals: dict[int, int] = {}
            for then, after in following(n, h, cells, reach, memory):
                for j, there in enumerate(value[then, after], (then - n) * step + (n >= inside) - (then >= inside)):
                    goals[j] = max(there, goals.get(j, 0))
            for j in range(nodes):
                each = [(f[n, h], costs) for f, costs in told]
                bad[n, h, j] = exists[n, h] and one_by_one(value[n, h, j], j, goals, each)
        monkeypatch.setattr(domain, "AT_ONCE", 1 << trial % 9)
        monkeypatch.setattr(domain, "ROOM", 1 << trial % 11)
        found.add(first(bad))
        assert moves.first_violation(value, exists, told, inside, reach) == first(bad), trial
    assert -1 in found
    assert len(found) > 3


def test_the_first_state_of_a_table_that_stores_too_little() -> None:
    """Successors are any states, or none."""
    rng, found = np.random.default_rng(7), set()
    for trial in range(60):
        states, reach, nodes = int(rng.integers(1, 9)), int(rng.integers(1, 4)), int(rng.integers(2, 5))
        value = rng.integers(0, rng.choice((1, 2, 4)), (states, nodes)) + rng.integers(0, 30)
        successors = rng.integers(-1, states, (states, 2 * reach + 1))
        forces, costs = rng.integers(-3, 4, states), costs_of(rng, reach * (nodes - 1))
        bad = np.zeros(value.shape, np.bool_)
        for s, j in product(range(states), range(nodes)):
            goals: dict[int, int] = {}
            for move, then in enumerate(successors[s], -reach):
                for k, there in enumerate(value[then] if then >= 0 else (), move * (nodes - 1)):
                    goals[k] = max(there, goals.get(k, 0))
            bad[s, j] = one_by_one(value[s, j], j, goals, [(forces[s], costs)])
        found.add(first(bad))
        assert moves.first_violation_in_table(value, successors, forces, costs) == first(bad), trial
    assert -1 in found
    assert len(found) > 3


def between(values: Any, at: int) -> int:
    """At a level given in 2⁻¹⁶ parts, rounded up."""
    level, part = divmod(int(at), 1 << 16)
    above = int(values[level + 1]) if part else 0
    return -(-(int(values[level]) * ((1 << 16) - part) + above * part) // (1 << 16))


@pytest.mark.parametrize("memory", [0, 1, 2])
def test_the_first_level_that_stores_too_little(memory: int, monkeypatch: Any) -> None:
    """At every level, and where the image passes one."""
    rng, found = np.random.default_rng(memory), set()
    for trial in range(50):
        value, exists, _, _, reach = board(rng, False, memory)
        (cells, histories, nodes), levels = value.shape, int(rng.integers(1, 5))
        value = value[:, :, None] + rng.integers(0, rng.choice((1, 9)), (cells, histories, levels, nodes))
        rows = np.where(exists, rng.integers(0, cells, exists.shape), -1)
        forces = rng.integers(-3, 4, (2, cells, levels))
        pole, to = rng.random((2, cells, 1))
        image = (pole * np.arange(levels) + (1 - pole) * to * (levels - 1)) * (1 << 16)
        images = np.stack([np.floor(image), np.ceil(image)]).astype(np.int64)
        costs = costs_of(rng, reach * (nodes - 1))
        bad = np.zeros(value.shape, np.bool_)
        for n, h, i, j in product(*map(range, value.shape)):
            row = rows[n, h]
            if row < 0:
                continue
            for then, after in following(n, h, cells, reach, memory):
                for k in range(nodes):
                    d = (then - n) * (nodes - 1) + k - j
                    if abs(d) >= len(costs):
                        continue
                    there = value[then, after, :, k]
                    paid = forces[0 if d > 0 else 1, row] * d + costs[abs(d)]
                    have = value[n, h, i, j] + paid[i]
                    wrong = have < max(between(there, at) for at in images[:, row, i])
                    bad[n, h, i, j] |= wrong or passes(
                        have, value[n, h, :, j] + paid, images[:, row], i, there
                    )
        monkeypatch.setattr(domain, "AT_ONCE", 1 << trial % 9)
        monkeypatch.setattr(domain, "ROOM", 1 << trial % 11)
        found.add(first(bad))
        assert moves.first_relaxing_violation(value, rows, forces, images, costs, reach) == first(bad), trial
    assert -1 in found
    assert len(found) > 3


def passes(have: int, paid: Any, image: Any, i: int, there: Any) -> bool:
    """Whether on the way to the next level a level is passed at which more is stored."""
    if i + 1 == len(paid):
        return False
    lower, upper = image
    passed = int(lower[i] >> 16) + 1
    gap = (passed << 16) - int(upper[i])
    if gap < 0 or passed << 16 >= upper[i + 1]:
        return False
    width, rise = int(upper[i + 1] - lower[i]), int(paid[i + 1] - have)
    early, late = (gap << 16) // width, min(-((-(gap + 1) << 16) // max(width - 2, 1)), 1 << 16)
    return bool(have + min(rise * early >> 16, rise * late >> 16) < there[passed])
