"""One sweep where a delay of part of a sample makes each interval two moves.

The force of an older reading acts for a part of the interval, the force of the next
reading for the rest.  Between them the hand is at some m, which no sample sees:

    V(x) ← max( V(x), max over m of  −f (m − x) − C(m − x) + W(m) )
    W(m) =  max over moves of  −f' (x' − m) − C'(x' − m) + V(x')

All states of a group, which differ in their oldest reading only, share f' and W.

On cells of many counts the hand is at a sample in the first count of a cell, but in between it may be
anywhere: m is then sought where it is best, and a cycle that gains so is a motion to be counted exactly.
"""

from __future__ import annotations

import numpy as np

from zwidth.native.compiled import compiled
from zwidth.passivity.storage.losses import Integers
from zwidth.passivity.storage.solve.hull import NOWHERE, extremes, improve, targets


@compiled
def sweep_parts(
    value: Integers,
    choice: Integers,
    first: int,
    last: int,
    forces: Integers,
    costs: Integers,
    nodes: Integers,
    places: Integers,
    reach: int,
    later_forces: Integers,
    later_costs: Integers,
) -> int:
    """Improve the states of the groups first … last − 1; returns how many nodes improved.

    value and choice are (cells, histories, nodes); choice holds the flat index of the state
    in which the best move ends.
    """
    values, choices = value.reshape(-1), choice.reshape(-1)
    histories = forces.shape[1]
    per_cell = histories // (2 * reach + 1)
    most_points = (2 * reach + 1) * nodes.size
    worth, place = np.empty(most_points, np.int64), np.empty(most_points, np.int64)
    there, best = np.empty(most_points, np.int64), np.empty(most_points, np.int64)
    ends, gain = np.empty(most_points, np.int64), np.empty(most_points, np.int64)
    move, goal = np.empty(most_points, np.int64), np.empty(most_points, np.int64)
    itself = np.arange(most_points)
    improved = 0
    for group in range(first, last):
        least, most = extremes(forces, group, reach)
        if least > most:
            continue
        n, newer = group // per_cell, group % per_cell
        later = NOWHERE
        for h in range(newer * (2 * reach + 1), (newer + 1) * (2 * reach + 1)):
            if later == NOWHERE:
                later = later_forces[n, h]
        points = targets(values, forces, nodes, places, group, reach, worth, place, there)
        second_moves(worth, place, there, points, later, later_costs, best, ends)
        for node in range(nodes.size):
            improved += improve(
                values, choices, forces, costs, nodes, group, reach, least, most, points, best, itself,
                place, ends, node, gain, move, goal,
            )  # fmt: skip
    return improved


@compiled
def sweep_turning(
    value: Integers,
    choice: Integers,
    first: int,
    last: int,
    forces: Integers,
    costs: Integers,
    nodes: Integers,
    places: Integers,
    reach: int,
    later_forces: Integers,
    later_costs: Integers,
    part: float,
    swing: float,
    friction: int,
    max_depth: int,
) -> int:
    """The same with m anywhere; move by move, for grids of few cells.

    m = x + α D + swing (f' − f − φ (s − s')), or an end of what is allowed; steps and force units.
    """
    values, choices = value.reshape(-1), choice.reshape(-1)
    cells, histories = forces.shape
    edges, width = nodes.size, 2 * reach + 1
    per_cell = histories // width
    improved = 0
    for group in range(first, last):
        n, newer = group // per_cell, group % per_cell
        for h in range(newer * width, (newer + 1) * width):
            f = forces[n, h]
            if f == NOWHERE:
                continue
            later = later_forces[n, h]
            for j in range(edges):
                state = (n * histories + h) * edges + j
                best, goal = values[state], -1
                for n2 in range(max(0, n - reach), min(cells - 1, n + reach) + 1):
                    h2 = (n - n2 + reach) * per_cell + newer
                    for j2 in range(edges):
                        d = places[n2] - places[n] + nodes[j2] - nodes[j]
                        low = max(1 - costs.size, d - later_costs.size + 1)
                        high = min(costs.size - 1, d + later_costs.size - 1, max_depth - places[n] - nodes[j])
                        if low > high:
                            continue
                        target = (n2 * histories + h2) * edges + j2
                        for sign in range(-2, 5, 2):
                            turn = part * d + swing * (later - f - friction * sign)
                            m = round(turn) if sign < 4 else d
                            m = min(max(m, low), high)
                            back = d - m
                            energy = (
                                values[target] - f * m - costs[abs(m)] - later * back - later_costs[abs(back)]
                            )
                            if energy > best:
                                best, goal = energy, target
                if goal >= 0:
                    values[state], choices[state] = best, goal
                    improved += 1
    return improved


@compiled
def second_moves(
    worth: Integers,
    place: Integers,
    there: Integers,
    points: int,
    force: int,
    costs: Integers,
    best: Integers,
    ends: Integers,
) -> None:
    """W at every place, and the state where its best move ends.

    Costs are convex in the distance, so that from a place farther in the best move to
    the right ends farther in, and likewise to the left: the place in the middle splits the rest.
    """
    for point in range(points):
        best[point], ends[point] = worth[point], there[point]
    stack = np.empty((64, 4), np.int64)
    for side in range(2):
        stack[0, 0], stack[0, 1], stack[0, 2], stack[0, 3] = 0, points - 1, 0, points - 1
        size = 1
        while size > 0:
            size -= 1
            first, last, low, high = stack[size, 0], stack[size, 1], stack[size, 2], stack[size, 3]
            middle = (first + last) // 2
            start, stop = (max(low, middle), high) if side == 0 else (low, min(high, middle))
            at, most = -1, 0
            for j in range(start, stop + 1):
                d = place[j] - place[middle]
                if abs(d) < costs.size:
                    a = worth[j] - force * d - costs[abs(d)]
                    if at < 0 or a > most:
                        at, most = j, a
            if most > best[middle]:
                best[middle], ends[middle] = most, there[at]
            if first < middle:
                stack[size, 0], stack[size, 1], stack[size, 2], stack[size, 3] = first, middle - 1, low, at
                size += 1
            if middle < last:
                stack[size, 0], stack[size, 1], stack[size, 2], stack[size, 3] = middle + 1, last, at, high
                size += 1
