"""How much a filter can make of its input at most: Σ|h| of a rational H known within bounds.

‖P/D‖₁ ≤ ‖P E‖₁/(|e₀| − ‖D E − e₀‖₁) for any polynomial E; here 1/D, cut off.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

from ..document.effort import spend
from ..document.refusal import Invalid
from .enclosed import Enclosed

LONGEST_SERIES = 20_000


def one_norm(top: Sequence[Enclosed], bottom: Sequence[Enclosed]) -> Fraction:
    """An upper bound on Σ|h|, H = top/bottom, both in ascending powers of ζ = z⁻¹; bottom begins exactly."""
    e = _inverse([x.middle for x in bottom], bottom[0].bits)
    spend(len(e) * (len(top) + len(bottom)), bottom[0].bits)
    head, *rest = _sizes(bottom, e)
    least = 2 * abs(bottom[0].middle * e[0]) - head - sum(rest)
    if least <= 0:
        raise Invalid("the law forgets too slowly for a bound on what encoders do")
    return Fraction(sum(_sizes(top, e)), least)


def _inverse(d: Sequence[int], bits: int) -> list[int]:
    """1/D cut off where what follows is small, in units of 2^−bits."""
    e, unit = [1 << bits], 1 << bits
    weight = sum(map(abs, d)) << 40
    while len(e) <= LONGEST_SERIES:
        near = e[: -len(d) : -1]
        e.append(-sum(x * y for x, y in zip(d[1:], near, strict=False)) // d[0])
        if len(e) > len(d) and sum(map(abs, near)) * weight < unit * abs(d[0]):
            break
    return e


def _sizes(a: Sequence[Enclosed], e: Sequence[int]) -> list[int]:
    """The largest that the coefficients of a E may be."""
    out = []
    for k in range(len(a) + len(e) - 1):
        parts = [(a[i], e[k - i]) for i in range(max(0, k - len(e) + 1), min(len(a), k + 1))]
        out.append(abs(sum(x.middle * y for x, y in parts)) + sum(x.reach * abs(y) for x, y in parts))
    return out
