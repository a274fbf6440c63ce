"""Motor and handle over a stretch that comes again, in a few products: what the series make of unit starts.

Between events the motion is linear in z = (v₂, v₁ − v₂, a₂, a₁ − a₂, the speed of the anchor): its end is a
matrix times z, and each energy a quadratic form in z.  What both do alike cancels before it is squared.  The
table of these is made once for a length, and used only where no event can be inside: a side goes on sliding
while its velocity at both ends is beyond an eighth of what v'' h² may be, and goes on sticking while all that
may come to its force stays within stiction.

A matrix repeats its rounding every time, and nothing but damping takes that away; and where one damper takes
nearly all within a stretch, a form is a small difference.  There the series remain.
"""

from __future__ import annotations

from typing import NamedTuple

from zwidth.loop.plant import TERMS, integral, product_integral, value
from zwidth.loop.two_bodies import (
    APART,
    ON_1,
    ON_2,
    SERIES_OF_TWO,
    V1,
    V2,
    X1,
    X2,
    Start,
    TwoMasses,
    expand_two,
    is_free,
    pieces_of_two,
)
from zwidth.native.compiled import Array, compiled

_INPUTS = 5
_PAIRS = _INPUTS * (_INPUTS + 1) // 2
# The table: its length h (−h where it is not to be used), then a row each of what velocities and ways gain,
# of the ways' integrals and of what bounds an event, then the forms of ∫v₁², ∫v₂² and ∫(v₁ − v₂)².
_FASTER_1, _FASTER_2, _MOVED_1, _MOVED_2, _AREA_1, _AREA_2, _BOUND_1, _BOUND_2, _FORMS = range(
    1, 2 + 8 * _INPUTS, _INPUTS
)
_SQUARE_1, _SQUARE_2, _SQUARE_APART = (_FORMS + _PAIRS * i for i in range(3))
_TABLE = _FORMS + 3 * _PAIRS

_BLOCK = SERIES_OF_TWO + 2
"""Of one input while a table is made: its series, and the forces on both at rest."""
_MOTIONS = 3
"""The motor moves, the handle, or both."""
_STARTS = SERIES_OF_TWO
_TABLES = _STARTS + _INPUTS
_BLOCKS = _TABLES + 2 * _MOTIONS * _TABLE
WORK_OF_TWO = _BLOCKS + _INPUTS * _BLOCK
"""Length of the scratch array: series, z, the tables of two stretches, and room to make them."""

_LEAST, _MOST = 1e-4, 10.0
"""Of what damping takes in a stretch, the least of two bodies and the most: rates times its length."""


class Course(NamedTuple):
    """How a stretch went: its time, velocities and directions after it, ways and their integrals, the work of
    the actuator, ∫v₁², ∫v₂² and ∫(v₁ − v₂)²."""

    t: float
    to_1: float
    after_1: float
    to_2: float
    after_2: float
    moved_1: float
    moved_2: float
    way_1: float
    way_2: float
    taken: float
    fast_1: float
    fast_2: float
    apart: float


