"""Every move from every state, in doubles or integers that hold whole numbers exactly, many states at a time.

V(s, x) ≥ V(s', x') − F d − c(|d|) for every move d = x' − x.  From one distance to the next, all states of a
block are looked at together: V(s', x') − F x' less a number is compared with V(s, x) − F x, place by place.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np

AT_ONCE = 1 << 15
"""Moves of one distance that are looked at together: so few that they stay near the processor."""
ROOM = 1 << 21
"""Numbers of one array."""

Parts = Sequence[tuple[Any, Any]]
Following = Iterator[tuple[Any, Any]]
"""Reading by reading the states that follow, −1 off the grid, and by how many places they stand elsewhere."""


def first_violation(value: Any, exists: Any, moves: Parts, inside: int, reach: int) -> int:
    """The first state from which some move takes out more energy than V falls; −1 if there is none.

    value is (cells, histories, nodes), exists is (cells, histories).  Cells of one node are corners of a line:
    the first that is `inside` stands where the last one outside does.  `moves` are the parts of an interval,
    the hand anywhere between them: of each the forces, which are (cells, histories), and what a move costs.
    Later forces do not depend on the oldest reading.
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

    return _first(value.reshape(-1, nodes), exists.ravel(), moves, following, near, oldest)


def first_violation_in_table(value: Any, successors: Any, forces: Any, costs: Any) -> int:
    """The same where a table says which state follows, −1 off the grid; value is (states, nodes)."""

    def following(states: Any) -> Following:
        for then in successors[states].T:
            yield then, np.zeros(1, np.int64)

    exists = np.ones(len(value), np.bool_)
    return _first(value, exists, [(forces, costs)], following, successors.shape[1] // 2, 1)


def _first(
    value: Any, exists: Any, moves: Parts, following: Callable[[Any], Following], reach: int, oldest: int
) -> int:
    """States that differ in the oldest of their readings alone, so many, lead to the same ones."""
    nodes = value.shape[1]
    start = reach * max(1, nodes - 1)
    places = 2 * start + nodes
    forces, costs = moves[0][0].ravel(), moves[0][1]
    at_once = max(1, min(AT_ONCE // nodes, ROOM // places))
    for groups in _blocks(np.arange(len(value) // oldest), at_once):
        states = np.arange(groups[0] * oldest, (groups[-1] + 1) * oldest)
        states = states[exists[states]]
        if not states.size:
            continue
        goal = _goal(value, following(groups), places, len(groups))
        for later_forces, later_costs in moves[:0:-1]:
            middle = _best(goal, later_forces.ravel()[groups * oldest], later_costs, 0, places)
            goal = np.where(goal < 0, goal, middle)
        for some in _blocks(states, at_once):
            reached = goal.take(some // oldest - groups[0], axis=1)
            bad = value[some] < _best(reached, forces[some], costs, start, nodes).T
            if bad.any():
                at = int(bad.argmax())
                return int(some[at // nodes]) * nodes + at % nodes
    return -1


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
    fed = np.arange(-start, len(goal) - start)[:, None] * forces.astype(np.float64)
    here = fed[start : start + nodes].copy()
    np.subtract(goal, fed, out=fed)
    best, one = np.full(here.shape, -np.inf), np.empty(here.shape)
    for d in range(max(1 - len(costs), 1 - start - nodes), min(len(costs), len(goal) - start)):
        first, last = max(0, -start - d), min(nodes, len(goal) - start - d)
        brought = np.subtract(fed[start + d + first : start + d + last], costs[abs(d)], out=one[first:last])
        np.maximum(best[first:last], brought, out=best[first:last])
    return np.add(best, here, out=best)


def first_relaxing_violation(
    value: Any, rows: Any, forces: Any, images: Any, costs: Any, reach: int
) -> int:
    """The first state from which some move takes out more energy than V falls; −1 if there is none.

    value is (cells, histories, levels, nodes); forces inwards and outwards, and where a level goes at least
    and at most, in 2⁻¹⁶ parts of a level, are (2, rows, levels).
    """
    cells, histories, levels, nodes = value.shape
    oldest = 2 * reach + 1 if histories > 1 else 1
    near, steps = min(reach, cells - 1), nodes - 1
    start, flat = near * steps, value.reshape(-1, nodes)
    places = 2 * start + nodes
    most = max(1, min(AT_ONCE // nodes, ROOM // places) // levels)
    for states in _blocks(np.flatnonzero(rows.ravel() >= 0), most):
        row, n, newer = rows.ravel()[states], states // histories, states % histories // oldest
        (lower, upper), passed = images[:, row], (images[0, row] >> 16) + 1
        gap = (passed << 16) - upper  # to the level that the image may pass
        s, i = np.nonzero((passed[:, :-1] << 16 < upper[:, 1:]) & (gap[:, :-1] >= 0))
        gap, width, passed = gap[s, i], upper[s, i + 1] - lower[s, i], passed[s, i]
        early = (gap << 16) // width
        late = np.minimum(-((-(gap + 1) << 16) // np.maximum(width - 2, 1)), 1 << 16)
        goal = np.full((places, len(states), levels), np.iinfo(np.int64).min)
        kink = np.full((places, len(s)), np.iinfo(np.int64).min)
        for k in range(-near, near + 1):
            on = np.flatnonzero((n + k >= 0) & (n + k < cells))
            h = (reach - k) * (histories // oldest) + newer if histories > 1 else 0 * newer
            place = ((n + k) * histories + h) * levels
            found = [_between(flat, place[on, None], end[on], levels) for end in (lower, upper)]
            at = slice(start + k * steps, start + k * steps + nodes)
            goal[at, on] = np.maximum(goal[at, on], np.maximum(*found).transpose(2, 0, 1))
            hit = np.flatnonzero((n[s] + k >= 0) & (n[s] + k < cells))
            kink[at, hit] = np.maximum(kink[at, hit], flat[place[s[hit]] + passed[hit]].T)
        here = value.reshape(-1, levels, nodes)[states].transpose(2, 0, 1).copy()
        low, rise = here[:, s, i], here[:, s, i + 1] - here[:, s, i]
        bad, bad_between = np.zeros(here.shape, np.bool_), np.zeros(low.shape, np.bool_)
        for d in range(max(1 - len(costs), -start - steps), min(len(costs), start + nodes)):
            first, last = max(0, -start - d), min(nodes, places - start - d)
            j, to = slice(first, last), slice(start + d + first, start + d + last)
            paid = forces[0 if d > 0 else 1, row] * d + costs[abs(d)]
            bad[j] |= here[j] + paid < goal[to]
            more = rise[j] + (paid[s, i + 1] - paid[s, i])
            least = np.minimum(more * early, more * late) >> 16
            bad_between[j] |= low[j] + paid[s, i] + least < kink[to]
        bad[:, s, i] |= bad_between
        if bad.any():
            at = int(bad.transpose(1, 2, 0).argmax())
            return int(states[at // (levels * nodes)]) * levels * nodes + at % (levels * nodes)
    return -1


def _between(flat: Any, place: Any, at: Any, levels: int) -> Any:
    """V at levels given in 2⁻¹⁶ parts, rounded up."""
    level = at >> 16
    here, above = flat[place + level], flat[place + np.minimum(level + 1, levels - 1)]
    return here - ((-(above - here) * (at & 0xFFFF)[..., None]) >> 16)
