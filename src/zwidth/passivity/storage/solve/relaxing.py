"""One sweep over a grid with levels of the average reading, for laws that relax.

V is linear between the levels.  A move leads from a level to an average between two levels, and V is
taken there from above.
"""

from __future__ import annotations

import numpy as np

from zwidth.native.compiled import compiled
from zwidth.passivity.storage.losses import Integers


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