@compiled
def at_once(two: TwoMasses, start: Start, force: float, h: float, place: int, work: Array) -> Course:
    """The stretch by its table; its t is 0 where there is none, or where a body may stop or start inside.

    `place` tells the first stretch of a sample, 0, from the second, 1; −1 is of one that may not come again.
    """
    none = Course(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    at = _table(two, start, h, place, work)
    if at == 0:
        return none
    _set_start(two, start, work)
    to_1, to_2 = start.v1 + _row(work, at + _FASTER_1), start.v2 + _row(work, at + _FASTER_2)
    if not _goes_on(work, at + _BOUND_1, start.side_1, start.v1, to_1, start.on_1, two.motor.stiction):
        return none
    stiction = two.handle.stiction if two.driven == 0.0 else 0.0
    if not _goes_on(work, at + _BOUND_2, start.side_2, start.v2, to_2, start.on_2, stiction):
        return none
    moved_1, moved_2, way_1, way_2 = _row(work, at + _MOVED_1), _row(work, at + _MOVED_2), 0.0, 0.0
    if two.driven > 0.0 or two.handle.stiffness > 0.0:
        way_1, way_2 = _row(work, at + _AREA_1), _row(work, at + _AREA_2)
    return Course(
        h, to_1, start.side_1, to_2, start.side_2, moved_1, moved_2, way_1, way_2, force * moved_1,
        _form(work, at + _SQUARE_1), _form(work, at + _SQUARE_2),
        _form(work, at + _SQUARE_APART) if two.damper > 0.0 else 0.0,
    )  # fmt: skip


@compiled
def _table(two: TwoMasses, start: Start, h: float, place: int, work: Array) -> int:
    """Where it is in `work`, made if it is not there; 0 without one."""
    motion = (1 if start.side_1 != 0.0 else 0) + (2 if is_free(two, start.side_2) else 0)
    if place < 0 or motion == 0:
        return 0
    at = _TABLES + (_MOTIONS * place + motion - 1) * _TABLE
    if abs(work[at]) != h:
        for i in range(_TABLE):
            work[at + i] = 0.0
        work[at] = -h
        if _is_damped(two, h):
            work[at] = h
            _make(work[at : at + _TABLE], work[_BLOCKS:WORK_OF_TWO], two, start, h)
    return at if work[at] > 0.0 else 0


@compiled
def _is_damped(two: TwoMasses, h: float) -> bool:
    """Whether every motion loses a share of its energy, and none nearly all at once."""
    first, hand, c = two.motor, two.handle, two.damper
    over_1 = h / first.mass
    if two.driven > 0.0:
        return _LEAST <= (first.damping + c) * over_1 <= _MOST
    over_2, b1, b2 = h / (hand.mass + hand.hand_mass), first.damping, hand.damping + hand.hand_damping
    most = (b1 + c) * over_1 + (b2 + c) * over_2
    return most <= _MOST and (b1 * b2 + c * (b1 + b2)) * over_1 * over_2 >= _LEAST * most


@compiled
def _make(table: Array, work: Array, two: TwoMasses, start: Start, h: float) -> None:
    parts = pieces_of_two(two, h)
    length, part = h / parts, 0.0
    first, hand = two.motor, two.handle
    drag_1, drag_2 = first.damping + two.damper, hand.damping + hand.hand_damping + two.damper
    mass = hand.mass + hand.hand_mass
    for i in range(_INPUTS):
        at = i * _BLOCK + SERIES_OF_TWO
        work[at] = (drag_1 if i <= 1 else 0.0) + (first.mass if i == 2 or i == 3 else 0.0)
        work[at + 1] = (drag_2 if i == 0 else 0.0) + (mass if i == 2 else 0.0)
    while part < parts:
        for i in range(_INPUTS):
            _follow(table, work[i * _BLOCK : (i + 1) * _BLOCK], two, start, i, length, parts)
        _add_squares(table, work, _SQUARE_1, V1, length)
        _add_squares(table, work, _SQUARE_2, V2, length)
        _add_squares(table, work, _SQUARE_APART, APART, length)
        part += 1.0


@compiled
def _follow(table: Array, block: Array, two: TwoMasses, start: Start, i: int, h: float, parts: float) -> None:
    """One input over one piece of the stretch; its series stay in the block."""
    for n in range(SERIES_OF_TWO):
        block[n] = 0.0
    v1 = (1.0 if i <= 1 else 0.0) + table[_FASTER_1 + i]
    v2 = (1.0 if i == 0 else 0.0) + table[_FASTER_2 + i]
    on_1, on_2, speed = block[SERIES_OF_TWO], block[SERIES_OF_TWO + 1], 1.0 if i == 4 else 0.0
    expand_two(two, Start(v1, v2, start.side_1, start.side_2, on_1, on_2, speed), 0.0, 0.0, h, block)
    table[_AREA_1 + i] += h * (table[_MOVED_1 + i] + integral(block, X1, TERMS, 1.0))
    table[_AREA_2 + i] += h * (table[_MOVED_2 + i] + integral(block, X2, TERMS, 1.0))
    table[_MOVED_1 + i] += value(block, X1, TERMS, 1.0)
    table[_MOVED_2 + i] += value(block, X2, TERMS, 1.0)
    table[_FASTER_1 + i] += value(block, V1 + 1, TERMS - 1, 1.0)
    table[_FASTER_2 + i] += value(block, V2 + 1, TERMS - 1, 1.0)
    block[SERIES_OF_TWO] += value(block, ON_1 + 1, TERMS - 1, 1.0)
    block[SERIES_OF_TWO + 1] += value(block, ON_2 + 1, TERMS - 1, 1.0)
    table[_BOUND_1 + i] = _bound(block, table[_BOUND_1 + i], V1, ON_1, start.side_1 != 0.0, parts)
    table[_BOUND_2 + i] = _bound(block, table[_BOUND_2 + i], V2, ON_2, is_free(two, start.side_2), parts)


@compiled
def _bound(block: Array, before: float, own: int, on: int, free: bool, parts: float) -> float:
    """An eighth of the most that v'' h² is; or what the force on a body that sticks may change by."""
    most = 0.0
    for n in range(1, TERMS):
        most += 0.125 * parts * parts * n * (n - 1.0) * abs(block[own + n]) if free else abs(block[on + n])
    return max(before, most) if free else before + most


@compiled
def _add_squares(table: Array, work: Array, at: int, own: int, length: float) -> None:
    for i in range(_INPUTS):
        for j in range(i + 1):
            product = product_integral(work, i * _BLOCK + own, j * _BLOCK + own, TERMS, 1.0)
            table[at] += length * (product if i == j else 2.0 * product)
            at += 1


@compiled
def _set_start(two: TwoMasses, start: Start, work: Array) -> None:
    """Write down z."""
    first, hand, v1, v2, a1, a2 = two.motor, two.handle, start.v1, start.v2, 0.0, 0.0
    if start.side_1 != 0.0:
        a1 = (start.on_1 - (first.damping + two.damper) * v1) / first.mass
    if is_free(two, start.side_2):
        drag = hand.damping + hand.hand_damping + two.damper
        a2 = (start.on_2 - drag * v2) / (hand.mass + hand.hand_mass)
    work[_STARTS], work[_STARTS + 1], work[_STARTS + 2] = v2, v1 - v2, a2
    work[_STARTS + 3], work[_STARTS + 4] = a1 - a2, start.speed


@compiled
def _row(work: Array, at: int) -> float:
    """Of the table, times z."""
    z = _STARTS
    total = work[at] * work[z] + work[at + 1] * work[z + 1] + work[at + 2] * work[z + 2]
    return total + (work[at + 3] * work[z + 3] + work[at + 4] * work[z + 4])


@compiled
def _form(work: Array, at: int) -> float:
    """Of the table, with z on both sides."""
    a, b, c = work[_STARTS], work[_STARTS + 1], work[_STARTS + 2]
    d, e = work[_STARTS + 3], work[_STARTS + 4]
    total = a * a * work[at] + b * (a * work[at + 1] + b * work[at + 2])
    total += c * (a * work[at + 3] + b * work[at + 4] + c * work[at + 5])
    total += d * (a * work[at + 6] + b * work[at + 7] + c * work[at + 8] + d * work[at + 9])
    rest = a * work[at + 10] + b * work[at + 11] + c * work[at + 12]
    return total + e * (rest + d * work[at + 13] + e * work[at + 14])


@compiled
def _goes_on(
    work: Array, at: int, side: float, before: float, after: float, on: float, stiction: float
) -> bool:
    """Whether a body certainly slides, or sticks, through all the stretch."""
    if stiction == 0.0:
        return True
    z, reach = _STARTS, 0.0
    for i in range(_INPUTS):
        reach += work[at + i] * abs(work[z + i])
    if side == 0.0:
        return abs(on) + reach <= stiction
    return min(side * before, side * after) > reach
