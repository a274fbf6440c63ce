"""A storage function of a law that relaxes: re-checked at every level, and where a move passes one.

The law adds y = g (u − a) with a' = p a + (1 − p) u.  V is given at levels of a and
is meant to be linear between them, as it is between nodes.  Along a between two
levels, V(s, a) + f(a) d is linear and V(s', a') has one kink at most, where a' passes
a level.  So what holds at both levels and there holds between.
"""

from __future__ import annotations

from fractions import Fraction
from math import ceil
from typing import Any

from ..contact.law import Law, Losses
from ..document.effort import reserve, spend
from ..document.fields import Read
from ..document.refusal import Invalid
from .domain import MOST_MOVES, MOST_VALUES, costs_of, histories_of, proved, spend_moves
from .packed import storage_of

PART = 2**16
SLOWER = 8
"""Than a move without levels."""
_MOST = 2**61


def storage_of_relaxing(told: Read, losses: Losses, law: Law) -> str:
    """Check every move; says what was proved."""
    import numpy as np

    from .moves import violated_relaxing

    assert law.relaxing is not None
    if law.limit is not None:
        raise Invalid("a force limit together with a law that relaxes is not covered")
    domain, unit = told.domain, told.force_unit
    low, high, per_count = domain.lowest_count, domain.highest_count, domain.levels_per_count
    max_move, steps = domain.largest_move_counts, domain.steps_per_count
    reach = ceil(max_move)
    least = 0 if law.surface == "penetration" else low
    top = max(high, least + 1)
    if law.resets and top < 0:
        raise Invalid("the grid must hold 0, where the average begins anew")
    levels = (top - least) * per_count + 1
    columns = (2 * reach + 1) ** losses.delay
    if reach * steps > MOST_MOVES:
        raise Invalid("the moves are longer than can be checked")
    if high < low or (high - low + 1) * columns * levels * (steps + 1) > MOST_VALUES:
        raise Invalid("the grid is empty, or larger than can be checked")
    states = (high - low + 1) * columns * levels * (steps + 1)
    pairs, bits = states // (steps + 1), law.relaxing[0].denominator.bit_length()
    spend(30 * pairs // levels * (losses.delay + 1) + 8 * pairs, bits, 64)
    places = 2 * min(reach, high - low) * steps + steps + 1
    reserve(24 * (states + places * levels))
    spend_moves(pairs, 2 * pairs, places, steps + 1, slower=SLOWER)
    if law.surface == "penetration" and low > 1 - (losses.delay + 1) * reach:
        raise Invalid("the grid must reach so far out that a hand beyond it feels no force")
    value = storage_of(told.storage, (high - low + 1, columns, levels, steps + 1))
    spring = int(law.taps[0] * losses.resolution // unit)
    branch = int(law.relaxing[1] * losses.resolution / per_count // unit)
    farthest = max(-low, high)
    if abs(spring) * farthest + abs(branch) * levels >= _MOST:
        raise Invalid("the forces are too large to be compared exactly")
    off = farthest + 2 + 2 * levels + 2
    costs = costs_of(losses, unit, off, Fraction(1), max_move, steps)
    forces = _forces(law, spring, branch, low, high, least, per_count, levels)
    images = _images(law, low, high, least, per_count, levels)
    rows = _rows(low, high, reach, losses.delay)
    span = int(value.max()) + 2 * int(np.abs(forces).max()) * len(costs) + int(abs(costs).max())
    rise = int(np.abs(np.diff(value, axis=2)).max()) + 2 * abs(branch) * len(costs)
    if span >= _MOST or max(rise, int(np.abs(forces).max()) * len(costs)) * PART >= 2**62:
        raise Invalid("the numbers are too large to be compared exactly")
    if violated_relaxing(value, rows, forces, images, costs, reach):
        raise Invalid("a move takes out more energy than was stored")
    return proved(domain, losses, law)


def _forces(
    law: Law, spring: int, branch: int, low: int, high: int, least: int, per_count: int, levels: int
) -> Any:
    """Force by reading and level, for a move inwards and for one outwards."""
    import numpy as np

    readings = np.arange(low, high + 1)[:, None]
    u = np.maximum(readings, 0) if law.surface == "penetration" else readings
    line = spring * u + branch * ((u - least) * per_count - np.arange(levels))
    if law.surface != "none":
        line = np.where(readings > 0, line, 0)
    if not law.clamped:
        return np.stack([line, line])
    # max(0, f) is no line where f changes its sign: inwards, 0 is below it and costs the hand less
    ends = np.pad(line, ((0, 0), (1, 1)), mode="edge")
    near = np.minimum(np.minimum(ends[:, :-2], ends[:, 2:]), line)
    return np.stack([np.where(near <= 0, 0, line), np.maximum(line, 0)])


def _images(law: Law, low: int, high: int, least: int, per_count: int, levels: int) -> Any:
    """Where a level goes under each reading, rounded down and up to PART of a level."""
    import numpy as np

    assert law.relaxing is not None
    pole: Fraction = law.relaxing[0]
    per_level = np.arange(levels, dtype=object) * PART * pole.numerator
    both = np.zeros((2, high - low + 1, levels), dtype=np.int64)
    for n in range(low, high + 1):
        u = max(n, 0) if law.surface == "penetration" else n
        image = per_level + (pole.denominator - pole.numerator) * (u - least) * per_count * PART
        if law.resets and u <= 0:
            image[:] = -least * per_count * PART * pole.denominator
        both[0, n - low] = image // pole.denominator
        both[1, n - low] = -(-image // pole.denominator)
    return both


def _rows(low: int, high: int, reach: int, delay: int) -> Any:
    """The row of the reading from which the acting force was computed; −1 if a reading is off the grid."""
    import numpy as np

    columns = histories_of(reach, delay)
    out = np.full((high - low + 1, len(columns)), -1, dtype=np.int64)
    for n in range(low, high + 1):
        for c, differences in enumerate(columns):
            readings = [n + sum(differences[:k]) for k in range(delay + 1)]
            if all(low <= r <= high for r in readings):
                out[n - low, c] = readings[-1] - low
    return out
