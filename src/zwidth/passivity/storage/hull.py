"""One sweep over a grid of cells: from every state the best move, by one hull for all remembered forces.

    V(s) ← max( V(s), max over moves of  −f d − C(d) + V(s') )

The states of a group differ in their oldest reading only.  They lead to the same
states s' and differ in f alone, so that the best moves of all of them lie on the
upper hull of the points (d, V(s') − C(d)), in the order of f.

Most of that hull is the same for all nodes of a group.  With d = y − x,

    −f d − φ |d| − β d²  =  −β y² − (f ± φ − 2 β x) y  +  what y does not change

so that only corners of the upper hull of (y, V(s') − β y²) can be best, on each side of the hand, and of
these only corners between the slopes that occur.  Left out of this are moves of less than two steps, which
cost φ |d| alone, and the farthest cells, of which not every point is in reach of every node.

Among equally good moves the one with the least d is taken.

A delay of part of a sample makes each interval two moves.  The force of an older reading acts for a part of
the interval, the force of the next reading for the rest.  Between them the hand is at some m, which no
sample sees:

    V(x) ← max( V(x), max over m of  −f (m − x) − C(m − x) + W(m) )
    W(m) =  max over moves of  −f' (x' − m) − C'(x' − m) + V(x')

All states of a group share f' and W.
"""

from __future__ import annotations

import numpy as np

from zwidth.native.compiled import compiled
from zwidth.passivity.storage.domain import Integers

NOWHERE = 2**62
"""In place of the force of a state that is not on the grid."""

ONE_MOVE = np.zeros((0, 0), np.int64), np.zeros(0, np.int64)
"""In place of later forces and costs where an interval is one move."""


@compiled
def sweep(
    value: Integers,
    choice: Integers,
    first: int,
    last: int,
    forces: Integers,
    costs: Integers,
    nodes: Integers,
    places: Integers,
    reach: int,
    steps: int,
    later_forces: Integers,
    later_costs: Integers,
) -> int:
    """Improve the states of the groups first … last − 1; returns how many nodes improved.

    value and choice are (cells, histories, nodes); choice holds the flat index of the state in which the best
    move ends.
    The cells begin at the places, a cell has so many steps, and the hand stands on the nodes of it.
    With cells that are not all as long, costs that are not φ d + β d², or two moves in an interval, steps is
    0 and no point is left out beforehand.  Without a second move there are no later costs.
    """
    values, choices = value.reshape(-1), choice.reshape(-1)
    most_points = (2 * reach + 1) * nodes.size
    place, there = np.empty(most_points, np.int64), np.empty(most_points, np.int64)
    gain, move = np.empty(most_points, np.int64), np.empty(most_points, np.int64)
    goal = np.empty(most_points, np.int64)
    two_moves = later_costs.size > 0
    more_points = most_points if two_moves else 0
    best, ends = np.empty(more_points, np.int64), np.empty(more_points, np.int64)
    itself = np.arange(more_points)
    improved = 0
    for group in range(first, last):
        least, most = extremes(forces, group, reach)
        if least > most:
            continue
        if steps > 0:
            points = worthwhile(
                values, forces, costs, nodes, steps, group, reach, least, most, gain, place, there
            )
        else:
            points = targets(values, forces, nodes, places, group, reach, gain, place, there)
        if not two_moves:
            for node in range(nodes.size):
                improved += improve(
                    values, choices, forces, costs, nodes, group, reach, least, most, points, values, there,
                    place, there, node, gain, move, goal,
                )  # fmt: skip
            continue
        later, _ = extremes(later_forces, group, reach)  # all of them the same
        second_moves(gain, place, there, points, later, later_costs, best, ends)
        for node in range(nodes.size):
            improved += improve(
                values, choices, forces, costs, nodes, group, reach, least, most, points, best, itself,
                place, ends, node, gain, move, goal,
            )  # fmt: skip
    return improved


@compiled
def targets(
    values: Integers,
    forces: Integers,
    nodes: Integers,
    places: Integers,
    group: int,
    reach: int,
    worth: Integers,
    place: Integers,
    there: Integers,
) -> int:
    """Where a group may go, by place, the better state where an edge is two; returns how many."""
    cells, histories = forces.shape
    edges = nodes.size
    has_memory = histories > 1
    per_cell = histories // (2 * reach + 1) if has_memory else 1
    n, newer = group // per_cell, group % per_cell
    count = 0
    for n2 in range(max(0, n - reach), min(cells - 1, n + reach) + 1):
        h2 = (n - n2 + reach) * per_cell + newer if has_memory else 0
        for j2 in range(edges):
            target = (n2 * histories + h2) * edges + j2
            y = places[n2] - places[n] + nodes[j2]
            if count > 0 and place[count - 1] == y:
                count -= 1
                if values[target] <= worth[count]:
                    count += 1
                    continue
            worth[count], place[count], there[count] = values[target], y, target
            count += 1
    return count


