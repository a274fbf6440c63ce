"""Where the roots of a polynomial of rational coefficients lie.

The recursion of Schur and Cohn, in fixed point with bounds, with more digits where a sign is open, and at
last in whole numbers.  What is to lie left of the imaginary axis is mapped to the unit circle by
s = (z − 1)/(z + 1) = ζ/(ζ + 2), ζ = z − 1.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

from ..document.effort import spend
from ..document.refusal import Invalid
from .enclosed import Enclosed, quotient
from .polynomial import bits, cleared, shifted
from .schur_cohn import decays

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
