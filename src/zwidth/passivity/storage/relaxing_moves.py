"""One sweep over a grid with levels of the average reading, for laws that relax, and a hand that follows it.

V is linear between the levels.  A move leads from a level to an average between two levels, and V is
taken there from above.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from zwidth.native.compiled import compiled
from zwidth.passivity.storage.domain import Integers


@compiled
def sweep_relaxing(
    value: Integers,
    before: Integers,
    first: int,
    last: int,
    rows: Integers,
    inwards: Integers,
    outwards: Integers,
    at: Integers,
    below: Integers,
    above: Integers,
    costs: Integers,
    nodes: Integers,
    steps: int,
    reach: int,
    kinks: bool,
) -> int:
    """Improve the states of the cells first … last − 1; returns how many improved.

    value is (cells, histories, levels, nodes); before is value as it was before this round.  Of other
    cells before is read: what they become meanwhile depends on which thread is the faster.
    """
    cells, histories, levels, edges = value.shape
    older = histories // (2 * reach + 1) if histories > 1 else 1
    there = np.empty((cells, edges), np.int64)
    improved = 0
    for n in range(first, last):
        low, high = max(0, n - reach), min(cells - 1, n + reach)
        for h in range(histories):
            row = rows[n, h]
            if row < 0:
                continue
            newer = h // (2 * reach + 1)
            for i in range(levels):
                # what can still be taken out there, the average between the levels m and m + 1; from above
                m = at[row, i]
                for n2 in range(low, high + 1):
                    h2 = (n - n2 + reach) * older + newer if histories > 1 else 0
                    goals = value[n2, h2, :, :] if first <= n2 < last else before[n2, h2, :, :]
                    for j2 in range(edges):
                        a = goals[m, j2]
                        step = goals[m + 1, j2] - a
                        weight = above[row, i] if step > 0 else below[row, i]
                        there[n2, j2] = a - ((-step * weight) >> 16)
                # the best move from each node, at this level
                for j in range(edges):
                    best = value[n, h, i, j]
                    for n2 in range(low, high + 1):
                        for j2 in range(edges):
                            d = (n2 - n) * steps + nodes[j2] - nodes[j]
                            if abs(d) >= costs.size:
                                continue
                            f = inwards[row, i] if d > 0 else outwards[row, i]
                            a = there[n2, j2] - costs[abs(d)] - f * d
                            best = max(best, a)
                    if best > value[n, h, i, j]:
                        value[n, h, i, j] = best
                        improved += 1
                if not kinks or i == 0:
                    continue
                # between the levels i − 1 and i: where a' passes a level, V(s', a') has a kink
                m = at[row, i - 1] + 1
                if m > at[row, i] or (m == at[row, i] and above[row, i] == 0):
                    continue
                span = (at[row, i] - at[row, i - 1]) * (1 << 16) + above[row, i] - below[row, i - 1]
                part = (1 << 16) - above[row, i - 1]
                # after which part of the way from level to level, in 2⁻¹⁶, at the earliest and at the latest
                early = (part << 16) // span
                late = -((-(part + 1) << 16) // max(span - 2, 1))
                late = min(late, 1 << 16)
                for n2 in range(low, high + 1):
                    h2 = (n - n2 + reach) * older + newer if histories > 1 else 0
                    goals = value[n2, h2, :, :] if first <= n2 < last else before[n2, h2, :, :]
                    for j2 in range(edges):
                        goal = goals[m, j2]
                        for j in range(edges):
                            d = (n2 - n) * steps + nodes[j2] - nodes[j]
                            if abs(d) >= costs.size:
                                continue
                            f0 = inwards[row, i - 1] if d > 0 else outwards[row, i - 1]
                            f1 = inwards[row, i] if d > 0 else outwards[row, i]
                            # V(s, a) + f(a) d is linear on that way; what it lacks is added at both ends
                            start = value[n, h, i - 1, j] + f0 * d
                            rise = value[n, h, i, j] + f1 * d - start
                            least = start + min((rise * early) >> 16, (rise * late) >> 16)
                            lack = goal - costs[abs(d)] - least
                            if lack > 0:
                                value[n, h, i - 1, j] += lack
                                value[n, h, i, j] += lack
                                improved += 1
    return improved


# The average reading a lies between two levels, so the best moves on the levels make no cycle by themselves:
# the hand is watched with
#
#     a_{k+1} = p a_k + (1 − p) u_k
#
# as it really becomes, and of a cycle that it makes counts what it gains once a has settled to it.


Floats = NDArray[np.float64]


class RelaxingForce(NamedTuple):
    """y = spring u + branch (u − a), in force units, for readings of whole counts.

    `penetration`: u is never below 0; `everywhere`: there is no surface; `clamped`: the law never pulls;
    `resets`: at the surface and outside it forgets.
    """

    spring: float
    branch: float
    pole: float
    penetration: bool
    everywhere: bool
    clamped: bool
    resets: bool


@compiled
def felt(law: RelaxingForce, count: int, average: float) -> tuple[float, float]:
    """The force at this count, and what the average then becomes."""
    u = max(count, 0) if law.penetration else count
    force = law.spring * u + law.branch * (u - average)
    if (law.clamped and force < 0) or not (law.everywhere or count > 0):
        force = 0.0
    if law.resets and u <= 0:
        return force, 0.0
    return force, law.pole * average + (1 - law.pole) * u


@compiled
def follow(
    law: RelaxingForce,
    value: Integers,
    start: tuple[int, int, float],
    delay: int,
    nodes: Integers,
    costs: Integers,
    frame: tuple[int, int, int, int, int],
    path: Integers,
) -> None:
    """Fill in cell and node at each move, the best by V between two levels.

    `start` is the cell, where it was for long, the node and the average; `frame` is the count of the lowest
    cell and of the lowest level, levels and steps per count, and the reach in cells.
    """
    lowest, low, per_count, steps, reach = frame
    cells, _, levels, edges = value.shape
    n, j, average = start
    readings = np.full(delay + 1, n)
    for k in range(path.shape[0]):
        path[k, 0], path[k, 1] = n, j
        force, average = felt(law, readings[delay] + lowest, average)
        level = min((average - low) * per_count, levels - 1.0)
        m = min(int(level), levels - 2)
        most = -np.inf
        n1, j1 = n, j
        for n2 in range(max(0, n - reach), min(cells - 1, n + reach) + 1):
            column, newer = 0, n2
            for i in range(delay):
                column = column * (2 * reach + 1) + readings[i] - newer + reach
                newer = readings[i]
            for j2 in range(edges):
                d = (n2 - n) * steps + nodes[j2] - nodes[j]
                if abs(d) >= costs.size:
                    continue
                lower = value[n2, column, m, j2]
                there = lower + (value[n2, column, m + 1, j2] - lower) * (level - m)
                worth = there - costs[abs(d)] - force * d
                if worth > most:
                    most, n1, j1 = worth, n2, j2
        n, j = n1, j1
        for i in range(delay, 0, -1):
            readings[i] = readings[i - 1]
        readings[0] = n


@compiled
def best_cycle(
    law: RelaxingForce, counts: Integers, positions: Integers, places: Integers, delay: int, costs: Integers
) -> tuple[float, int, int]:
    """The largest gain of a cycle on the way, and its first move and the one after its last; 0, 0, 0 of none.

    Moves of one of the `places` (numbered from 0) begin and end at the same cell and node; of those where
    the hand was before, the last three count.
    """
    most, begins, ends = 0.0, 0, 0
    latest = np.full(places.max() + 1, -1)
    before = np.full(places.size, -1)
    for k in range(places.size):
        before[k] = latest[places[k]]
        latest[places[k]] = k
        first = before[k]
        for _ in range(3):
            if first < 0:
                break
            if k - first > 1:
                gain = settled_gain(law, counts[first:k], positions[first:k], delay, costs)
                if gain > most:
                    most, begins, ends = gain, first, k
            first = before[first]
    return most, begins, ends


@compiled
def settled_gain(
    law: RelaxingForce, counts: Integers, positions: Integers, delay: int, costs: Integers
) -> float:
    """What a cycle gains in each round when the law has settled to it, in energy units; 0 where too fast."""
    size = counts.size
    zero, one = 0.0, 1.0  # one round takes the average a to zero + (one − zero) a
    for k in range(size):
        _, zero = felt(law, counts[k], zero)
        _, one = felt(law, counts[k], one)
    average = zero / (1 - (one - zero))
    forces = np.empty(size)
    for k in range(size):
        forces[(k + delay) % size], average = felt(law, counts[k], average)
    gain = 0.0
    for k in range(size):
        d = positions[(k + 1) % size] - positions[k]
        if abs(d) >= costs.size:
            return 0.0
        gain -= forces[k] * d + costs[abs(d)]
    return gain