@compiled
def extremes(forces: Integers, group: int, reach: int) -> tuple[int, int]:
    """The least and the greatest force of a group; the least is the greater one if it is not on the grid."""
    histories = forces.shape[1]
    alike = 2 * reach + 1 if histories > 1 else 1
    per_cell = histories // alike
    least, most = NOWHERE, -NOWHERE
    for h in range(group % per_cell * alike, (group % per_cell + 1) * alike):
        f = forces[group // per_cell, h]
        if f != NOWHERE:
            least, most = min(least, f), max(most, f)
    return least, most


@compiled
def worthwhile(
    values: Integers,
    forces: Integers,
    costs: Integers,
    nodes: Integers,
    steps: int,
    group: int,
    reach: int,
    least: int,
    most: int,
    height: Integers,
    place: Integers,
    there: Integers,
) -> int:
    """The points that may be best from some node of a group at some force from least to most.

    Filled in, by increasing place: steps from the lower edge of the hand's cell, and
    the flat index of the state; height is scratch.  Returns how many there are.
    """
    cells, histories = forces.shape
    edges = nodes.size
    has_memory = histories > 1
    per_cell = histories // (2 * reach + 1) if has_memory else 1
    n, newer = group // per_cell, group % per_cell
    far = costs.size - 1  # two steps and more cost φ D + β D² and a constant
    drag = friction = 0
    if far >= 2:
        drag = (costs[far] - 2 * costs[far - 1] + costs[far - 2]) // 2
        friction = costs[far] - costs[far - 1] - drag * (2 * far - 1)
    count = first = 0
    for n2 in range(max(0, n - reach), min(cells - 1, n + reach) + 1):
        h2 = (n - n2 + reach) * per_cell + newer if has_memory else 0
        apart = abs(n2 - n)
        hulled = (apart + 1) * steps <= far and (apart - 1) * steps >= 2
        rubbing = friction if n2 > n else -friction
        flattest, steepest = least + rubbing - 2 * drag * steps, most + rubbing
        for j2 in range(edges):
            target = (n2 * histories + h2) * edges + j2
            y = (n2 - n) * steps + nodes[j2]
            z = values[target] - drag * y * y
            if hulled and count > first:
                top = count - 1
                if z - height[top] <= flattest * (y - place[top]):
                    continue
                while top > first and (height[top] - height[top - 1]) * (y - place[top]) <= (
                    z - height[top]
                ) * (place[top] - place[top - 1]):
                    top -= 1
                if top == first and z - height[top] > steepest * (y - place[top]):
                    top -= 1
                count = top + 1
            height[count], place[count], there[count] = z, y, target
            count += 1
        if not hulled:
            first = count
    return count


@compiled
def improve(
    values: Integers,
    choices: Integers,
    forces: Integers,
    costs: Integers,
    nodes: Integers,
    group: int,
    reach: int,
    least: int,
    most: int,
    points: int,
    worth: Integers,
    which: Integers,
    place: Integers,
    there: Integers,
    node: int,
    gain: Integers,
    move: Integers,
    goal: Integers,
) -> int:
    """Improve the states of a group on one node by moves to its worthwhile points; returns how many.

    worth[which] of a point is what can still be taken out there; a move to it ends in there.
    gain, move and goal are scratch, for the corners of the hull.
    """
    histories, edges = forces.shape[1], nodes.size
    alike = 2 * reach + 1 if histories > 1 else 1
    per_cell = histories // alike
    n = group // per_cell
    corners = 0
    for point in range(points):
        d = place[point] - nodes[node]
        far = abs(d)
        if far >= costs.size:
            continue
        a = worth[which[point]] - costs[far]
        if corners > 0:
            top = corners - 1
            if a - gain[top] <= least * (d - move[top]):
                continue
            while top > 0 and (gain[top] - gain[top - 1]) * (d - move[top]) <= (a - gain[top]) * (
                move[top] - move[top - 1]
            ):
                top -= 1
            if top == 0 and a - gain[0] > most * (d - move[0]):
                top = -1
            corners = top + 1
        gain[corners], move[corners], goal[corners] = a, d, there[point]
        corners += 1
    at = improved = 0
    for h in range(group % per_cell * alike, (group % per_cell + 1) * alike):
        f = forces[n, h]
        if f == NOWHERE:
            continue
        while at + 1 < corners and gain[at + 1] - f * move[at + 1] > gain[at] - f * move[at]:
            at += 1
        while at > 0 and gain[at - 1] - f * move[at - 1] >= gain[at] - f * move[at]:
            at -= 1
        best = gain[at] - f * move[at]
        state = (n * histories + h) * edges + node
        if best > values[state]:
            values[state], choices[state] = best, goal[at]
            improved += 1
    return improved


# One sweep where a delay of part of a sample makes each interval two moves, the hand anywhere in between.
#
# On cells of many counts the hand is at a sample in the first count of a cell, but in between it may be
# anywhere: m is then sought where it is best, and a cycle that gains so is a motion to be counted exactly.


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
