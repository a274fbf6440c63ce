"""A symmetric matrix S(x) that depends smoothly on some coordinates is ≻ 0 in a whole box.

With m the middle of a cell and t what x may be off it, |t_j| ≤ h_j, arithmetic with bounds gives

    S(m + t) = M + Σ_j (t_j/h_j) L_j + E,    every entry of |E| within what the second order can make of it

Without E it is linear in t, and ≻ 0 in the cell if it is at the corners. E takes at most Σ_l E_il w_i/w_l
from S_ii, with any w > 0, since 2 |y_i y_l| ≤ y_i² w_i/w_l + y_l² w_l/w_i. A cell where that is not enough is
halved. Positive means that all leading minors are, by fraction-free elimination in whole numbers.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Sequence
from fractions import Fraction
from itertools import product
from math import inf, isqrt
from typing import Any

from ..document.fields import List, Number, Read
from ..document.number import always
from ..document.refusal import Invalid, only_if
from ..exact.enclosed import Enclosed, NotPositive, known

BITS = 80
MOST_WORK = 80_000
"""Cells, times entries of S, times a value and the slopes of each: some six seconds."""
MOST_MOVING = 8
Range = tuple[int, int]
"""Both ends of a coordinate, in units of 2^−BITS."""
Cell = tuple[Range, ...]
Whole = list[list[int]]
Function = Callable[[Sequence[Enclosed]], list[list[Enclosed]]]


def positive_in(box: Cell, matrix: Function, fails: str = "the damping is not enough") -> int:
    """The number of cells that show it, halved where needed.

    `matrix` takes the coordinates and gives the rows of S from the diagonal on; S has as many as there are
    coordinates. `fails`: what it is else.
    """
    moving = sum(map(_moves, box))
    if moving > MOST_MOVING:
        raise Invalid(f"more than {MOST_MOVING} coordinates move")
    most = MOST_WORK // ((1 + moving) * len(box) ** 2)
    waiting, done = deque([box]), 0  # the large ones first: they find soonest what fails
    while waiting:
        cell = waiting.popleft()
        split = _part_to_halve(cell, matrix, fails)
        if split is None:
            done += 1
        else:
            if done + len(waiting) + 2 > most:
                raise Invalid(f"more than {most} cells would be needed")
            low, high = cell[split]
            middle = (low + high) // 2
            waiting += [(*cell[:split], half, *cell[split + 1 :]) for half in ((low, middle), (middle, high))]
    return done


def _part_to_halve(cell: Cell, matrix: Function, fails: str) -> int | None:
    """None where S is ≻ 0 in the cell, else the coordinate along which to halve it."""
    moving = [j for j, ends in enumerate(cell) if _moves(ends)]
    try:
        if _at_corners(*_parted(_over(cell, matrix, moving), len(moving))):
            return None
    except NotPositive:
        pass
    _require_at_middle(cell, matrix, fails)  # it refuses a cell that cannot be halved
    return max(moving, key=lambda j: _moved_by(cell, matrix, j))


def _over(cell: Cell, matrix: Function, moving: Sequence[int]) -> list[list[Enclosed]]:
    """S where these coordinates may be anywhere in the cell, and the others in its middle."""
    return matrix([_coordinate(ends, j, moving) for j, ends in enumerate(cell)])


def _moved_by(cell: Cell, matrix: Function, place: int) -> float:
    """How far one coordinate by itself moves S."""
    middle = tuple(ends if j == place else _middle(ends) for j, ends in enumerate(cell))
    try:
        return sum(x.reach for row in _over(middle, matrix, [place]) for x in row)
    except NotPositive:
        return inf


def _middle(ends: Range) -> Range:
    at = sum(ends) // 2
    return (at, at) if _moves(ends) else ends


def _moves(ends: Range) -> bool:
    """False for one number, rounded outward."""
    return ends[1] - ends[0] > 1


def _coordinate(ends: Range, place: int, moving: Sequence[int]) -> Enclosed:
    """All that it may be in a cell, as a number of its own."""
    low, high = ends
    middle = (low + high) // 2
    if place not in moving:
        return Enclosed(BITS, middle, (), high - middle)
    return Enclosed(BITS, middle, tuple(high - middle if j == place else 0 for j in moving))


def _require_at_middle(cell: Cell, matrix: Function, fails: str) -> None:
    """Refuse at once where S is not ≻ 0 at the middle."""
    middle = [Enclosed(BITS, (low + high) // 2, (), 0 if _moves((low, high)) else 1) for low, high in cell]
    place = ", ".join(f"{x.middle / (1 << BITS):.6g}" for x in middle)
    try:
        found = matrix(middle)
    except NotPositive:
        raise Invalid(f"the arm does not reach {place}") from None
    if not positive(found):
        raise Invalid(f"{fails} at {place}")


def positive(upper: Sequence[Sequence[Enclosed]]) -> bool:
    """A symmetric matrix of numbers without slopes is ≻ 0; it is given from the diagonal on."""
    start, rest, _ = _parted(upper, 0)
    return _positive(_less(start, rest))


def _parted(upper: Sequence[Sequence[Enclosed]], moving: int) -> tuple[Whole, Whole, list[Whole]]:
    """M, E and the L_j of a symmetric matrix that is given from the diagonal on."""
    size = range(len(upper))
    full = [[upper[min(i, k)][abs(i - k)] for k in size] for i in size]
    lines = [[[x.slopes[j] if x.slopes else 0 for x in row] for row in full] for j in range(moving)]
    return [[x.middle for x in row] for row in full], [[x.radius for x in row] for row in full], lines


def _at_corners(start: Whole, rest: Whole, lines: list[Whole]) -> bool:
    base = _less(start, rest)
    for signs in product((1, -1), repeat=len(lines)):
        corner = [list(row) for row in base]
        for sign, line in zip(signs, lines, strict=True):
            for row, change in zip(corner, line, strict=True):
                for k, x in enumerate(change):
                    row[k] += sign * x
        if not _positive(corner):
            return False
    return True


def _less(matrix: Whole, rest: Whole) -> Whole:
    """M − diag(Σ_l E_il w_i/w_l), with w_i the root of M_ii."""
    weights = [isqrt(max(matrix[i][i], 0)) + 1 for i in range(len(matrix))]
    lowered = [list(row) for row in matrix]
    for i, row in enumerate(rest):
        lowered[i][i] -= sum(-(-e * weights[i] // w) for e, w in zip(row, weights, strict=True))
    return lowered


def _positive(matrix: Whole) -> bool:
    """Every leading minor is > 0 (Sylvester), by Bareiss's elimination."""
    rows, before = [list(row) for row in matrix], 1
    for k, pivot_row in enumerate(rows):
        pivot = pivot_row[k]
        if pivot <= 0:
            return False
        for row in rows[k + 1 :]:
            factor = row[k]
            row[:] = [(x * pivot - factor * y) // before for x, y in zip(row, pivot_row, strict=True)]
        before = pivot
    return True


# What damps the joints: δ_m, the torque −δ_m q̇ against a motion of the joints, the power q̇ᵀδ_m q̇ ≥ 0.
#
# Each joint has its own number, the diagonal; or the document has the whole matrix, of joints that damp each
# other: belts, differentials, tendons. One of both, so that nothing is said twice. A proof of δ_m ≻ JᵀRJ with
# R ⪰ 0 needs δ_m ≻ 0 by itself, and only then is it looked for.


Matrix = list[list[Fraction]]
LARGEST = 1 << 64


def matrix_entry(unit: str, most: int, **more: Any) -> List:
    """Rows of a square matrix."""
    return List(List(Number(), least=1, most=most), unit=always(unit), least=1, most=most, **more)


def damping_matrix(unit: str, most: int) -> List:
    """The entry of an arm whose joints damp each other."""
    return matrix_entry(unit, most, default=None)


def constant(x: Fraction) -> Enclosed:
    """A number of the document."""
    if abs(x) > LARGEST:
        raise Invalid("a number is too large")
    return known(x, BITS)


def damping_of(told: Read, joints: Sequence[Read]) -> Matrix:
    """δ_m of an arm, from the numbers of its joints or legs or from the matrix in their place."""
    whole = told.damping
    own = [only_if(whole is None, joint.damping, "damping of each joint") for joint in joints]
    if whole is None:
        return [[b if i == k else Fraction(0) for k in range(len(own))] for i, b in enumerate(own)]
    if len(whole) != len(own) or any(len(row) != len(own) for row in whole):
        raise Invalid(f"the damping of {len(own)} joints has {len(own)} rows, and as many columns")
    if any(whole[i][k] != whole[k][i] for i in range(len(own)) for k in range(i)):
        raise Invalid("the damping of the joints is not symmetric")
    if not positive([[constant(x) for x in row[i:]] for i, row in enumerate(whole)]):
        raise Invalid(
            "the damping of the joints is not positive definite: some motion of theirs costs nothing"
        )
    return [list(row) for row in whole]
