"""The numbers of two arms, as a judge reads them from a document."""

from __future__ import annotations

from fractions import Fraction
from functools import partial
from math import ceil
from typing import Any, NamedTuple

import numpy as np

from ..plain import exact, quantity

Document = dict[str, Any]


class Arm(NamedTuple):
    """Of a document, as docs/json.md says; `period` from one reading of its own to the next.

    `sent` and `sent_damping` are K and B of the other, as often as its coupling force is added; `back` is how
    old one's own readings are in that.  `dry`, `viscous` and `speed` are F, C and v_s of what compensates its
    friction.
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
    sent: Fraction
    sent_damping: Fraction
    back: int
    dry: Fraction = Fraction(0)
    viscous: Fraction = Fraction(0)
    speed: Fraction = Fraction(0)

    def force(self, own: Any, was: Any, its: Any, before: Any, back: Any, earlier: Any) -> Any:
        """K (x − x') + B (v − v') + D v − r c': two readings of its own, two of the other, two of c'."""
        period = self.period
        gains = (
            self.stiffness,
            self.virtual / period,
            self.local / period,
            self.sent,
            self.sent_damping / period,
        )
        k, b, d, r, rb = map(float, gains) if isinstance(own, np.ndarray) else gains
        felt = k * (own - its) + b * ((own - was) - (its - before) / self.often) + d * (own - was)
        return felt - r * (its - back) - rb * ((its - before) - (back - earlier)) / self.often

    def readings(self, at: int) -> tuple[tuple[bool, int], ...]:
        """Which `force` takes at one of its own: whether it is its own, and which."""
        heard, back = (self.often * (at // self.often - age) for age in (self.age, self.back))
        mine, its, old = (
            ((True, at), (True, at - 1)),
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
                shares[i] * own[1 - i],
                shares[i] * other("virtual_damping"),
                sum(links),
                *_compensated(loop[name].get("compensation")),
            )
        )
    return found[0], found[1]


def _compensated(law: Document | None) -> tuple[Fraction, Fraction, Fraction]:
    names = ("compensated_coulomb_friction", "compensated_damping", "compensation_speed")
    first, second, third = (Fraction(0) if law is None else quantity(law, name) for name in names)
    return first, second, third


def friction_for(arm: Arm, other: Arm) -> Fraction:
    """Each of the readings half a count off, to the side that is worst; less what compensation asks for."""
    own = arm if arm.often > 1 else arm._replace(local=arm.local - arm.viscous)
    taps: dict[tuple[bool, int], Fraction] = {}
    for n, at in enumerate(own.readings(0)):
        if own.often > 1 and n > 3:
            at = (at[0], at[1] - 1)  # what comes back is of whole samples: taken for another reading
        taps[at] = taps.get(at, Fraction(0)) + own.force(*(Fraction(j == n) for j in range(6)))
    mine, its = (sum(abs(c) for at, c in taps.items() if at[0] is whose) for whose in (True, False))
    return (mine * arm.resolution + its * other.resolution) / 2
