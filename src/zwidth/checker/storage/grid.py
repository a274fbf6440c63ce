"""A storage function re-checked: no move of the hand takes out more energy than V falls.

The document gives V on a grid: cells of one encoder count, M steps in each,
and every remembered reading.  Whole numbers throughout: forces in multiples of
a unit, energies in multiples of unit × step.  Between two neighbouring nodes V is
meant to be linear.  If for all nodes x, x' that are D steps apart

    V(s, x) ≥ −f (x' − x) − φ D − β (D² − ¼) [D ≥ 2] + V(s', x')

then the same holds for all positions between, with φ |d| + β d²: on both triangles of the
square of two steps, cut where d is constant, V(s, x) − V(s', x') and f d and φ |d| are
linear, and the linear interpolation of D² − ¼ (0 for D ≤ 1) between two neighbouring D
is at most d².

Where a delay changes the force within a sample, the interval is two such moves, the
function between them being the most that the second can lead to.
"""

from __future__ import annotations

from fractions import Fraction
from math import ceil, lcm
from typing import Any

from ..contact.law import LAW, LOSSES, Law, Losses, law_of, losses_of
from ..document.effort import reserve, spend
from ..document.fields import Number, Packed, Read, Record, Whole, document, only_if
from ..document.refusal import Invalid
from .domain import DOMAIN, MOST_MOVES, MOST_VALUES, costs_of, proved, spend_moves
from .packed import storage_of
from .relaxing import storage_of_relaxing

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
