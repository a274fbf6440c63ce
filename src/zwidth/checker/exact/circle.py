"""Products on the unit circle of polynomials in w = 1 − ζ, known within bounds, in powers of u = 1 − cos θ.

|w|² = 2u: there slow motions do not cancel.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from itertools import product

from ..document.effort import spend
from .enclosed import Enclosed
from .positivity import require_positive


def real_part(a: Sequence[Enclosed], b: Sequence[Enclosed], size: int) -> list[Enclosed]:
    """Re{a b̄} on the circle, ascending in u: wⁱ w̄ᵏ = (2u)ⁱ w̄ᵏ⁻ⁱ, Re wᵐ⁺¹ = 2u Re wᵐ − 2u Re wᵐ⁻¹.

    A radius counts with |Re wⁱ w̄ᵏ| ≤ (2u)ʰ of i + k = 2h, and ≤ |i − k| 2ʰ uʰ⁺¹ of 2h + 1, for
    w = 2 sin θ/2 e^{j(π−θ)/2}.
    """
    spend(60 * len(a) * len(b), max(x.middle.bit_length() for x in (*a, *b)))
    spend(len(a) * len(b) * (len(a) + len(b)), a[0].bits, size)
    bits = a[0].bits
    out, loose = [Enclosed(bits, 0)] * size, [0] * size
    powers = _powers(max(len(a), len(b)))
    for i, x in enumerate(a):
        for k, y in enumerate(b):
            found, less, half = x * y, min(i, k), (i + k) // 2
            known = Enclosed(bits, found.middle, found.slopes).times(1 << less)
            for j, c in enumerate(powers[abs(i - k)], start=less):
                if c:
                    out[j] = out[j] + known.times(c)
            odd = (i + k) % 2
            loose[half + odd] += (abs(i - k) if odd else 1) * found.radius << half
    return [x + Enclosed(bits, 0, (), radius) for x, radius in zip(out, loose, strict=True)]


def _powers(most: int) -> list[list[int]]:
    """Re wᵐ, ascending in u."""
    found = [[1], [0, 1]]
    while len(found) < most:
        last, before = found[-1], found[-2]
        found.append([0, *(2 * (x - y) for x, y in zip(last, [*before, *[0] * len(last)], strict=False))])
    return found


def at(depth: Sequence[Enclosed], cosine: Fraction) -> Enclosed:
    """Times a positive number."""
    u, total = 1 - cosine, Enclosed(depth[0].bits, 0)
    top, bottom, n = u.numerator, u.denominator, len(depth) - 1
    spend(n, depth[0].bits + n * bottom.bit_length(), n * bottom.bit_length())
    for i, x in enumerate(depth):
        total = total + x.times(top**i * bottom ** (n - i))
    return total


def require_above_zero(depth: Sequence[Enclosed]) -> None:
    """For every u from 0 to 2, whatever the coefficients are within their bounds."""
    places = max(len(x.slopes) for x in depth)
    for signs in product((-1, 1), repeat=places):
        in_cosine: list[int] = []
        for x in reversed(depth):  # Horner in u = 1 − c
            in_cosine = [p - q for p, q in zip([*in_cosine, 0], [0, *in_cosine], strict=True)]
            in_cosine[0] += x.middle - x.radius
            in_cosine[0] += sum(sign * s for sign, s in zip(signs, x.slopes, strict=bool(x.slopes)))
        require_positive([Fraction(c) for c in in_cosine])
