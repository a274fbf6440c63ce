"""A storage function on cells of any length re-checked: the encoder is finer than what is looked at.

y = x − Δ: the law acts inside where the reading is above 0, exactly where y ≥ 0, and every reading q is
y + Δ/2 but for Δ/2.  So a law of readings, f = Σ c_j q_{k−j}, is F = Σ c_j (y_{k−j} + Δ/2), but for ‖c‖₁ Δ/2,
which Coulomb friction pays for.  F is linear between the cells' ends in all coordinates y_k, y_{k−1}, …

V is given at these ends and linear on the simplices between them that are cut where y_i − y_j is whole.
There y' − y is D or D + 1, and F at the corners differs by κ h at most, κ = max(Σ c⁺, Σ c⁻).  So for a
cost of φ |d| + β d²

    V(s) ≥ −F (y' − y) − φ D − L(D) + V(s'),   L(0) = 0,  L(1) = −κ h²,  L(D) = β D² h² − (β + κ) h²/4

at the corners is enough for all positions between.  At y = 0 all has two values, from outside and inside.
"""

from __future__ import annotations

from fractions import Fraction
from math import ceil
from typing import Any, NamedTuple

from ..contact.law import LAW, LOSSES, MOST_TAPS, Law, Losses, law_of, losses_of
from ..document.fields import Number, Packed, Read, Record, Whole, document
from ..document.number import down
from ..document.refusal import Invalid, reserve, spend
from .domain import histories_of, spend_moves, storage_of

MOST_VALUES = 4_000_000
MOST_CELLS = 100_000
_EXACT = 2**53

COARSE_STORAGE = document(
    {
        "loop": LOSSES,
        "law": LAW,
        "domain": Record(
            {
                "lowest_cell": Whole(least=-MOST_CELLS, most=-1),
                "highest_cell": Whole(least=1, most=MOST_CELLS),
                "counts_per_cell": Number(above=0),
                "largest_move_cells": Number(above=0, most=MOST_CELLS),
                "remembered": Whole(least=0, most=2 * MOST_TAPS),
            }
        ),
        "force_unit": Number(above=0, shown=False),
        "storage": Packed(),
    }
)


class _Line(NamedTuple):
    """Cells of length h from low to high; moves of so many cells; the corners' places, whether inside."""

    length: Fraction
    max_move: Fraction
    reach: int
    memory: int
    places: list[int]
    inside: list[bool]


