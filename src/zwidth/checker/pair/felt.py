"""The law that the free arm's hand feels of two arms, the other one in a known hand: H = N/D.

    D = a + g A_h,    N = A D − C C_h g,    x_h = −(g/a) f_h,    fᵢ = Aᵢ xᵢ + Cᵢ xⱼ

All in ascending powers of w = 1 − ζ, known within bounds.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from itertools import product
from typing import NamedTuple

from ..document.refusal import Invalid, spend
from ..exact.enclosed import Enclosed
from ..exact.polynomial import shifted
from ..exact.positivity import require_positive
from ..known_hand.held_motion import Motion, sampled
from .coupling import Side

Whole = list[int]


class Held(NamedTuple):
    """The free arm and the held one, its hand, and the taps A, C, A_h, C_h times `scale`."""

    free: Side
    arm: Side
    motion: Motion
    period: Fraction
    scale: int
    taps: tuple[Whole, Whole, Whole, Whole]
    bits: int


class Port(NamedTuple):
    """N and D in ascending powers of w, and C/(1 + G A_h) = stray/D; N times `scale`."""

    numerator: list[Enclosed]
    denominator: list[Enclosed]
    stray: list[Enclosed]
    scale: int


def port_of(held: Held) -> Port:
    found = sampled(held.motion, held.bits)
    last = len(found.denominator) - 1
    a, g = _delayed(found.denominator, last), _delayed(found.numerator, found.late + last)
    own, other, its_own, its_other = (in_w(row) for row in held.taps)
    below = _sum([x.times(held.scale) for x in a], times(g, its_own))
    through = times(times(g, other), [-c for c in its_other])
    return Port(_sum(times(below, own), through), below, times(a, other), held.scale)


def _delayed(descending: Sequence[Enclosed], power: int) -> list[Enclosed]:
    """A polynomial in z − 1 times ζ^power, ascending in w: z − 1 = w/(1 − w)."""
    out = [Enclosed(descending[0].bits, 0)] * (power + 1)
    for i, c in enumerate(reversed(descending)):
        for k, x in enumerate(times([c], in_w([0] * (power - i) + [1]))):
            out[i + k] = out[i + k] + x
    return out


def in_w(row: Sequence[int]) -> Whole:
    """A polynomial in ζ, ascending, in powers of 1 − ζ."""
    return [-c if i % 2 else c for i, c in enumerate(reversed(shifted(row[::-1])))]


def times(a: Sequence[Enclosed], whole: Sequence[int]) -> list[Enclosed]:
    """A polynomial times one of whole numbers, exactly."""
    out = [Enclosed(a[0].bits, 0)] * (len(a) + len(whole) - 1)
    for i, x in enumerate(a):
        for k, c in enumerate(whole):
            if c:
                out[i + k] = out[i + k] + x.times(c)
    return out


def _sum(a: list[Enclosed], b: list[Enclosed]) -> list[Enclosed]:
    size, zero = max(len(a), len(b)), Enclosed(a[0].bits, 0)
    return [x + y for x, y in zip(*([*p, *[zero] * (size - len(p))] for p in (a, b)), strict=True)]


def in_zeta(depth: Sequence[Enclosed]) -> list[Enclosed]:
    """A polynomial in w in powers of ζ."""
    out = [Enclosed(depth[0].bits, 0)] * len(depth)
    for i, x in enumerate(depth):
        for k, y in enumerate(times([x], in_w([0] * i + [1]))):
            out[k] = out[k] + y
    return out


# Products on the unit circle of polynomials in w = 1 − ζ, known within bounds, in powers of u = 1 − cos θ.
#
# |w|² = 2u: there slow motions do not cancel.


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


# How much a filter can make of its input at most: Σ|h| of a rational H known within bounds.
#
# ‖P/D‖₁ ≤ ‖P E‖₁/(|e₀| − ‖D E − e₀‖₁) for any polynomial E; here 1/D, cut off.


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
