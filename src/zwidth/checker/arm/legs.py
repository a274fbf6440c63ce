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

from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from typing import Any, NamedTuple

from ..document.reading import Invalid, get, number
from ..exact.enclosure import NOTHING, Jet, Range, enclosed, total
from .chain import vector


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


def read_legs(arm: Mapping[str, Any]) -> Legs:
    listed = get(arm, "legs")
    if not isinstance(listed, list) or len(listed) not in (2, 3):
        raise Invalid("a parallel arm has two legs in the plane or three in space")
    size = len(listed)
    low, high = vector(get(arm, "low_m"), size), vector(get(arm, "high_m"), size)
    if any(a > b for a, b in zip(low, high, strict=True)):
        raise Invalid("the region needs low ≤ high")
    return Legs([_leg(entry, size) for entry in listed], low, high)


def _leg(entry: Mapping[str, Any], size: int) -> Leg:
    out, up = vector(get(entry, "out"), size), vector(get(entry, "up"), size)
    across = [up[i - 2] * out[i - 1] - up[i - 1] * out[i - 2] for i in range(3)] if size == 3 else []
    link, rod, offset, damping = (
        number(get(entry, key)) for key in ("link_m", "rod_m", "offset_m", "damping_N_m_s_per_rad")
    )
    bend = get(entry, "bend")
    if min(link, rod) <= 0 or min(offset, damping) < 0 or isinstance(bend, bool) or bend not in (-1, 1):
        raise Invalid("a leg needs link and rod > 0, offset and damping ≥ 0, and bend −1 or 1")
    axes = [out, up, across] if size == 3 else [out, up]
    return Leg(vector(get(entry, "base_m"), size), axes, link, rod, offset, int(bend), damping)


def legs_surplus(arm: Legs, need: list[list[Range]]) -> Callable[[Sequence[Jet]], list[list[Jet]]]:
    """δ − R at the hand, the rows from the diagonal on."""

    def surplus(position: Sequence[Jet]) -> list[list[Jet]]:
        found = [[-Jet(r) for r in row[i:]] for i, row in enumerate(need)]
        for leg in arm.legs:
            normal, lever = _normal(leg, position)
            weight = lever.inverse().scaled(enclosed(leg.damping))
            for i, x in enumerate(normal):
                for k, y in enumerate(normal[i:]):
                    found[i][k] = found[i][k] + (x * y if k else x.squared()) * weight
        return found

    return surplus


def _normal(leg: Leg, position: Sequence[Jet]) -> tuple[list[Jet], Jet]:
    """n, and H²."""
    seen = [p - Jet(enclosed(a)) for p, a in zip(position, leg.base, strict=True)]
    u, w, *aside = (
        total([x.scaled(enclosed(c)) for x, c in zip(seen, axis, strict=True)]) for axis in leg.axes
    )
    length, across = _constant(leg.rod + leg.offset), NOTHING
    if aside:
        straight = (_constant(leg.rod**2) - aside[0].squared()).root()
        length = straight + _constant(leg.offset)
        across = length * aside[0] * straight.inverse()
    distance = u.squared() + w.squared()
    a = (distance + _constant(leg.link**2) - length.squared()).scaled(enclosed(Fraction(1, 2)))
    lever = distance.scaled(enclosed(leg.link**2)) - a.squared()
    near, turned = a * distance.inverse(), lever.root() * distance.inverse()
    side = turned if leg.bend > 0 else -turned
    in_plane = [u - near * u + side * w, w - near * w - side * u]
    parts = [*in_plane, across]
    return [
        total([part.scaled(enclosed(axis[k])) for part, axis in zip(parts, leg.axes, strict=False)])
        for k in range(len(position))
    ], lever


def _constant(x: Fraction) -> Jet:
    return Jet(enclosed(x))