def coarse_storage(told: Read) -> str:
    """Say what was proved."""
    import numpy as np  # loaded only where a storage function is to be checked

    losses, law = losses_of(told.loop), law_of(told.law)
    if law.points or law.clamped or law.relaxing or law.limit is not None or law.step is not None:
        raise Invalid("cells of any length are for laws that are linear inside")
    if losses.curve:
        raise Invalid("cells of any length are for one friction model")
    line, unit = _line(told.domain, losses, law), told.force_unit
    width = 2 * line.reach + 1
    shape = (len(line.places), width**line.memory)
    if shape[0] * shape[1] > MOST_VALUES:
        raise Invalid("the grid is larger than can be checked")
    reserve(60 * shape[0] * shape[1])
    states, parts = shape[0] * shape[1], 1 if losses.part == 1 else 2
    spend(0.5 * states * (line.memory + 2) * parts)
    places = 2 * min(line.reach, shape[0] - 1) + 1
    spend_moves(states, states // (width if line.memory else 1), places, 1, parts)
    value = storage_of(told.storage, shape)
    moves = []
    for age, part in ((losses.delay, losses.part), (losses.delay - 1, 1 - losses.part)):
        if part > 0:
            forces, off = _forces(law, losses, line, unit, age)
            moves.append((forces, _costs(law, losses, line, unit, off, part)))
    largest = int(value.max())
    for forces, costs in moves:
        largest += int(abs(costs).max()) + int(np.abs(forces).max()) * (line.reach + 1)
    if largest >= _EXACT:
        raise Invalid("the numbers are too large to be compared exactly")
    from .moves import violated

    if violated(value[:, :, None], _exists(line), moves, line.inside.index(True), line.reach):
        raise Invalid("a move takes out more energy than was stored")
    return proved(told, losses)


def proved(told: Read, losses: Losses) -> str:
    """What is known of a line once every move was tried."""
    cell = told.domain.counts_per_cell * losses.resolution
    farthest, speed = told.domain.highest_cell * cell, told.domain.largest_move_cells * cell / losses.period
    length = "rad" if told.units == "rotary" else "m"
    return (
        "no move takes out more than the storage function falls, at any position up to "
        f"{down(farthest)} {length} and at any count, for hands of up to "
        f"{down(speed)} {length}/s over each time in which one force is held"
    )


def _line(domain: Read, losses: Losses, law: Law) -> _Line:
    low, high, max_move = domain.lowest_cell, domain.highest_cell, domain.largest_move_cells
    length = domain.counts_per_cell * losses.resolution
    if high - low > MOST_CELLS:
        raise Invalid("the grid has more cells than can be checked")
    memory = law.memory + losses.delay
    if law.surface != "none" and low > -(memory + 1) * max_move:
        raise Invalid("the grid must reach so far out that a hand beyond it has been forgotten")
    if law.surface == "none" and low * length + losses.resolution > -high * length:
        raise Invalid("the grid must reach as far on the one side as on the other")
    if domain.remembered != memory:
        raise Invalid("the law remembers another number of readings")
    sheets = law.surface != "none"
    places = [*range(low, 1), *range(0 if sheets else 1, high + 1)]
    inside = [not sheets or k >= 1 - low for k in range(len(places))]
    return _Line(length, max_move, ceil(max_move) + sheets, memory, places, inside)


def _columns(line: _Line) -> Any:
    """The corners that are remembered, by the present one and by history; beyond the grid at its ends."""
    import numpy as np

    histories = histories_of(line.reach, line.memory)
    differences = np.array(histories, dtype=np.int64).reshape(len(histories), line.memory)
    now = np.arange(len(line.places), dtype=np.int64)
    return [now[:, None] + differences[:, :a].sum(axis=1)[None, :] for a in range(line.memory + 1)]


def _exists(line: _Line) -> Any:
    import numpy as np

    out = np.ones((len(line.places), (2 * line.reach + 1) ** line.memory), dtype=np.bool_)
    for corner in _columns(line):
        out &= (corner >= 0) & (corner < len(line.places))
    return out


def _forces(law: Law, losses: Losses, line: _Line, unit: Fraction, age: int) -> tuple[Any, int]:
    """F at every corner in units, and by how many units it may be off."""
    import numpy as np

    farthest = max(abs(place) for place in line.places)
    size = sum((abs(c) for c in law.taps), Fraction(0))
    if size * (line.length * farthest + losses.resolution) / unit >= _EXACT:
        raise Invalid("the forces are too large to be compared exactly")
    places, inside = np.array(line.places, dtype=np.int64), np.array(line.inside)
    corners = [np.clip(corner, 0, len(places) - 1) for corner in _columns(line)][age : age + law.memory + 1]
    total = np.zeros(corners[0].shape, dtype=np.int64)
    for c, corner in zip(law.taps, corners, strict=True):
        per_cell, middle = int(c * line.length // unit), int(c * losses.resolution / 2 // unit)
        fed = per_cell * places[corner] + middle
        total = total + (np.where(inside[corner], fed, 0) if law.surface == "penetration" else fed)
    return np.where(inside[corners[0]], total, 0), len(law.taps) * (farthest + 1)


def _costs(law: Law, losses: Losses, line: _Line, unit: Fraction, off: int, part: Fraction) -> Any:
    """What a move over 0, 1, … cells in a part of the interval costs."""
    import numpy as np

    friction, damping = losses.models[0]
    friction -= sum((abs(c) for c in law.taps), Fraction(0)) * losses.resolution / 2
    rising, falling = (sum((max(sign * c, Fraction(0)) for c in law.taps), Fraction(0)) for sign in (1, -1))
    bend = max(rising, falling)
    drag = damping / (part * losses.period) * line.length // unit
    lost = -(-bend * line.length // unit)
    far = np.arange(ceil(line.max_move * part) + 1, dtype=object)
    curved = np.where(far > 1, drag * far * far - -(-(drag + lost) // 4), np.where(far > 0, -lost, 0))
    return (friction // unit - off) * far + curved
