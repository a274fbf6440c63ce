"""Where the roots of a polynomial of rational coefficients lie: Routh's table, in whole numbers."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from math import gcd

from ..document.effort import spend
from ..document.refusal import Invalid
from .polynomial import bits, cleared

MOST_ROUTH = 20_000_000
"""Order squared times the bits of the largest coefficient."""


def inside_unit_circle(descending: Sequence[Fraction]) -> bool:
    """All roots of Σ a_i z^{n−i} inside |z| = 1, by z = (1 + s)/(1 − s)."""
    whole = cleared(descending)
    spend(2 * len(whole) ** 2, bits(whole) + len(whole), 1)
    # a(z) with z = w − 1 and w = 2/(1 − s): Σ b_k 2^k (1 − s)^(n−k), a polynomial in t = 1 − s, then in s
    shifted = _shifted(whole[::-1], -1)
    in_t = [b << k for k, b in enumerate(shifted)][::-1]
    in_s = [-c if k % 2 else c for k, c in enumerate(_shifted(in_t, 1))]
    return _hurwitz(in_s[::-1])


def in_left_half_plane(descending: Sequence[Fraction]) -> bool:
    """All roots left of the imaginary axis."""
    return _hurwitz(cleared(descending))


def _shifted(ascending: Sequence[int], by: int) -> list[int]:
    """The coefficients of a(x + by), `by` = ±1, by Horner's rule over and over."""
    a = list(ascending)
    for first in range(len(a) - 1):
        for k in range(len(a) - 2, first - 1, -1):
            a[k] += by * a[k + 1]
    return a


def _hurwitz(descending: list[int]) -> bool:
    if len(descending) ** 2 * bits(descending) > MOST_ROUTH:
        raise Invalid("the stability of so high an order, with so many digits, is not decided")
    if descending[0] == 0:
        return False
    if descending[0] < 0:
        descending = [-c for c in descending]
    upper, lower = descending[0::2], descending[1::2]
    while lower:
        if lower[0] <= 0:
            return False
        padded = lower + [0] * (len(upper) - len(lower))
        following = [lower[0] * upper[i + 1] - upper[0] * padded[i + 1] for i in range(len(upper) - 1)]
        common = gcd(*following) if following else 1
        upper, lower = lower, [c // common for c in following] if common > 1 else following
    return upper[0] > 0
