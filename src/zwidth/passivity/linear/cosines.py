"""Polynomials on the unit circle, ζ = e^{−jθ}, as polynomials in c = cos θ."""

from __future__ import annotations

from collections.abc import Sequence

from flint import fmpq, fmpq_poly, fmpz_poly


def real_product(a: Sequence[int], b: Sequence[int]) -> fmpq_poly:
    """Re{a(ζ) b̄(ζ)} = Σ r_j cos jθ of two integer polynomials, ascending in ζ."""
    size = max(len(a), len(b))
    first, second = (fmpq_poly([*p, *[0] * (size - len(p))]) for p in (a, b))
    reverse = fmpq_poly([second[size - 1 - i] for i in range(size)])
    product, middle = first * reverse, size - 1
    return from_cosines(
        [product[middle], *(product[middle + j] + product[middle - j] for j in range(1, size))]
    )


def from_cosines(a: Sequence[fmpq]) -> fmpq_poly:
    """Σ a_j cos jθ as a polynomial in c = cos θ."""
    total = fmpq_poly([])
    for j, weight in enumerate(a):
        if weight != 0:
            total += weight * fmpq_poly(fmpz_poly.chebyshev_t(j))
    return total
