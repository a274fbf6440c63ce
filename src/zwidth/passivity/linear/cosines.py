"""Polynomials on the unit circle, ζ = e^{−jθ}, as polynomials in c = cos θ."""

from __future__ import annotations

from collections.abc import Sequence
from math import lcm

from flint import fmpq, fmpq_poly, fmpz, fmpz_poly

_FEW = 32
"""Cosines that are added one by one."""


def real_product(a: Sequence[int], b: Sequence[int]) -> fmpq_poly:
    """Re{a(ζ) b̄(ζ)} = Σ r_j cos jθ of two integer polynomials, ascending in ζ."""
    return fmpq_poly(whole_product(a, b))


def whole_product(a: Sequence[int], b: Sequence[int]) -> fmpz_poly:
    """The same, whose coefficients are whole."""
    size = max(len(a), len(b))
    product, middle = fmpz_poly([*a]) * fmpz_poly([*[0] * (size - len(b)), *b[::-1]]), size - 1
    return from_whole_cosines(
        [product[middle], *[product[middle + j] + product[middle - j] for j in range(1, size)]]
    )


def from_cosines(a: Sequence[fmpq]) -> fmpq_poly:
    """Σ a_j cos jθ as a polynomial in c = cos θ."""
    scale = lcm(*(int(weight.q) for weight in a))
    return fmpq_poly(from_whole_cosines([(weight * scale).p for weight in a])) / scale


def from_whole_cosines(a: Sequence[fmpz | int]) -> fmpz_poly:
    """The same of whole numbers; many of them by halves, with T_{m+k} = 2 T_m T_k − T_{m−k}."""
    if len(a) <= _FEW:
        return sum([w * fmpz_poly.chebyshev_t(j) for j, w in enumerate(a) if w], fmpz_poly([]))
    m = len(a) // 2
    low, high = list(a[:m]), a[m + 1 :]
    for k, weight in enumerate(high, 1):
        low[m - k] -= weight
    upper = from_whole_cosines([a[m], *[2 * weight for weight in high]])
    return from_whole_cosines(low) + fmpz_poly.chebyshev_t(m) * upper
