"""A parallel arm: each leg's elbow from where the hand is, and Σ b_i w_i w_iᵀ − R with its slopes.

A leg sees the hand at P = (u, w) in its plane and v across it. Its link l ends at the elbow e, and the rod
goes on from there:

    |e| = l,    |P − e| = ℓ,    ℓ = D + √(b² − v²)
    e = (A P + σ H P⊥)/|P|²,    A = (|P|² + l² − ℓ²)/2,    H = √(l²|P|² − A²) > 0,    P⊥ = (−w, u)

σ = ±1 says which elbow; as long as H > 0 it stays the same one. The closure |P − e|² = ℓ² gives the angle
of the link as a function of the hand, with the gradient

    w = n/(n · e⊥),    n = (P − e) in the plane + ℓ v/√(b² − v²) across,    |n · e⊥| = H
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import NamedTuple

from ..document.fields import Choice, List, Number, Read, Record, numbers
from ..document.refusal import Invalid
from ..document.unit import always
from ..exact.enclosed import Enclosed, dot
from ..exact.functions import inverse, root
from .chain import NEARLY, NOTHING, constant

_METRES = always("m")


def _place() -> List:
    return numbers(_METRES, least=2, most=3)


_LEG = Record(
    {
        "base": _place(),
        "out": numbers(least=2, most=3),
        "up": numbers(least=2, most=3),
        "link": Number(_METRES, above=0),
        "rod": Number(_METRES, above=0),
        "offset": Number(_METRES, least=0),
        "bend": Choice(-1, 1),
        "damping": Number(always("N_m_s_per_rad"), least=0),
    }
)
LEGS = Record({"legs": List(_LEG, least=2, most=3), "low": _place(), "high": _place()})
"""Two legs in the plane or three in space; opposite corners of the region."""


class Leg(NamedTuple):
    base: list[Fraction]
    axes: list[list[Fraction]]  # u, w, and across them v in space
    link: Fraction
    rod: Fraction
    offset: Fraction
    bend: int
    damping: Fraction


class Legs(NamedTuple):
    legs: list[Leg]
    low: list[Fraction]
    high: list[Fraction]


def legs_of(told: Read) -> Legs:
    """The arm of a document."""
    size = len(told.legs)
    places = [told.low, told.high, *(v for leg in told.legs for v in (leg.base, leg.out, leg.up))]
    if any(len(place) != size for place in places):
        raise Invalid("an arm has as many legs as its places have coordinates")
    if any(a > b for a, b in zip(told.low, told.high, strict=True)):
        raise Invalid("the region needs low ≤ high")
    return Legs([_leg(leg, size) for leg in told.legs], told.low, told.high)


def _leg(told: Read, size: int) -> Leg:
    out, up = told.out, told.up
    across = [up[i - 2] * out[i - 1] - up[i - 1] * out[i - 2] for i in range(3)] if size == 3 else []
    axes = [out, up, across] if size == 3 else [out, up]
    for i, a in enumerate((out, up)):
        for j, b in enumerate((out, up)):
            if abs(sum((x * y for x, y in zip(a, b, strict=True)), Fraction(-(i == j)))) > NEARLY:
                raise Invalid("out and up must be of length 1, at right angles")
    return Leg(told.base, axes, told.link, told.rod, told.offset, told.bend, told.damping)


def legs_surplus(
    arm: Legs, need: list[list[Enclosed]]
) -> Callable[[Sequence[Enclosed]], list[list[Enclosed]]]:
    """δ − R at the hand, the rows from the diagonal on."""

    def surplus(position: Sequence[Enclosed]) -> list[list[Enclosed]]:
        found = [[-r for r in row[i:]] for i, row in enumerate(need)]
        for leg in arm.legs:
            normal, lever = _normal(leg, position)
            weight = inverse(lever) * constant(leg.damping)
            for i, x in enumerate(normal):
                for k, y in enumerate(normal[i:]):
                    found[i][k] = found[i][k] + x * y * weight
        return found

    return surplus


def _normal(leg: Leg, position: Sequence[Enclosed]) -> tuple[list[Enclosed], Enclosed]:
    """n, and H²."""
    seen = [p - constant(a) for p, a in zip(position, leg.base, strict=True)]
    axes = [[constant(c) for c in axis] for axis in leg.axes]
    u, w, *aside = (dot(seen, axis) for axis in axes)
    length, across = constant(leg.rod + leg.offset), NOTHING
    if aside:
        straight = root(constant(leg.rod**2) - aside[0] * aside[0])
        length = straight + constant(leg.offset)
        across = length * aside[0] * inverse(straight)
    distance = u * u + w * w
    a = (distance + constant(leg.link**2) - length * length).over(2)
    lever = distance * constant(leg.link**2) - a * a
    closer = inverse(distance)
    near, turned = a * closer, root(lever) * closer
    side = turned if leg.bend > 0 else -turned
    in_plane = [u - near * u + side * w, w - near * w - side * u]
    parts = [*in_plane, across][: len(axes)]
    return [dot(parts, [axis[k] for axis in axes]) for k in range(len(position))], lever
