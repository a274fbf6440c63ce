"""A storage function re-checked: no move of the hand takes out more energy than V falls.

The document gives V on a grid: cells of one encoder count, M steps in each, and every remembered reading.
Whole numbers throughout: forces in multiples of a unit, energies in multiples of unit × step.  Between two
neighbouring nodes V is meant to be linear.  If for all nodes x, x' that are D steps apart

    V(s, x) ≥ −f (x' − x) − φ D − β (D² − ¼) [D ≥ 2] + V(s', x')

then the same holds for all positions between, with φ |d| + β d²: on both triangles of the square of two
steps, cut where d is constant, V(s, x) − V(s', x') and f d and φ |d| are linear, and the linear interpolation
of D² − ¼ (0 for D ≤ 1) between two neighbouring D is at most d².

Where a delay changes the force within a sample, the interval is two such moves, the
function between them being the most that the second can lead to.
"""

from __future__ import annotations

from fractions import Fraction
from math import ceil, lcm
from typing import Any

from ..contact.law import LAW, LOSSES, Law, Losses, law_of, losses_of
from ..document.fields import Number, Packed, Read, Record, Whole, document
from ..document.refusal import Invalid, only_if, reserve, spend
from .domain import DOMAIN, MOST_MOVES, MOST_VALUES, costs_of, histories_of, proved, spend_moves, storage_of

_EXACT = 2**53
AT_ONCE = 10**5
"""Forces computed at once in whole numbers of any size, which take room."""
STORAGE = document(
    {
        "loop": LOSSES,
        "law": LAW,
        "domain": Record({**DOMAIN, "levels_per_count": Whole(least=1, most=MOST_MOVES, default=None)}),
        "force_unit": Number(above=0, shown=False),
        "storage": Packed(),
    }
)


