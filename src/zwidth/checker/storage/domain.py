"""The grid of a storage function: its readings, the longest move, what moves cost, what is known in the end.

The law of these costs stands in `grid`.
"""

from __future__ import annotations

from fractions import Fraction
from itertools import product
from math import ceil
from typing import Any

from ..contact.law import Law, Losses
from ..document.fields import Number, Read, Whole
from ..document.number import down

MOST_VALUES = 60_000_000
MOST_MOVES = 10_000_000
PAIR = 1 / 30
"""What a move from one node to one other costs, in steps of work: 300 million take a second."""

FARTHEST = 10**7
"""Count."""

DOMAIN = {
    "lowest_count": Whole(least=-FARTHEST, most=FARTHEST),
    "highest_count": Whole(least=-FARTHEST, most=FARTHEST),
    "largest_move_counts": Number(above=0, most=MOST_MOVES),
    "steps_per_count": Whole(least=1, most=MOST_MOVES),
}
"""The readings on the grid, and the longest move in one sample."""


def proved(domain: Read, losses: Losses, law: Law) -> str:
    """What is known of a grid once every move was tried."""
    low, high, max_move = domain.lowest_count, domain.highest_count, down(domain.largest_move_counts)
    inside = law.surface != "none" and law.relaxing is None
    side = f"up to {high + 1} counts inside" if inside else f"from {low} to {high + 1} counts"
    return (
        "no move takes out more than the storage function falls, "
        f"at any position {side} and with any memory, for moves of up to {max_move} counts a sample"
        + ("" if losses.part == 1 else ", as fast in each part of a sample with one force")
    )


def costs_of(losses: Losses, unit: Fraction, off: int, part: Fraction, max_move: Fraction, steps: int) -> Any:
    """What a move over 0, 1, … steps in a part of the interval costs."""
    import numpy as np

    far = np.arange(ceil(max_move * steps * part) + 1, dtype=object)
    costs = []
    for friction, damping in losses.models:
        drag = damping / (part * losses.period) * (losses.resolution / steps) // unit
        lost = np.where(far > 1, drag * far * far - -(-drag // 4), 0)
        costs.append((friction // unit - off) * far + lost)
    if len(costs) == 1:
        return costs[0]
    # between two steps only one model counts, and at a step the lesser of the two beside it
    least = [None] * len(far)
    for d in range(len(far) - 1):
        used = max(costs, key=lambda c: c[d] + c[d + 1])
        for end in (d, d + 1):
            least[end] = used[end] if least[end] is None else min(least[end], used[end])
    return np.array(least, dtype=object)


def histories_of(reach: int, memory: int) -> list[tuple[int, ...]]:
    return list(product(range(-reach, reach + 1), repeat=memory))
