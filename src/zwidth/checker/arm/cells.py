"""A symmetric matrix S(x) that depends smoothly on some coordinates is ≻ 0 in a whole box.

With m the middle of a cell and t what x may be off it, |t_j| ≤ h_j, the mean value theorem gives

    S(m + t) = S(m) + Σ_j t_j D_j,    every entry of D_j among the slopes ∂S/∂x_j in the cell

D_j is a middle and a rest |E_j|. Without the rest S is linear in t, and ≻ 0 in the cell if it is at the
corners. The rest takes at most Σ_l E_il w_i/w_l from S_ii, with any w > 0, since
2 |y_i y_l| ≤ y_i² w_i/w_l + y_l² w_l/w_i. A cell where that is not enough is halved. Positive means that all
leading minors are, by fraction-free elimination in whole numbers.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Mapping, Sequence
from itertools import product
from math import isqrt

from ..document.reading import Invalid
from ..exact.enclosure import BITS, ONE, ZERO, Jet, NotPositive, Range

MOST_WORK = 200_000
"""Cells, times entries of S, times a value and the slopes of each: some ten seconds, in pose twenty."""
MOST_MOVING = 8

Cell = tuple[Range, ...]
Whole = list[list[int]]
Function = Callable[[Sequence[Jet]], list[list[Jet]]]


def positive_in(box: Cell, matrix: Function, fails: str = "the damping is not enough") -> int:
    """The number of cells that show it, halved where needed; `matrix` takes the coordinates as jets and gives
    the rows of S from the diagonal on; S has as many as there are coordinates. `fails`: what it is else."""
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
    halves = {j: -(-(high - low) // 2) for j, (low, high) in enumerate(cell) if _moves((low, high))}
    start, rest = _at_middle(cell, matrix, fails)
    try:
        jets = matrix([Jet(r, {j: (ONE, ONE)} if j in halves else None) for j, r in enumerate(cell)])
    except NotPositive:
        return _narrowed(halves, fails)
    lines, sizes = [], {}
    for j, half in halves.items():
        line, spread = _parted([[_times_half(s.slopes.get(j, ZERO), half) for s in row] for row in jets])
        rest = [[a + b for a, b in zip(*rows, strict=True)] for rows in zip(rest, spread, strict=True)]
        sizes[j] = sum(abs(x) for row in (*line, *spread) for x in row)
        lines.append(line)
    return None if _at_corners(start, rest, lines) else _narrowed(sizes, fails)


def _moves(coordinate: Range) -> bool:
    """False for one number, rounded outward."""
    return coordinate[1] - coordinate[0] > 1


def _at_middle(cell: Cell, matrix: Function, fails: str) -> tuple[Whole, Whole]:
    """S(m), refused at once where it is not ≻ 0."""
    middle = [((low + high) // 2,) * 2 if _moves((low, high)) else (low, high) for low, high in cell]
    place = ", ".join(f"{low / ONE:.6g}" for low, _ in middle)
    try:
        found = _parted([[s.value for s in row] for row in matrix([Jet(x) for x in middle])])
    except NotPositive:
        raise Invalid(f"the arm does not reach {place}") from None
    if not _positive(_less(*found)):
        raise Invalid(f"{fails} at {place}")
    return found


def _narrowed(sizes: Mapping[int, int], fails: str) -> int:
    """The coordinate that moves S most."""
    if not sizes:
        raise Invalid(f"{fails} by so little that rounding hides it")
    return max(sizes, key=lambda j: sizes[j])


def _times_half(slope: Range, half: int) -> Range:
    return slope[0] * half >> BITS, -(-slope[1] * half >> BITS)


def _parted(upper: Sequence[Sequence[Range]]) -> tuple[Whole, Whole]:
    """The middles of a symmetric matrix, given from the diagonal on, and how far its ranges go beyond."""
    size = range(len(upper))
    full = [[upper[min(i, k)][abs(i - k)] for k in size] for i in size]
    middle = [[(low + high) // 2 for low, high in row] for row in full]
    return middle, [[high - (low + high) // 2 for low, high in row] for row in full]


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
            for c in range(k + 1, len(rows)):
                row[c] = (row[c] * pivot - factor * pivot_row[c]) // before
        before = pivot
    return True