def storage(told: Read) -> str:
    """Say what was proved."""
    import numpy as np  # loaded only where a storage function is to be checked

    losses, law, domain = losses_of(told.loop), law_of(told.law), told.domain
    only_if(law.relaxing, domain.levels_per_count, "levels_per_count")
    if law.relaxing is not None:
        if losses.part < 1 or losses.curve:
            raise Invalid("laws that relax are checked for delays of whole samples and one friction model")
        return storage_of_relaxing(told, losses, law)
    low, high = domain.lowest_count, domain.highest_count
    max_move, steps, unit = domain.largest_move_counts, domain.steps_per_count, told.force_unit
    reach = ceil(max_move)
    memory = law.memory + losses.delay
    width, cells = 2 * reach + 1, high - low + 1
    if cells < 1 or reach * steps > MOST_MOVES:
        raise Invalid("the grid is empty, or its moves are longer than can be checked")
    states = cells * width**memory
    if states * (steps + 1) > MOST_VALUES:
        raise Invalid("the grid is larger than can be checked")
    reserve(16 * states * (steps + 1) + 8 * (states + width**memory) * (memory + 3))
    parts = 1 if losses.part == 1 else 2
    if law.step is None and not law.rate:
        spend(parts * 0.2 * (memory + 2) * states)
    else:
        spend(parts * (10 * states + (100 * cells * width if law.points else 0)))
    places = 2 * min(reach, cells - 1) * steps + steps + 1
    spend_moves(states, states // (width if memory else 1), places, steps + 1, parts)
    _require_small(law, losses, unit, max(-low, high), reach)
    if law.surface != "none" and low > 1 - (memory + 1) * reach:
        raise Invalid("the grid must reach so far out that a hand beyond it has been forgotten")
    shape = (cells, width**memory, steps + 1)
    value = storage_of(told.storage, shape)
    moves = []  # of one interval: the forces, and what a move costs
    for age, part in ((losses.delay, losses.part), (losses.delay - 1, 1 - losses.part)):
        if part > 0:
            forces, off = _forces(law, losses, unit, low, high, reach, memory, age)
            moves.append((forces, costs_of(losses, unit, off, part, max_move, steps)))
    largest = int(value.max())
    for forces, costs in moves:
        largest += int(abs(costs).max()) + int(np.abs(forces).max()) * (reach + 1) * steps
    if largest >= _EXACT:
        raise Invalid("the numbers are too large to be compared exactly")
    exists = _exists(low, high, reach, memory)
    from .moves import violated

    if violated(value, exists, moves, 0, reach):
        raise Invalid("a move takes out more energy than was stored")
    return proved(told.domain, losses, law)


def _require_small(law: Law, losses: Losses, unit: Fraction, farthest: int, reach: int) -> None:
    """Forces must fit their numbers before they are multiplied."""
    most = sum((abs(c) for c in law.taps), Fraction(0)) * losses.resolution * farthest
    highest = max((abs(f) for _, f in law.points), default=Fraction(0))
    most += highest * (1 + abs(law.rate) * losses.resolution * reach) + (law.limit or 0) + (law.step or 0)
    if most / unit >= _EXACT:
        raise Invalid("the forces are too large to be compared exactly")


def _exists(low: int, high: int, reach: int, memory: int) -> Any:
    """Which states there are: all remembered readings on the grid."""
    import numpy as np

    out = np.ones((high - low + 1, (2 * reach + 1) ** memory), dtype=np.bool_)
    cells = np.arange(low, high + 1)
    for back in np.cumsum(_columns(reach, memory), axis=1).T:
        reading = cells[:, None] + back[None, :]
        out &= (reading >= low) & (reading <= high)
    return out


def _columns(reach: int, memory: int) -> Any:
    """The histories of `histories_of`, one in each row of an array."""
    import numpy as np

    width = 2 * reach + 1
    places, out = np.arange(width**memory), np.empty((width**memory, memory), dtype=np.int64)
    for k in range(memory):
        out[:, k] = places // width ** (memory - 1 - k) % width - reach
    return out


def _forces(
    law: Law, losses: Losses, unit: Fraction, low: int, high: int, reach: int, memory: int, age: int
) -> tuple[Any, int]:
    """Every state's force of a reading's age in units, and by how many units one may be off."""
    import numpy as np

    cells = np.arange(low, high + 1, dtype=np.int64)
    columns = _columns(reach, memory)
    ages = [cells[:, None] + columns[:, :a].sum(axis=1)[None, :] for a in range(memory + 1)]
    ages = [np.broadcast_to(a, (len(cells), len(columns))) for a in ages]
    ages = ages[age : age + law.memory + 1]
    if law.step is not None or law.rate:
        rows = max(1, AT_ONCE // len(columns))
        parts = [slice(first, first + rows) for first in range(0, len(cells), rows)]
        total = np.concatenate([_unrounded(law, losses, unit, [a[part] for a in ages]) for part in parts])
    elif law.points:
        table = [int(law._spring(n * losses.resolution) // unit) for n in range(low, high + 1)]
        total = np.array(table, dtype=np.int64)[np.clip(ages[0], low, high) - low]
    else:
        total = np.zeros((len(cells), len(columns)), dtype=np.int64)
        for c, reading in zip(law.taps, ages, strict=True):
            u = np.where(reading > 0, reading, 0) if law.surface == "penetration" else reading
            total = total + int(c * losses.resolution // unit) * u
    if law.clamped:
        total = np.where(total < 0, 0, total)
    if law.limit is not None:
        most = int(law.limit // unit)
        total = np.minimum(np.maximum(total, -most), most)
    if law.surface != "none":
        total = np.where(ages[0] <= 0, 0, total)
    off = len(law.taps) * max(-low, high) + 2  # each tap is rounded down, times a reading
    return total, off


def _unrounded(law: Law, losses: Losses, unit: Fraction, ages: list[Any]) -> Any:
    """The forces of some states before clamp and limit, in units: the only rounding comes last."""
    import numpy as np

    if law.points:
        moved = ages[0] - ages[1] if law.rate else 0 * ages[0]
        several, place = np.unique(np.stack([ages[0].ravel(), moved.ravel()]), axis=1, return_inverse=True)
        springs = {n: law._spring(int(n) * losses.resolution) for n in np.unique(several[0])}
        rise = law.rate * losses.resolution
        wished = [springs[n] * (1 + rise * int(e)) for n, e in several.T]
    else:
        fed = [np.where(a > 0, a, 0) if law.surface == "penetration" else a for a in ages]
        per_count = [c * losses.resolution for c in law.taps]
        whole = lcm(*(c.denominator for c in per_count))
        parts: Any = sum(int(c * whole) * a.astype(object) for c, a in zip(per_count, fed, strict=True))
        assert law.step is not None
        step, of_units = law.step * whole, law.step / unit
        steps = (2 * parts * step.denominator + step.numerator) // (2 * step.numerator)
        return (steps * of_units.numerator // of_units.denominator).astype(np.int64)
    if law.step is not None:
        wished = [(w / law.step + Fraction(1, 2)) // 1 * law.step for w in wished]
    units = np.array([int(w // unit) for w in wished], dtype=np.int64)
    return units[place].reshape(ages[0].shape)


# A storage function of a law that relaxes: re-checked at every level, and where a move passes one.
#
# The law adds y = g (u − a) with a' = p a + (1 − p) u.  V is given at levels of a and
# is meant to be linear between them, as it is between nodes.  Along a between two
# levels, V(s, a) + f(a) d is linear and V(s', a') has one kink at most, where a' passes
# a level.  So what holds at both levels and there holds between.


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
    forces = _level_forces(law, spring, branch, low, high, least, per_count, levels)
    images = _images(law, low, high, least, per_count, levels)
    rows = _rows(low, high, reach, losses.delay)
    span = int(value.max()) + 2 * int(np.abs(forces).max()) * len(costs) + int(abs(costs).max())
    rise = int(np.abs(np.diff(value, axis=2)).max()) + 2 * abs(branch) * len(costs)
    if span >= _MOST or max(rise, int(np.abs(forces).max()) * len(costs)) * PART >= 2**62:
        raise Invalid("the numbers are too large to be compared exactly")
    if violated_relaxing(value, rows, forces, images, costs, reach):
        raise Invalid("a move takes out more energy than was stored")
    return proved(domain, losses, law)


def _level_forces(
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
