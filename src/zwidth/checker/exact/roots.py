"""Where the roots of a polynomial lie: inside the unit circle, or left of the imaginary axis."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from math import gcd

from ..document.refusal import Invalid, spend
from .enclosed import Enclosed, in_z, quotient
from .polynomial import bits, cleared, shifted

# Do all roots lie inside the unit circle?  The recursion of Schur and Cohn, on numbers with error bounds.
#
#     p ← (pₙ p(z) − p₀ zⁿ p(1/z))/z,  one degree less, while |p₀| < |pₙ|
#
# All roots of the first p lie inside exactly if |p₀| < |pₙ| holds to the end.  With p(1) > 0, which stays so,
# p₀ < pₙ is enough: where p₀ ≤ −pₙ all that follow begin with 0 or less, to the last, pₙ z + p₀, which then
# has p₀ > 0 ≥ pₙ.  Only signs that are certain count.  A polynomial of whole numbers, `bits` = 0, is decided
# exactly.


def decays(in_zeta: list[Enclosed]) -> bool | None:
    """Of a polynomial in ζ = z − 1, descending, the first coefficient > 0; None where a sign is open."""
    at_one = in_zeta[-1].sign
    if at_one is None or at_one <= 0:  # a root at z = 1 or beyond
        return None if at_one is None else False
    return decay_in_powers(in_z(in_zeta))


def decay_in_powers(p: list[Enclosed]) -> bool | None:
    """The same of a polynomial in z, descending, its first coefficient and p(1) > 0."""
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


# Where the roots of a polynomial of rational coefficients lie.
#
# The recursion of Schur and Cohn, in fixed point with bounds, with more digits where a sign is open, and at
# last in whole numbers.  What is to lie left of the imaginary axis is mapped to the unit circle by
# s = (z − 1)/(z + 1) = ζ/(ζ + 2), ζ = z − 1.


PRECISIONS = (256, 1024, 4096)
MOST_EXACT = 8_000_000
"""Order squared times the bits of the largest coefficient, where only whole numbers tell."""


def inside_unit_circle(descending: Sequence[Fraction]) -> bool:
    """All roots of Σ a_i z^{n−i} inside |z| = 1; False of one that begins with 0."""
    whole = cleared(descending)
    spend(len(whole) ** 2, bits(whole) + len(whole), 1)
    return _decay(shifted(whole))


def in_left_half_plane(descending: Sequence[Fraction]) -> bool:
    """All roots of Σ a_i s^{n−i} left of the imaginary axis; False of one that begins with 0."""
    whole = cleared(descending)
    spend(2 * len(whole) ** 2, bits(whole) + 2 * len(whole), 1)
    in_zeta: list[int] = []  # Σ a_k ζᵏ (ζ + 2)ⁿ⁻ᵏ, ascending, by Horner's rule
    power = [1]
    for a in whole:
        in_zeta = [x + a * c for x, c in zip([0, *in_zeta], power, strict=True)]
        power = [2 * x + y for x, y in zip([*power, 0], [0, *power], strict=True)]
    return _decay(in_zeta[::-1])  # one that begins with 0 has a root at z = −1


def _decay(in_zeta: list[int]) -> bool:
    """All roots inside |z| = 1, of a polynomial in ζ = z − 1, descending."""
    lead, size = in_zeta[0], len(in_zeta)
    if lead == 0:
        return False
    for digits in PRECISIONS:
        spend(60 * size**2)
        spend(2 * size**2, digits)
        answer = decays([quotient(c, lead, digits) for c in in_zeta])
        if answer is not None:
            return answer
    if size**2 * bits(in_zeta) > MOST_EXACT:
        raise Invalid("the stability of so high an order, with so many digits, is not decided")
    return bool(decays([Enclosed(0, c if lead > 0 else -c) for c in in_zeta]))
