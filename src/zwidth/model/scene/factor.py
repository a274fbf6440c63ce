"""The node matrix of a scene as L D Lᵀ, in the order that fills in least: a chain or a tree costs O(n).

G = Σ R aᵀa over the linear elements does not change from step to step; it is factorised once.  Eliminating
next the node with the fewest neighbours fills in nothing on a tree (Parter 1961).
"""

from __future__ import annotations

from collections.abc import Sequence
from heapq import heapify, heappop, heappush
from typing import NamedTuple

_LEAST_PIVOT = 1e-13
"""Below this part of its diagonal a pivot is rounding alone."""


class Factor(NamedTuple):
    """L and D: of each pivot its node, its 1/d, and the column of L below it as (place, value)."""

    order: tuple[int, ...]
    inverse: tuple[float, ...]
    columns: tuple[tuple[tuple[int, float], ...], ...]


def factorised(rows: Sequence[dict[int, float]]) -> Factor | int:
    """L D Lᵀ of a symmetric matrix given by its rows; or the number of a node that nothing holds."""
    left = [dict(row) for row in rows]
    first = [row.get(i, 0.0) for i, row in enumerate(left)]
    heap = [(len(row), i) for i, row in enumerate(left)]
    heapify(heap)
    done: set[int] = set()
    order: list[int] = []
    columns: list[dict[int, float]] = []
    inverse: list[float] = []
    while heap:
        size, i = heappop(heap)
        if i in done or size != len(left[i]):
            continue
        done.add(i)
        row = left[i]
        pivot = row.pop(i, 0.0)
        if not pivot > _LEAST_PIVOT * first[i]:
            return i
        column = {j: value / pivot for j, value in row.items()}
        for j, share in column.items():
            del left[j][i]
            for k, value in row.items():
                left[j][k] = left[j].get(k, 0.0) - share * value
            heappush(heap, (len(left[j]), j))
        order.append(i)
        columns.append(column)
        inverse.append(1.0 / pivot)
    place = {node: at for at, node in enumerate(order)}
    numbered = tuple(tuple(sorted((place[j], value) for j, value in c.items())) for c in columns)
    return Factor(tuple(order), tuple(inverse), numbered)
