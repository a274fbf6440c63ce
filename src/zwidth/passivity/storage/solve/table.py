"""One sweep over the states of a table.

    V(s, x) ← max( V(s, x), max over x' of  −f(s) d − C(d) + V(s', x') )

s' is where the reading of x' leads from s.
"""

from __future__ import annotations

from zwidth.native.compiled import compiled
from zwidth.passivity.storage.losses import Integers


@compiled
def sweep_table(
    value: Integers,
    choice: Integers,
    first: int,
    last: int,
    successors: Integers,
    forces: Integers,
    costs: Integers,
    nodes: Integers,
) -> int:
    """Improve the states first … last − 1; returns how many nodes improved.

    value and choice are (states, nodes); choice holds the flat index of the best move.
    """
    width, edges = successors.shape[1], nodes.size
    reach, steps = width // 2, nodes[edges - 1]
    improved = 0
    for s in range(first, last):
        force = forces[s]
        for j in range(edges):
            best, goal = value[s, j], -1
            for move in range(width):
                then = successors[s, move]
                if then < 0:
                    continue
                way = (move - reach) * steps - nodes[j]
                for j2 in range(edges):
                    d = way + nodes[j2]
                    far = abs(d)
                    if far < costs.size:
                        worth = value[then, j2] - force * d - costs[far]
                        if worth > best:
                            best, goal = worth, then * edges + j2
            if goal >= 0:
                value[s, j], choice[s, j] = best, goal
                improved += 1
    return improved
