"""Two devices joined by a spring and a damper over a link, each side computing from its own reading.

With ζ = z⁻¹, dᵢ + αᵢ samples of delay from reading to force, and nᵢ the age of the other's last reading,

    fᵢ = ζ^dᵢ (1 − αᵢ + αᵢ ζ) [(Kᵢ + (Bᵢ + Dᵢ)(1 − ζ)/T) xᵢ − ζ^nᵢ (Kᵢ + Bᵢ (1 − ζ)/T) xⱼ]

A reading arrives between two samples and is used at the next, so nᵢ = ⌈link delay/T⌉.  The work of the
follower counts K_l/K_f times: then the spring between the two gives back what it takes.

With a drive that reads its own arm m times in T the part of xᵢ is computed with T/m in the place of T, m
times as often; the part of xⱼ stays.  Compensation of friction, φ of `compensation`, is taken from the force:
computed once in T, from the move over the last T, and as late as fᵢ.
"""

from __future__ import annotations

from fractions import Fraction
from typing import NamedTuple

from ..document.fields import Number, Read, Record, Whole
from ..document.number import common_scale
from ..document.refusal import Invalid
from ..document.unit import DAMPING, FORCE, LENGTH, SECONDS, STIFFNESS
from .compensation import COMPENSATION

MOST_AGE = 400
"""Samples that a reading may be old where it acts."""

MOST_READINGS = 1000
"""Of its own that a drive takes in a sample period."""

SIDE = Record(
    {
        "damping": Number(DAMPING, least=0),
        "coulomb_friction": Number(FORCE, least=0),
        "resolution": Number(LENGTH, least=0),
        "delay": Number(SECONDS, least=0),
        "stiffness": Number(STIFFNESS, least=0),
        "virtual_damping": Number(DAMPING),
        "local_damping": Number(DAMPING),
        "reflection": Number(least=0, default=Fraction(0)),
        "link_delay": Number(SECONDS, least=0),
        "own_readings": Whole(least=1, most=MOST_READINGS, default=None),
        "compensation": COMPENSATION,
    },
    named=True,
)
PAIR = Record(
    {
        "sample_period": Number(SECONDS, above=0),
        "own_readings": Whole(least=1, most=MOST_READINGS, default=1),
        "leader": SIDE,
        "follower": SIDE,
    }
)


class Side(NamedTuple):
    """One device: its friction and encoder, and what its force is made of.

    `own` and `other` in ascending powers of ζ, the other's as old as it is where it arrives, `age`; `echo` is
    what of its own comes back with the other's force, older still, `echo_age`; the force
    comes `whole` + `part` samples later.  `weight` is how often its work counts, `law` its compensation,
    `often` how many readings of its own it takes in a sample.
    """

    damping: Fraction
    coulomb_friction: Fraction
    resolution: Fraction
    own: list[Fraction]
    other: list[Fraction]
    age: int
    echo: list[Fraction]
    echo_age: int
    whole: int
    part: Fraction
    weight: Fraction
    law: Read | None
    often: int


def sides_of(told: Read) -> tuple[Side, Side]:
    """Leader and follower."""
    leader, follower = (
        side.stiffness + side.reflection * other.stiffness
        for side, other in ((told.leader, told.follower), (told.follower, told.leader))
    )
    if not (leader and follower):
        raise Invalid("there is no spring to the other arm on one side")
    ratio = leader / follower
    period, most = told.sample_period, told.own_readings
    if most > 1 and (told.leader.delay or told.follower.delay):
        raise Invalid("the force of a drive that reads its arm more often must come without delay")
    return (
        _side(told.leader, told.follower, period, _often(told.leader, most), Fraction(1)),
        _side(told.follower, told.leader, period, _often(told.follower, most), ratio),
    )


def _often(told: Read, most: int) -> int:
    """Readings of its own in a sample: as many as the loop says, or a part of them."""
    often: int = told.own_readings or most
    if most % often:
        raise Invalid("an arm reads itself a whole number of times less often than the loop says")
    return often


def _side(told: Read, other: Read, period: Fraction, often: int, weight: Fraction) -> Side:
    whole, age = told.delay // period, -(-told.link_delay // period)
    if whole > MOST_AGE or age > MOST_AGE:
        raise Invalid(f"a reading is more than {MOST_AGE} samples old where it acts")
    shared = told.virtual_damping / period
    mine = often * (shared + told.local_damping / period)
    back = told.reflection * other.virtual_damping / period
    spring = told.reflection * other.stiffness
    side = Side(
        told.damping,
        told.coulomb_friction,
        told.resolution,
        [told.stiffness + mine, -mine],
        [-told.stiffness - spring - shared - back, shared + back],
        int(age),
        [spring + back, -back],
        int(age - (-other.link_delay // period)),
        int(whole),
        told.delay / period - whole,
        weight,
        told.compensation,
        often,
    )
    common_scale((*side.own, *side.other, *side.echo, side.damping, side.part, period, weight))
    return side
