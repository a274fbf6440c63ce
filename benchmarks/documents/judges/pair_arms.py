"""The numbers of two arms, as a judge reads them from a document."""

from __future__ import annotations

from fractions import Fraction
from functools import partial
from itertools import product
from math import ceil
from typing import Any, NamedTuple

import numpy as np

from ..plain import exact, quantity

Document = dict[str, Any]


class Arm(NamedTuple):
    """Of a document, as docs/json.md says; `period` from one reading of its own to the next.

    `dry`, `viscous` and `speed` are F, C and v_s of what compensates its friction.
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
    dry: Fraction = Fraction(0)
    viscous: Fraction = Fraction(0)
    speed: Fraction = Fraction(0)

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
    return max(
        abs(own.force(*(s * r.resolution / 2 for s, r in zip(signs, (arm, arm, other, other), strict=True))))
        for signs in product((-1, 1), repeat=4)
    )
