"""Every move from every state, in doubles or integers that hold whole numbers exactly, many states at a time.

V(s, x) ≥ V(s', x') − F d − c(|d|) for every move d = x' − x.  From one distance to the next, all states of a
block are looked at together: V(s', x') − F x' less a number is compared with V(s, x) − F x, place by place.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np

from .domain import at_once

Parts = Sequence[tuple[Any, Any]]
Following = Iterator[tuple[Any, Any]]
"""Reading by reading the states that follow, −1 off the grid, and by how many places they stand elsewhere."""


def violated(value: Any, exists: Any, moves: Parts, inside: int, reach: int) -> bool:
    """True where from some state some move takes out more energy than V falls.

    value is (cells, histories, nodes), exists is (cells, histories).  Cells of one node are corners of a
    line: the first that is `inside` stands where the last one outside does.  `moves` are the parts of an
    interval, the hand anywhere between them: of each the forces, which are (cells, histories), and what a
    move costs.  Later forces do not depend on the oldest reading.
    """
    cells, histories, nodes = value.shape
    oldest = 2 * reach + 1 if histories > 1 else 1
    older = histories // oldest
    near = min(reach, cells - 1)

    def following(groups: Any) -> Following:
        n, newer = groups // older, groups % older
        for k in range(-near, near + 1):
            then = n + k
            place = then * histories + (reach - k) * older + newer if histories > 1 else then
            shift = (n >= inside).astype(np.int64) - (then >= inside)
            yield np.where((then >= 0) & (then < cells), place, -1), shift

    return _violated(value.reshape(-1, nodes), exists.ravel(), moves, following, near, oldest)


def violated_in_table(value: Any, successors: Any, forces: Any, costs: Any) -> bool:
    """The same where a table says which state follows, −1 off the grid; value is (states, nodes)."""

    def following(states: Any) -> Following:
        for then in successors[states].T:
            yield then, np.zeros(1, np.int64)

    exists = np.ones(len(value), np.bool_)
    return _violated(value, exists, [(forces, costs)], following, successors.shape[1] // 2, 1)


def _violated(
    value: Any, exists: Any, moves: Parts, following: Callable[[Any], Following], reach: int, oldest: int
) -> bool:
    """States that differ in the oldest of their readings alone, so many, lead to the same ones."""
    nodes = value.shape[1]
    start = reach * max(1, nodes - 1)
    places = 2 * start + nodes
    forces, costs = moves[0][0].ravel(), moves[0][1]
    size = at_once(nodes, places)
    for groups in _blocks(np.arange(len(value) // oldest), size):
        states = np.arange(groups[0] * oldest, (groups[-1] + 1) * oldest)
        states = states[exists[states]]
        if not states.size:
            continue
        goal = _goal(value, following(groups), places, len(groups))
        for later_forces, later_costs in moves[:0:-1]:
            middle = _best(goal, later_forces.ravel()[groups * oldest], later_costs, 0, places)
            goal = np.where(goal < 0, goal, middle)
        for some in _blocks(states, size):
            reached = goal.take(some // oldest - groups[0], axis=1)
            if (value[some] < _best(reached, forces[some], costs, start, nodes).T).any():
                return True
    return False


def _blocks(all_of_them: Any, size: int) -> Iterator[Any]:
    for first in range(0, len(all_of_them), size):
        yield all_of_them[first : first + size]


def _goal(value: Any, following: Following, places: int, groups: int) -> Any:
    """The most that is stored at every place that a move may lead to, and −∞ off the grid; a column each."""
    goal, nodes = np.full((places, groups), -np.inf), value.shape[1]
    for k, (then, shift) in enumerate(following):
        there = np.where(then >= 0, value[then].T, -np.inf)
        for by in range(shift.min(), shift.max() + 1):
            at = goal[k * max(1, nodes - 1) + by :][:nodes]
            np.maximum(at, there, out=at, where=shift == by)
    return goal


def _best(goal: Any, forces: Any, costs: Any, start: int, nodes: int) -> Any:
    """The most that a move from each of some places can bring, the first of them at `start`."""
    fed = (np.arange(len(goal)) - len(goal) // 2)[:, None] * forces.astype(np.float64)
    here = fed[start : start + nodes].copy()
    np.subtract(goal, fed, out=fed)
    best, one = np.full(here.shape, -np.inf), np.empty(here.shape)
    for d in range(max(1 - len(costs), 1 - start - nodes), min(len(costs), len(goal) - start)):
        first, last = max(0, -start - d), min(nodes, len(goal) - start - d)
        brought = np.subtract(fed[start + d + first : start + d + last], costs[abs(d)], out=one[first:last])
        np.maximum(best[first:last], brought, out=best[first:last])
    return np.add(best, here, out=best)


def violated_relaxing(value: Any, rows: Any, forces: Any, images: Any, costs: Any, reach: int) -> bool:
    """True where from some state some move takes out more energy than V falls.

    value is (cells, histories, levels, nodes); forces inwards and outwards, and where a level goes at least
    and at most, in 2⁻¹⁶ parts of a level, are (2, rows, levels).
    """
    cells, histories, levels, nodes = value.shape
    oldest = 2 * reach + 1 if histories > 1 else 1
    near, steps, nowhere = min(reach, cells - 1), nodes - 1, np.iinfo(np.int64).min
    start, value, rows = near * steps, value.reshape(-1, levels, nodes), rows.ravel()
    places = 2 * start + nodes
    size = max(1, at_once(nodes, places) // levels)
    for states in _blocks(np.flatnonzero(rows >= 0), size):
        row, n, newer = rows[states], states // histories, states % histories // oldest
        below, passed, early, late = _passing(images[:, row])
        ends = [_between(end) for end in images[:, row]]
        goal = np.full((places, len(states) * levels), nowhere)
        kink = np.full((places, len(passed)), nowhere)
        for k in range(-near, near + 1):
            on = (n + k >= 0) & (n + k < cells)
            h = (reach - k) * (histories // oldest) + newer if histories > 1 else 0
            there = value[np.where(on, (n + k) * histories + h, 0)].transpose(2, 0, 1)
            there = np.where(on[:, None], there, nowhere).reshape(nodes, -1)
            at = slice(start + k * steps, start + k * steps + nodes)
            for level, above, part in ends:
                here = there.take(level, axis=1)
                between = here - ((here - there.take(above, axis=1)) * part >> 16)  # rounded up
                np.maximum(goal[at], between, out=goal[at])
            np.maximum(kink[at], there.take(passed, axis=1), out=kink[at])
        here = value[states].transpose(2, 0, 1).reshape(nodes, -1)
        low = here.take(below, axis=1)
        rise = here.take(below + 1, axis=1) - low
        for d in range(max(1 - len(costs), 1 - start - nodes), min(len(costs), start + nodes)):
            first, last = max(0, -start - d), min(nodes, places - start - d)
            j, to = slice(first, last), slice(start + d + first, start + d + last)
            paid = forces[0 if d > 0 else 1, row].ravel() * d + costs[abs(d)]
            bad = (here[j] + paid < goal[to]).any()
            more = rise[j] + (paid[below + 1] - paid[below])
            least = np.minimum(more * early, more * late) >> 16
            if bad or (low[j] + paid[below] + least < kink[to]).any():
                return True
    return False


def _between(image: Any) -> tuple[Any, Any, Any]:
    """The level below and above each image, by place among those of all states, and the part between."""
    levels, level = image.shape[1], image >> 16
    first = levels * np.arange(len(image))[:, None]
    above = np.minimum(level + 1, levels - 1)
    return (first + level).ravel(), (first + above).ravel(), (image & 0xFFFF).ravel()


def _passing(images: Any) -> tuple[Any, Any, Any, Any]:
    """Where the image passes a level on the way from one level to the next: both, and how far on at least
    and at most.
    """
    (lower, upper), levels = images, images.shape[2]
    passed = (lower >> 16) + 1
    gap = (passed << 16) - upper
    s, i = np.nonzero((passed[:, :-1] << 16 < upper[:, 1:]) & (gap[:, :-1] >= 0))
    gap, width = gap[s, i], upper[s, i + 1] - lower[s, i]
    late = np.minimum(-((-(gap + 1) << 16) // np.maximum(width - 2, 1)), 1 << 16)
    return s * levels + i, s * levels + passed[s, i], (gap << 16) // width, late
