"""Does no root meet the unit circle, whatever the values within bounds?

Roots move continuously.  Where they lie inside for one value of a box and never meet the circle, they lie
inside for all.  With z = (1 + w)/(1 − w) and c(w) = c₀ wⁿ + … + cₙ a root at z = −1 is c₀ = 0, one at 1 is
cₙ = 0, and a pair e^{±jθ} has w₁ + w₂ = 0, which by Orlando's formula

    det H = ± c₀ⁿ⁻¹ Π_{i<j} (wᵢ + wⱼ),    H of order n − 1,  Hᵢⱼ = c_{2j−i}

makes Hurwitz's matrix singular.  It is regular where some matrices C and R, however found, leave so little
of I − C H R that a vector u > 0 has |I − C H R| u < u.  Two of them, so that of a matrix that is nearly
singular one entry alone is small, which knows what cancels in det H.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product
from math import comb, isfinite

from .enclosed import Enclosed

_ROUNDS = 20

_Matrix = list[list[Enclosed]]
_Floats = list[list[float]]


def never_crosses(in_zeta: list[Enclosed]) -> bool:
    """True where no polynomial within the bounds, in descending powers of ζ, has a root on the circle."""
    c = _bilinear(in_zeta)
    if not c[0].sign or not c[-1].sign:
        return False
    matrix = _hurwitz(c)
    sides = _sides([[x.middle / (1 << x.bits) for x in row] for row in matrix])
    return sides is not None and _is_small(_deviation(matrix, *sides), c[0].bits)


def _bilinear(in_zeta: list[Enclosed]) -> list[Enclosed]:
    """Σ a_i (2w)ⁿ⁻ⁱ (1 − w)ⁱ, descending."""
    n = len(in_zeta) - 1
    out = [Enclosed(in_zeta[0].bits, 0)] * (n + 1)
    for i, a in enumerate(in_zeta):
        for k in range(i + 1):
            factor = comb(i, k) << (n - i)
            out[i - k] = out[i - k] + a.times(-factor if k % 2 else factor)
    return out


def _hurwitz(c: list[Enclosed]) -> _Matrix:
    n, zero = len(c) - 1, Enclosed(c[0].bits, 0)
    places = range(1, n)
    return [[c[2 * j - i] if 0 <= 2 * j - i <= n else zero for j in places] for i in places]


def _sides(rows: _Floats) -> tuple[_Floats, _Floats] | None:
    """C, and the columns of R, with C H R near I, in floats: they need not be exact.

    By elimination, the largest number that is left first: what makes H nearly singular comes last.
    """
    size = len(rows)
    work = [row[:] for row in rows]
    left, right = ([[float(i == j) for j in range(size)] for i in range(size)] for _ in range(2))
    for k in range(size):
        top, side = max(product(range(k, size), repeat=2), key=lambda at: abs(work[at[0]][at[1]]))
        pivot = work[top][side]
        if not pivot:
            return None
        work[k], work[top], left[k], left[top] = work[top], work[k], left[top], left[k]
        right[k], right[side] = right[side], right[k]
        for row in work:
            row[k], row[side] = row[side], row[k]
        for i in range(k + 1, size):
            down, across = work[i][k] / pivot, work[k][i] / pivot
            work[i] = _less(work[i], down, work[k])
            left[i] = _less(left[i], down, left[k])
            right[i] = _less(right[i], across, right[k])
        left[k] = [x / pivot for x in left[k]]
    return (left, right) if all(isfinite(x) for row in (*left, *right) for x in row) else None


def _less(row: list[float], factor: float, other: list[float]) -> list[float]:
    return [x - factor * y for x, y in zip(row, other, strict=True)]


def _deviation(matrix: _Matrix, left: _Floats, right: _Floats) -> list[list[int]]:
    """Bounds of |I − C H R|, in units of 2^−bits."""
    if not matrix:
        return []
    bits = matrix[0][0].bits
    close = _turned(right, _turned(left, matrix))
    out = []
    for i, row in enumerate(close):
        middles = [x.middle - (1 << 3 * bits if i == j else 0) for j, x in enumerate(row)]
        out.append([-(-(abs(m) + x.reach) >> 2 * bits) for m, x in zip(middles, row, strict=True)])
    return out


def _turned(weights: _Floats, matrix: _Matrix) -> _Matrix:
    """(W A)ᵀ, times 2^bits: twice so gives C H R."""
    bits = matrix[0][0].bits
    whole = [[_fixed(x, bits) for x in row] for row in weights]
    return [[_weighed(column, row) for row in whole] for column in zip(*matrix, strict=True)]


def _weighed(numbers: Sequence[Enclosed], weights: Sequence[int]) -> Enclosed:
    total = Enclosed(numbers[0].bits, 0)
    for x, weight in zip(numbers, weights, strict=True):
        if x.sign != 0:
            total = total + x.times(weight)
    return total


def _fixed(value: float, bits: int) -> int:
    top, bottom = value.as_integer_ratio()
    return (top << bits) // bottom


def _is_small(bounds: list[list[int]], bits: int) -> bool:
    """B u < u for u = 1 + B + B² + …, cut off."""
    u = [1 << bits] * len(bounds)
    for _ in range(_ROUNDS):
        u = [(1 << bits) + (x >> bits) for x in _applied(bounds, u)]
    return all(x < y << bits for x, y in zip(_applied(bounds, u), u, strict=True))


def _applied(bounds: list[list[int]], u: list[int]) -> list[int]:
    return [sum(x * y for x, y in zip(row, u, strict=True)) for row in bounds]
