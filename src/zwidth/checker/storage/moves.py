"""Every move from every state, one after the other, in doubles that hold whole numbers exactly."""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit, prange


@njit(cache=True, parallel=True)
def violated(value: Any, exists: Any, forces: Any, costs: Any, reach: int, steps: int) -> bool:
    """True where from some state some move takes out more energy than V falls.

    value is (cells, histories, steps + 1), forces and exists are (cells, histories).
    """
    cells, histories, nodes = value.shape
    width = 2 * reach + 1
    older = max(1, histories // width)
    fails = np.zeros(cells, np.bool_)
    for n in prange(cells):
        gain, move = np.empty(width * nodes), np.empty(width * nodes)
        for newer in range(older):
            for j in range(nodes):
                size = 0
                for n2 in range(max(0, n - reach), min(cells, n + reach + 1)):
                    h2 = (n - n2 + reach) * older + newer if histories > 1 else 0
                    for j2 in range(nodes):
                        d = (n2 - n) * steps + j2 - j
                        if abs(d) < costs.size:
                            gain[size] = value[n2, h2, j2] - costs[abs(d)]
                            move[size] = d
                            size += 1
                done_force, done_best = np.nan, 0.0
                for oldest in range(width if histories > 1 else 1):
                    h = newer * width + oldest if histories > 1 else 0
                    if not exists[n, h]:
                        continue
                    f = forces[n, h]
                    if f != done_force:
                        best = 0.0
                        for t in range(size):
                            best = max(best, gain[t] - f * move[t])
                        done_force, done_best = f, best
                    if value[n, h, j] < done_best:
                        fails[n] = True
    return bool(fails.any())


@njit(cache=True, parallel=True)
def violated_in_parts(
    value: Any,
    exists: Any,
    forces: Any,
    costs: Any,
    later_forces: Any,
    later_costs: Any,
    reach: int,
    steps: int,
) -> bool:
    """The same where each interval is two moves with two forces, the hand anywhere between them."""
    cells, histories, nodes = value.shape
    width = 2 * reach + 1
    older = histories // width
    fails = np.zeros(cells, np.bool_)
    for n in prange(cells):
        low, high = max(0, n - reach), min(cells, n + reach + 1)
        start, size = (low - n) * steps, (high - low) * steps + 1
        goal, middle = np.empty(size), np.empty(size)
        for newer in range(older):
            any_h = 0
            for oldest in range(width):
                if exists[n, newer * width + oldest]:
                    any_h = newer * width + oldest
            later = later_forces[n, any_h]  # does not depend on the oldest reading
            goal[:] = -1.0
            for n2 in range(low, high):
                h2 = (n - n2 + reach) * older + newer
                for j2 in range(nodes):
                    at = (n2 - low) * steps + j2
                    goal[at] = max(goal[at], value[n2, h2, j2])
            for m in range(size):
                middle[m] = goal[m]
                for to in range(max(0, m - later_costs.size + 1), min(size, m + later_costs.size)):
                    middle[m] = max(middle[m], goal[to] - later * (to - m) - later_costs[abs(to - m)])
            for oldest in range(width):
                h = newer * width + oldest
                if not exists[n, h]:
                    continue
                f = forces[n, h]
                for j in range(nodes):
                    best = 0.0
                    at = j - start
                    for m in range(max(0, at - costs.size + 1), min(size, at + costs.size)):
                        best = max(best, middle[m] - f * (m - at) - costs[abs(m - at)])
                    if value[n, h, j] < best:
                        fails[n] = True
    return bool(fails.any())


@njit(cache=True, parallel=True)
def violated_in_table(value: Any, successors: Any, forces: Any, costs: Any, steps: int) -> bool:
    """The same where a table says which state follows, −1 off the grid; value is (states, steps + 1)."""
    states, nodes = value.shape
    reach = successors.shape[1] // 2
    fails = np.zeros(states, np.bool_)
    for s in prange(states):
        for j in range(nodes):
            for move in range(2 * reach + 1):
                then = successors[s, move]
                if then < 0:
                    continue
                for j2 in range(nodes):
                    d = (move - reach) * steps + j2 - j
                    if abs(d) < costs.size and value[s, j] < value[then, j2] - forces[s] * d - costs[abs(d)]:
                        fails[s] = True
    return bool(fails.any())


@njit(cache=True)
def _between(value: Any, n: int, h: int, at: int, j: int) -> int:
    """V at a level given in 2⁻¹⁶ parts, rounded up."""
    level, part = at >> 16, at & 0xFFFF
    here = value[n, h, level, j]
    if part == 0:
        return int(here)
    return int(here - ((-(value[n, h, level + 1, j] - here) * part) >> 16))


@njit(cache=True, parallel=True)
def violated_relaxing(
    value: Any,
    rows: Any,
    inwards: Any,
    outwards: Any,
    lower: Any,
    upper: Any,
    costs: Any,
    reach: int,
    steps: int,
) -> bool:
    """True where from some state some move takes out more energy than V falls.

    value is (cells, histories, levels, steps + 1); lower and upper enclose the image of each level.
    """
    cells, histories, levels, nodes = value.shape
    older = max(1, histories // (2 * reach + 1))
    fails = np.zeros(cells, np.bool_)
    for n in prange(cells):
        for h in range(histories):
            row = rows[n, h]
            if row < 0:
                continue
            for n2 in range(max(0, n - reach), min(cells, n + reach + 1)):
                h2 = (n - n2 + reach) * older + h // (2 * reach + 1) if histories > 1 else 0
                for j in range(nodes):
                    for j2 in range(nodes):
                        d = (n2 - n) * steps + j2 - j
                        if abs(d) >= costs.size:
                            continue
                        cost = costs[abs(d)]
                        for i in range(levels):
                            f = inwards[row, i] if d > 0 else outwards[row, i]
                            have = value[n, h, i, j] + f * d + cost
                            goal = max(
                                _between(value, n2, h2, lower[row, i], j2),
                                _between(value, n2, h2, upper[row, i], j2),
                            )
                            if have < goal:
                                fails[n] = True
                            if i + 1 < levels:
                                passed = (lower[row, i] >> 16) + 1  # the level that the image may pass
                                gap = passed * (1 << 16) - upper[row, i]
                                if passed * (1 << 16) < upper[row, i + 1]:
                                    width = upper[row, i + 1] - lower[row, i]
                                    f = inwards[row, i + 1] if d > 0 else outwards[row, i + 1]
                                    rise = value[n, h, i + 1, j] + f * d + cost - have
                                    early = (gap << 16) // width
                                    late = min(-((-(gap + 1) << 16) // max(width - 2, 1)), 1 << 16)
                                    least = have + min((rise * early) >> 16, (rise * late) >> 16)
                                    if least < value[n2, h2, passed, j2]:
                                        fails[n] = True
    return bool(fails.any())


@njit(cache=True)
def _corners(value: Any, places: Any, n: int, newer: int, reach: int, goal: Any) -> int:
    """The best value at every place within reach of corner n; returns how far out the first place is."""
    corners, histories = value.shape
    older = max(1, histories // (2 * reach + 1))
    low, high = max(0, n - reach), min(corners, n + reach + 1)
    goal[:] = -1.0
    for n2 in range(low, high):
        h2 = (n - n2 + reach) * older + newer if histories > 1 else 0
        at = places[n2] - places[low]
        goal[at] = max(goal[at], value[n2, h2])
    return int(places[n] - places[low])


@njit(cache=True, parallel=True)
def violated_on_line(value: Any, exists: Any, forces: Any, costs: Any, places: Any, reach: int) -> bool:
    """As `violated`, V at the corners of a line; value, exists and forces are (corners, histories)."""
    corners, histories = value.shape
    width = 2 * reach + 1 if histories > 1 else 1
    fails = np.zeros(corners, np.bool_)
    for n in prange(corners):
        size = places[min(corners - 1, n + reach)] - places[max(0, n - reach)] + 1
        goal = np.empty(size)
        for newer in range(histories // width):
            start = _corners(value, places, n, newer, reach, goal)
            for h in range(newer * width, (newer + 1) * width):
                for to in range(size):
                    d = to - start
                    if not exists[n, h] or abs(d) >= costs.size:
                        continue
                    if value[n, h] < goal[to] - forces[n, h] * d - costs[abs(d)]:
                        fails[n] = True
    return bool(fails.any())


@njit(cache=True, parallel=True)
def violated_in_parts_on_line(
    value: Any,
    exists: Any,
    forces: Any,
    costs: Any,
    later_forces: Any,
    later_costs: Any,
    places: Any,
    reach: int,
) -> bool:
    """The same where each interval is two moves with two forces, the hand anywhere between them."""
    corners, histories = value.shape
    width = 2 * reach + 1
    fails = np.zeros(corners, np.bool_)
    for n in prange(corners):
        size = places[min(corners - 1, n + reach)] - places[max(0, n - reach)] + 1
        goal, middle = np.empty(size), np.empty(size)
        for newer in range(histories // width):
            start = _corners(value, places, n, newer, reach, goal)
            later = np.nan
            for h in range(newer * width, (newer + 1) * width):
                if not exists[n, h]:
                    continue
                if later != later_forces[n, h]:
                    later = later_forces[n, h]
                    for m in range(size):
                        middle[m] = goal[m]
                        for to in range(max(0, m - later_costs.size + 1), min(size, m + later_costs.size)):
                            lost = later * (to - m) + later_costs[abs(to - m)]
                            middle[m] = max(middle[m], goal[to] - lost)
                for m in range(max(0, start - costs.size + 1), min(size, start + costs.size)):
                    lost = forces[n, h] * (m - start) + costs[abs(m - start)]
                    if value[n, h] < middle[m] - lost:
                        fails[n] = True
    return bool(fails.any())
