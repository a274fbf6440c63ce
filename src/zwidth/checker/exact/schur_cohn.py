"""Do all roots lie inside the unit circle?  The recursion of Schur and Cohn, on numbers with error bounds.

    p ← (pₙ p(z) − p₀ zⁿ p(1/z))/z,  one degree less, while |p₀| < |pₙ|

All roots of the first p lie inside exactly if |p₀| < |pₙ| holds to the end.  With p(1) > 0, which stays so,
p₀ < pₙ is enough: where p₀ ≤ −pₙ all that follow begin with 0 or less, to the last, pₙ z + p₀, which then has
p₀ > 0 ≥ pₙ.  Only signs that are certain count.  A polynomial of whole numbers, `bits` = 0, is decided
exactly.
"""

from __future__ import annotations

from math import gcd

from .enclosed import Enclosed, in_z


def decays(in_zeta: list[Enclosed]) -> bool | None:
    """Of a polynomial in ζ = z − 1, descending, the first coefficient > 0; None where a sign is open."""
    at_one = in_zeta[-1].sign
    if at_one is None or at_one <= 0:  # a root at z = 1 or beyond
        return None if at_one is None else False
    p = in_z(in_zeta)
    while len(p) > 1:
        sign = (p[0] - p[-1]).sign
        if sign != 1:
            return None if sign is None else False
        p = _scaled([p[0] * x - p[-1] * y for x, y in zip(p[:-1], p[:0:-1], strict=True)])
    return True


def _scaled(p: list[Enclosed]) -> list[Enclosed]:
    """The same roots, the first coefficient near 1; of whole numbers without a common factor."""
    if p[0].bits == 0:
        common = gcd(*(c.middle for c in p))
        return [Enclosed(0, c.middle // common) for c in p]
    up = p[0].bits - abs(p[0].middle).bit_length()
    return [c.shifted(up) for c in p]
