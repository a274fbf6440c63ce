"""The law that the free arm's hand feels of two arms, the other one in a known hand: H = N/D.

    D = a + g A_h,    N = A D − C C_h g,    x_h = −(g/a) f_h,    fᵢ = Aᵢ xᵢ + Cᵢ xⱼ

All in ascending powers of w = 1 − ζ, known within bounds.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import NamedTuple

from ..exact.enclosed import Enclosed
from ..exact.polynomial import shifted
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
