"""One round of the game: from every state the best move, by one hull for all remembered forces.

    V(s) ← max( V(s), max over moves of  −f d − C(d) + V(s') )

The states of a group differ in their oldest reading only.  They lead to the same
states s' and differ in f alone, so that the best moves of all of them lie on the
upper hull of the points (d, V(s') − C(d)), in the order of f.
"""

from __future__ import annotations

import numpy as np

from zwidth.loop.compiled import compiled
from zwidth.passivity.worst_hand.board import NOWHERE, Integers


@compiled
def sweep(
    value: Integers,
    choice: Integers,
    forces: Integers,
    costs: Integers,
    knots: Integers,
    first: int,
    last: int,
    reach: int,
) -> int:
    """Improve the states of the groups first … last − 1; returns how many knots improved.

    value and choice are (cells, histories, knots); choice holds the flat index of the best move.
    """
    cells, histories, edges = value.shape
    steps = knots[edges - 1]
    width = 2 * reach + 1
    has_memory = histories > 1
    per_cell = histories // width if has_memory else 1
    alike = width if has_memory else 1
    most = (2 * reach + 1) * edges
    gain = np.empty(most, np.int64)
    move = np.empty(most, np.int64)
    there = np.empty(most, np.int64)
    improved = 0
    for group in range(first, last):
        n, newer = group // per_cell, group % per_cell
        low, high = max(0, n - reach), min(cells - 1, n + reach)
        for j in range(edges):
            corners = 0
            for n2 in range(low, high + 1):
                h2 = (n - n2 + reach) * per_cell + newer if has_memory else 0
                for j2 in range(edges):
                    d = (n2 - n) * steps + knots[j2] - knots[j]
                    far = abs(d)
                    if far >= costs.size:
                        continue
                    a = value[n2, h2, j2] - costs[far]
                    if corners > 0 and move[corners - 1] == d:
                        if gain[corners - 1] >= a:
                            continue
                        corners -= 1
                    while corners > 1 and (gain[corners - 1] - gain[corners - 2]) * (
                        d - move[corners - 1]
                    ) <= (a - gain[corners - 1]) * (move[corners - 1] - move[corners - 2]):
                        corners -= 1
                    gain[corners], move[corners] = a, d
                    there[corners] = (n2 * histories + h2) * edges + j2
                    corners += 1
            at = 0
            for oldest in range(alike):
                h = newer * width + oldest if has_memory else 0
                f = forces[n, h]
                if f == NOWHERE:
                    continue
                while at + 1 < corners and gain[at + 1] - f * move[at + 1] > gain[at] - f * move[at]:
                    at += 1
                while at > 0 and gain[at - 1] - f * move[at - 1] >= gain[at] - f * move[at]:
                    at -= 1
                best = gain[at] - f * move[at]
                if best > value[n, h, j]:
                    value[n, h, j] = best
                    choice[n, h, j] = there[at]
                    improved += 1
    return improved


@compiled
def cycle(choice: Integers, mark: Integers) -> int:
    """A state on a cycle of chosen moves, or −1; `choice` and the scratch `mark` (zeros) are flat."""
    for start in range(choice.size):
        if choice[start] < 0 or mark[start] != 0:
            continue
        v = start
        while v >= 0 and mark[v] == 0:
            mark[v] = start + 1
            v = choice[v]
        if v >= 0 and mark[v] == start + 1:
            return int(v)
    return -1
