"""The grid of a storage function: its readings, the longest move, what moves cost, what is known in the end.

The law of these costs stands in `grid`.
"""

from __future__ import annotations

import base64
import zlib
from fractions import Fraction
from itertools import product
from math import ceil, prod
from struct import unpack
from typing import Any

from ..contact.law import Law, Losses
from ..document.fields import Number, Read, Whole
from ..document.number import down
from ..document.refusal import Invalid, reserve, spend

# Numbers of a storage function or a table: of 64 bits, little-endian, deflated, in base 64.

WHOLE, DOUBLE = "<i8", "<f8"


def values_of(text: str, shape: tuple[int, ...], kind: str = WHOLE) -> Any:
    """An array of that shape, exactly."""
    import numpy as np  # loaded only where a storage function is to be checked

    return np.frombuffer(_unpacked(text, prod(shape)), dtype=kind).reshape(shape)


def listed(text: str, count: int, kind: str = WHOLE) -> list[Any]:
    """The same as a list."""
    return list(unpack(f"<{count}{'d' if kind == DOUBLE else 'q'}", _unpacked(text, count)))


def _unpacked(text: str, count: int) -> bytes:
    size = 8 * count
    reserve(2 * size)
    spend(0.1 * count)
    try:
        packed = base64.b64decode(text, validate=True)
        raw = zlib.decompressobj().decompress(packed, size + 1)
    except (ValueError, zlib.error) as error:
        raise Invalid(f"a storage function or table cannot be unpacked: {error}") from None
    if len(raw) != size:
        raise Invalid("the storage function has not one value for each state")
    return raw


def storage_of(text: str, shape: tuple[int, ...]) -> Any:
    """V, which is nowhere below 0."""
    value = values_of(text, shape)
    if value.min() < 0:
        raise Invalid("a storage function must be bounded below by 0")
    return value


MOST_VALUES = 60_000_000
MOST_MOVES = 10_000_000
AT_ONCE, ROOM = 1 << 15, 1 << 19
"""Moves of one distance that are looked at together, so few that the processor has them at hand; numbers."""
MOVE, PLACE, FOUND, CALL = 1 / 80, 0.1, 0.3, 15.0
"""Steps of work for a move; for a place that it may lead to, once for each state, and once more for all that
lead to the same ones; and for an operation on a block of states, however few.
"""
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

    count = ceil(max_move * steps * part) + 1
    reserve(100 * count * (1 + len(losses.models)))
    spend(15 * count * len(losses.models))
    far = np.arange(count, dtype=object)
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


def spend_moves(states: int, groups: int, places: int, nodes: int, parts: int = 1, slower: float = 1) -> None:
    """Before all moves from the nodes of so many states, which in groups lead to the same places."""
    reserve(32 * places)
    call = CALL / at_once(nodes, places)
    of_state = PLACE + nodes * MOVE * slower + 2 * call
    of_group = FOUND + (parts - 1) * places * MOVE + 10 * call
    spend(places * (states * of_state + groups * of_group + 10 * CALL))


def at_once(nodes: int, places: int) -> int:
    """So many states are looked at together."""
    return max(1, min(AT_ONCE // nodes, ROOM // places))


def histories_of(reach: int, memory: int) -> list[tuple[int, ...]]:
    return list(product(range(-reach, reach + 1), repeat=memory))
