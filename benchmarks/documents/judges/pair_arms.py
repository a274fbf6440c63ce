"""The numbers of two arms, as a judge reads them from a document."""

from __future__ import annotations

from fractions import Fraction
from functools import partial
from itertools import product
from math import atanh, ceil
from typing import Any, NamedTuple

import numpy as np

from ..plain import exact, quantity

Document = dict[str, Any]


SLACK = 1e-9
"""Of what viscous friction takes from a move, and of friction that is compensated, beside rounding."""


class Law(NamedTuple):
    """F tanh(v/v_s) + C v."""

    coulomb: Fraction
    viscous: Fraction
    speed: Fraction


class Arm(NamedTuple):
    """Of a document, as docs/json.md says; `period` from one reading of its own to the next.

    Of a drive's compensation `still` and `moving` are what it takes of a move in T and with the one before;
    `unsure` is what it may be off by the steps of the encoder, beside the rest [N; N·m].
    """

    damping: Fraction
    friction: Fraction
    resolution: Fraction
    stiffness: Fraction
    virtual: Fraction
    local: Fraction
    whole: int
    part: Fraction
    age: int
    weight: Fraction
    often: int
    period: Fraction
    law: Law | None = None
    still: Fraction = Fraction(0)
    moving: Fraction = Fraction(0)
    unsure: Fraction = Fraction(0)

    def force(self, own: Any, was: Any, its: Any, before: Any) -> Any:
        """K (x − x') + B (v − v') + D v, of two readings of one's own and two of the other."""
        k, b, d = self.stiffness, self.virtual / self.period, self.local / self.period
        if isinstance(own, np.ndarray):
            k, b, d = float(k), float(b), float(d)
        return k * (own - its) + b * ((own - was) - (its - before) / self.often) + d * (own - was)


def arms_of(loop: Document) -> tuple[Arm, Arm] | None:
    """Leader and follower; None where the numbers are of no pair."""
    period, often = quantity(loop, "sample_period"), int(exact(loop.get("own_readings", 1)))
    springs = [quantity(loop[name], "stiffness") for name in ("leader", "follower")]
    if period <= 0 or often < 1 or min(springs) <= 0:
        return None
    found = []
    for name, stiffness in zip(("leader", "follower"), springs, strict=True):
        told = partial(quantity, loop[name])
        late, link = told("delay") / period, told("link_delay") / period
        signs = (late, link, told("damping"), told("coulomb_friction"), told("resolution"))
        if min(signs) < 0 or (late and often > 1):
            return None
        found.append(
            Arm(
                told("damping"),
                told("coulomb_friction"),
                told("resolution"),
                stiffness,
                told("virtual_damping"),
                told("local_damping"),
                int(late // 1),
                late % 1,
                ceil(link),
                springs[0] / stiffness,
                often,
                period / often,
                _law(loop[name].get("compensation")),
            )
        )
    return found[0], found[1]


def _law(told: Document | None) -> Law | None:
    names = ("compensated_coulomb_friction", "compensated_damping", "compensation_speed")
    return None if told is None else Law(*(quantity(told, name) for name in names))


def spent(arm: Arm, r: Fraction) -> Arm:
    """What its compensation leaves of it, under the tangent at r; 1 is F itself."""
    if arm.law is None:
        return arm
    most, viscous, speed = arm.law
    slope = most * (1 - r**2) / speed if r < 1 else Fraction(0)
    height = most * (r - (1 - r**2) * Fraction(atanh(r)) - Fraction(SLACK)) if r < 1 else most
    half, rest = slope / 2, viscous + slope / 2
    a_count = arm.resolution / (arm.period * arm.often)
    less = arm._replace(friction=arm.friction - height)
    if arm.often > 1:
        return less._replace(still=half, moving=rest, unsure=(half + rest) * a_count)
    return less._replace(damping=arm.damping - half, local=arm.local - rest, unsure=half * a_count)


def friction_for(arm: Arm, other: Arm) -> Fraction:
    """Each of the readings half a count off, to the side that is worst."""
    return arm.unsure + max(
        abs(arm.force(*(s * r.resolution / 2 for s, r in zip(signs, (arm, arm, other, other), strict=True))))
        for signs in product((-1, 1), repeat=4)
    )
