"""Descartes' rule of signs on halved intervals (Vincent, Collins & Akritas).

A polynomial is held mapped, up to a positive factor, so that (0, 1) covers the interval.
"""

from __future__ import annotations

from flint import fmpz_poly

_SHIFT = fmpz_poly([1, 1])


def on_unit_interval(p: fmpz_poly) -> fmpz_poly:
    """p on [−1, 1], mapped to [0, 1]: c = 2t − 1."""
    return p(fmpz_poly([-1, 2]))


def sign_changes(h: fmpz_poly) -> int:
    """Descartes' bound on the number of roots of h in (0, 1); 0 and 1 are exact."""
    n = h.degree()
    reverse = fmpz_poly([h[n - i] for i in range(n + 1)])
    signs = [c > 0 for c in reverse(_SHIFT).coeffs() if c != 0]
    return sum(1 for a, b in zip(signs, signs[1:], strict=False) if a != b)


def halves(h: fmpz_poly) -> tuple[fmpz_poly, fmpz_poly]:
    """2ⁿ h(t/2), and the same of the right half, 2ⁿ h((t + 1)/2)."""
    n = h.degree()
    left = fmpz_poly([h[i] * (1 << (n - i)) for i in range(n + 1)])
    return left, left(_SHIFT)
