"""A parallel arm: each leg's elbow from where the hand is, and Σ δ_ij w_i w_jᵀ − R with its slopes.

A leg sees the hand at P = (u, w) in its plane and v across it. Its link l ends at the elbow e, and the rod
goes on from there:

    |e| = l,    |P − e| = ℓ,    ℓ = D + √(b² − v²)
    e = (A P + σ H P⊥)/|P|²,    A = (|P|² + l² − ℓ²)/2,    H = √(l²|P|² − A²) > 0,    P⊥ = (−w, u)

σ = ±1 says which elbow; as long as H > 0 it stays the same one. The closure |P − e|² = ℓ² gives the angle
of the link as a function of the hand, with the gradient

    w = n/(n · e⊥),    n = (P − e) in the plane + ℓ v/√(b² − v²) across,    n · e⊥ = −σ H

e⊥ = (A P⊥ − σ H P)/|P|² is e turned by a right angle, and e · e⊥ = 0. δ is diagonal, with b_i, unless motors
damp each other; only then the sign plays a part.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction
from itertools import product
from typing import NamedTuple

from ..document.fields import Choice, List, Number, Read, Record, numbers
from ..document.refusal import Invalid
from ..document.unit import always
from ..exact.enclosed import Enclosed, dot
from ..exact.functions import inverse, root
from .chain import METRES, NOTHING, require_square
from .damping import constant, damping_matrix, damping_of


def _place() -> List:
    return numbers(METRES, least=2, most=3)


_LEG = Record(
    {
        "base": _place(),
        "out": numbers(least=2, most=3),
        "up": numbers(least=2, most=3),
        "link": Number(METRES, above=0),
        "rod": Number(METRES, above=0),
        "offset": Number(METRES, least=0),
        "bend": Choice(-1, 1),
        "damping": Number(always("N_m_s_per_rad"), least=0, default=None),
    }
)
LEGS = Record(
    {
        "legs": List(_LEG, least=2, most=3),
        "low": _place(),
        "high": _place(),
        "damping": damping_matrix("N_m_s_per_rad", 3),
    }
)
"""Two legs in the plane or three in space; opposite corners of the region. Motors that damp each other have a
matrix in the place of their own damping."""


class Leg(NamedTuple):
    base: list[Fraction]
    axes: list[list[Fraction]]  # u, w, and across them v in space
    link: Fraction
    rod: Fraction
    offset: Fraction
    bend: int


class Legs(NamedTuple):
    legs: list[Leg]
    low: list[Fraction]
    high: list[Fraction]
    damping: list[list[Fraction]]


def legs_of(told: Read) -> Legs:
    """The arm of a document."""
    size = len(told.legs)
    places = [told.low, told.high, *(v for leg in told.legs for v in (leg.base, leg.out, leg.up))]
    if any(len(place) != size for place in places):
        raise Invalid("an arm has as many legs as its places have coordinates")
    if any(a > b for a, b in zip(told.low, told.high, strict=True)):
        raise Invalid("the region needs low ≤ high")
    legs = [_leg(leg, size) for leg in told.legs]
    return Legs(legs, told.low, told.high, damping_of(told, told.legs))


def _leg(told: Read, size: int) -> Leg:
    out, up = told.out, told.up
    across = [up[i - 2] * out[i - 1] - up[i - 1] * out[i - 2] for i in range(3)] if size == 3 else []
    axes = [out, up, across] if size == 3 else [out, up]
    require_square((out, up), "out and up must be of length 1, at right angles")
    return Leg(told.base, axes, told.link, told.rod, told.offset, told.bend)


def legs_surplus(
    arm: Legs, need: list[list[Enclosed]]
) -> Callable[[Sequence[Enclosed]], list[list[Enclosed]]]:
    """δ − R at the hand, the rows from the diagonal on."""
    enclosed = [_enclosed(leg) for leg in arm.legs]
    damping = [[constant(x) for x in row] for row in arm.damping]

    def surplus(position: Sequence[Enclosed]) -> list[list[Enclosed]]:
        found = [[-r for r in row[i:]] for i, row in enumerate(need)]
        normals, levers = zip(*(_normal(leg, position) for leg in enclosed), strict=True)
        for (i, normal), (j, other) in product(enumerate(normals), repeat=2):
            if not arm.damping[i][j]:
                continue
            weight = _over_levers(arm.legs, levers, i, j) * damping[i][j]
            for r, row in enumerate(found):
                for k, c in enumerate(range(r, len(found))):
                    row[k] = row[k] + normal[r] * other[c] * weight
        return found

    return surplus


def _over_levers(legs: Sequence[Leg], levers: Sequence[Enclosed], i: int, j: int) -> Enclosed:
    """1/((n_i · e_i⊥)(n_j · e_j⊥)), from H²."""
    if i == j:
        return inverse(levers[i])
    both = inverse(root(levers[i]) * root(levers[j]))
    return both if legs[i].bend == legs[j].bend else -both


class _Enclosed(NamedTuple):
    """The numbers of a leg, as they meet the hand."""

    base: list[Enclosed]
    axes: list[list[Enclosed]]
    length: Enclosed  # rod and offset
    offset: Enclosed
    link_squared: Enclosed
    rod_squared: Enclosed
    bend: int


def _enclosed(leg: Leg) -> _Enclosed:
    return _Enclosed(
        [constant(x) for x in leg.base],
        [[constant(x) for x in axis] for axis in leg.axes],
        constant(leg.rod + leg.offset),
        constant(leg.offset),
        constant(leg.link**2),
        constant(leg.rod**2),
        leg.bend,
    )


def _normal(leg: _Enclosed, position: Sequence[Enclosed]) -> tuple[list[Enclosed], Enclosed]:
    """n, and H²."""
    seen = [p - a for p, a in zip(position, leg.base, strict=True)]
    u, w, *aside = (dot(seen, axis) for axis in leg.axes)
    length, across = leg.length, NOTHING
    if aside:
        straight = root(leg.rod_squared - aside[0] * aside[0])
        length = straight + leg.offset
        across = length * aside[0] * inverse(straight)
    distance = u * u + w * w
    a = (distance + leg.link_squared - length * length).over(2)
    lever = distance * leg.link_squared - a * a
    closer = inverse(distance)
    near, turned = a * closer, root(lever) * closer
    side = turned if leg.bend > 0 else -turned
    in_plane = [u - near * u + side * w, w - near * w - side * u]
    parts = [*in_plane, across][: len(leg.axes)]
    return [dot(parts, [axis[k] for axis in leg.axes]) for k in range(len(position))], lever
