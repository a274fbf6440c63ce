"""The numbers of two arms, as a judge reads them from a document."""

from __future__ import annotations

from fractions import Fraction
from functools import partial
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
    """Of a document, as docs/json.md says; `period` from one reading to the next of the quicker arm.

    It reads itself `every` so many of them.

    `sent` and `sent_damping` are K and B of the other, as often as its coupling force is added; `back` is how
    old one's own readings are in that.  Of a drive's compensation `still` and `moving` are what it takes of a
    move in T and with the one before; `unsure` is what it may be off by the steps of the encoder, beside the
    rest [N; N·m].
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
    every: int
    sent: Fraction
    sent_damping: Fraction
    back: int
    law: Law | None = None
    still: Fraction = Fraction(0)
    moving: Fraction = Fraction(0)
    unsure: Fraction = Fraction(0)

    def force(self, own: Any, was: Any, its: Any, before: Any, back: Any, earlier: Any) -> Any:
        """K (x − x') + B (v − v') + D v − r c': two readings of its own, two of the other, two of c'."""
        slopes = [v / self.period for v in (self.virtual, self.local, self.sent_damping)]
        gains = (self.stiffness, slopes[0], slopes[1], self.sent, slopes[2])
        k, b, d, r, rb = map(float, gains) if isinstance(own, np.ndarray) else gains
        speed = (own - was) / self.every
        felt = k * (own - its) + b * (speed - (its - before) / self.often) + d * speed
        return felt - r * (its - back) - rb * ((its - before) - (back - earlier)) / self.often

    def readings(self, at: int) -> tuple[tuple[bool, int], ...]:
        """Which `force` takes at one of its own: whether it is its own, and which."""
        at = self.every * (at // self.every)
        heard, back = (self.often * (at // self.often - age) for age in (self.age, self.back))
        mine, its, old = (
            ((True, at), (True, at - self.every)),
            ((False, heard), (False, heard - self.often)),
            ((True, back), (True, back - self.often)),
        )
        return *mine, *its, *old


def arms_of(loop: Document) -> tuple[Arm, Arm] | None:
    """Leader and follower; None where the numbers are of no pair."""
    period, often = quantity(loop, "sample_period"), int(exact(loop.get("own_readings", 1)))
    names = ("leader", "follower")
    shares = [exact(loop[name].get("reflection", 0)) for name in names]
    own = [quantity(loop[name], "stiffness") for name in names]
    springs = [k + share * other for k, share, other in zip(own, shares, own[::-1], strict=True)]
    if period <= 0 or often < 1 or min(*own, *shares) < 0 or min(springs) <= 0:
        return None
    links = [ceil(quantity(loop[name], "link_delay") / period) for name in names]
    found = []
    for i, name in enumerate(names):
        told, other = partial(quantity, loop[name]), partial(quantity, loop[names[1 - i]])
        late, link = told("delay") / period, told("link_delay") / period
        signs = (late, link, told("damping"), told("coulomb_friction"), told("resolution"))
        if min(signs) < 0 or (late and often > 1):
            return None
        times = int(exact(loop[name].get("own_readings", often)))
        if times < 1 or often % times:
            return None
        found.append(
            Arm(
                told("damping"),
                told("coulomb_friction"),
                told("resolution"),
                own[i],
                told("virtual_damping"),
                told("local_damping"),
                int(late // 1),
                late % 1,
                ceil(link),
                springs[0] / springs[i],
                often,
                period / often,
                often // times,
                shares[i] * own[1 - i],
                shares[i] * other("virtual_damping"),
                sum(links),
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
    if arm.often > arm.every:
        return less._replace(still=half, moving=rest, unsure=(half + rest) * a_count)
    return less._replace(damping=arm.damping - half, local=arm.local - rest, unsure=half * a_count)


def friction_for(arm: Arm, other: Arm) -> Fraction:
    """Each of the readings half a count off, to the side that is worst."""
    taps: dict[tuple[bool, int], Fraction] = {}
    for n, (mine, k) in enumerate(arm.readings(0)):
        at = (
            mine,
            k - (n > 3 and arm.often > arm.every),
        )  # what comes back to a drive counts as another reading
        taps[at] = taps.get(at, Fraction(0)) + arm.force(*(Fraction(j == n) for j in range(6)))
    own, its = (sum(abs(c) for at, c in taps.items() if at[0] is whose) for whose in (True, False))
    return arm.unsure + (own * arm.resolution + its * other.resolution) / 2
