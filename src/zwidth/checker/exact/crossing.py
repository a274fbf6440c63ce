"""Does no root meet the unit circle, whatever the values within bounds?

Roots move continuously.  Where they lie inside for one value of a box and never meet the circle, they lie
inside for all.  With z = (1 + w)/(1 − w) and c(w) = c₀ wⁿ + … + cₙ a root at z = −1 is c₀ = 0, one at 1 is
cₙ = 0, and a pair e^{±jθ} has w₁ + w₂ = 0, which by Orlando's formula

    det H = ± c₀ⁿ⁻¹ Π_{i<j} (wᵢ + wⱼ),    H of order n − 1,  Hᵢⱼ = c_{2j−i}

makes Hurwitz's matrix singular.  It is regular where some matrix C, however found, leaves so little of
I − C H that a vector u > 0 has |I − C H| u < u.
"""

from __future__ import annotations

from math import comb, isfinite

from .enclosed import Enclosed

_ROUNDS = 20

_Matrix = list[list[Enclosed]]


def never_crosses(in_zeta: list[Enclosed]) -> bool:
    """True where no polynomial within the bounds, in descending powers of ζ, has a root on the circle."""
    c = _bilinear(in_zeta)
    if not c[0].sign or not c[-1].sign:
        return False
    matrix = _hurwitz(c)
    inverse = _inverse([[x.middle / (1 << x.bits) for x in row] for row in matrix])
    return inverse is not None and _is_small(_deviation(inverse, matrix), c[0].bits)


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


def _inverse(rows: list[list[float]]) -> list[list[float]] | None:
    """By Gauss and Jordan, in floats: it need not be exact."""
    size = len(rows)
    work = [[*row, *(float(i == j) for j in range(size))] for i, row in enumerate(rows)]
    for k in range(size):
        best = max(range(k, size), key=lambda i: abs(work[i][k]))
        if not work[best][k]:
            return None
        work[k], work[best] = work[best], work[k]
        work[k] = [x / work[k][k] for x in work[k]]
        for i in range(size):
            if i != k and work[i][k]:
                factor = work[i][k]
                work[i] = [x - factor * y for x, y in zip(work[i], work[k], strict=True)]
    inverse = [row[size:] for row in work]
    return inverse if all(isfinite(x) for row in inverse for x in row) else None


def _deviation(inverse: list[list[float]], matrix: _Matrix) -> list[list[int]]:
    """Bounds of |I − C H|, in units of 2^−bits."""
    if not matrix:
        return []
    bits, zero = matrix[0][0].bits, Enclosed(matrix[0][0].bits, 0)
    out = []
    for i, row in enumerate(inverse):
        weights = [_fixed(x, bits) for x in row]
        bounds = []
        for j in range(len(matrix)):
            total = zero
            for weight, line in zip(weights, matrix, strict=True):
                if line[j].sign != 0:
                    total = total + line[j].times(weight)
            middle = total.middle - (1 << 2 * bits if i == j else 0)
            bounds.append(-(-(abs(middle) + total.reach) >> bits))
        out.append(bounds)
    return out


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
