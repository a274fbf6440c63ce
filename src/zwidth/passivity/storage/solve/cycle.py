"""A cycle among the best moves of a value iteration, if there is one."""

from __future__ import annotations

import numpy as np

from zwidth.native.compiled import compiled
from zwidth.passivity.storage.losses import Integers


def best_cycle(choice: Integers) -> list[int]:
    """The states of a cycle among the best moves, as flat indices; empty if there is none."""
    flat = choice.reshape(-1)
    start = cycle(flat, np.zeros(flat.size, np.int64))
    if start < 0:
        return []
    states, at = [start], int(flat[start])
    while at != start:
        states.append(at)
        at = int(flat[at])
    return states


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
