"""Every move from every state, one after the other, in doubles that hold whole numbers exactly."""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit, prange


@njit(cache=True, parallel=True)
def first_violation(value: Any, forces: Any, exists: Any, costs: Any, reach: int, steps: int) -> int:
    """The first state from which some move takes out more energy than V falls; −1 if there is none.

    value is (cells, histories, steps + 1), forces and exists are (cells, histories).
    """
    cells, histories, knots = value.shape
    width = 2 * reach + 1
    older = histories // width if histories > 1 else 1
    worst = np.full(cells, -1, np.int64)
    for n in prange(cells):
        gain, move = np.empty(width * knots), np.empty(width * knots)
        for newer in range(older):
            for j in range(knots):
                size = 0
                for n2 in range(max(0, n - reach), min(cells, n + reach + 1)):
                    h2 = (n - n2 + reach) * older + newer if histories > 1 else 0
                    for j2 in range(knots):
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
                    if value[n, h, j] < done_best and worst[n] < 0:
                        worst[n] = (n * histories + h) * knots + j
    for n in range(cells):
        if worst[n] >= 0:
            return int(worst[n])
    return -1
