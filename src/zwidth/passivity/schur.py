"""Are all roots of a polynomial inside the unit circle?  Decided exactly.

Schur–Cohn recursion on integers: p of degree n is Schur exactly if
|p(0)| < |lead| and (lead·p − p(0)·p*)/z is, with p* the reversed polynomial.
"""

from __future__ import annotations

from collections.abc import Sequence

from flint import fmpz_poly


def is_schur(ascending: Sequence[int]) -> bool:
    """True when every root of Σ a_i zⁱ has modulus < 1."""
    p = fmpz_poly(list(ascending))
    if p.degree() < 0:
        return False
    while p.degree() > 0:
        n = p.degree()
        first, last = p[0], p[n]
        if abs(first) >= abs(last):
            return False
        reverse = fmpz_poly([p[n - i] for i in range(n + 1)])
        p = (last * p - first * reverse).right_shift(1)
        content = p.content()
        if content > 1:
            p = fmpz_poly([c // content for c in p.coeffs()])
    return True
