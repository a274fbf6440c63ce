"""Two devices joined by a spring and a damper over a link, each side computing from its own reading.

With ζ = z⁻¹, dᵢ + αᵢ samples of delay from reading to force, and nᵢ the age of the other's last reading,

    fᵢ = ζ^dᵢ (1 − αᵢ + αᵢ ζ) [(Kᵢ + (Bᵢ + Dᵢ)(1 − ζ)/T) xᵢ − ζ^nᵢ (Kᵢ + Bᵢ (1 − ζ)/T) xⱼ]

A reading arrives between two samples and is used at the next, so nᵢ = ⌈link delay/T⌉.  The work of the
follower counts K_l/K_f times: then the spring between the two gives back what it takes.

With a drive that reads its own arm m times in T the part of xᵢ is computed with T/m in the place of T, m
times as often; the part of xⱼ stays.  Compensation of friction, φ below, is taken from the force:
computed once in T, from the move over the last T, and as late as fᵢ.
"""

from __future__ import annotations

from fractions import Fraction
from typing import NamedTuple

from ..document.fields import Choice, Number, Read, Record, Whole
from ..document.number import DAMPING, FORCE, LENGTH, SECONDS, SPEED, STIFFNESS, common_scale
from ..document.refusal import Invalid, spend

# Compensation of friction: a force φ(v̂) in the direction of motion, v̂ an arm's move over a sample.
#
#     φ(v) = F tanh(v/v_s) + C v;    v_s = 0: F in the direction of v
#
# tanh is concave for v > 0, so each of its tangents lies above it: at tanh = r
#
#     F tanh(v/v_s) ≤ h + s v,    s = (F/v_s)(1 − r²),    h = F (r − (1 − r²) artanh r),
#
# and r = 1 is h = F, s = 0.  As 0 ≤ F tanh for v > 0, what is left of it beside s v/2 is at most h + s v/2:
# by Cauchy–Schwarz it takes no more than h of Coulomb friction and s/2 of damping.  The rest, (C + s/2) v̂,
# is a local damping of minus that (docs/theory/pairs.md).
#
# All of h + (C + s) |v̂| takes no more than h and C + s, if v̂ is any mean of past moves with fixed weights
# whose sizes add up to 1 at most: then it is in the mean of squares no more than the speed.

COMPENSATION = Record(
    {
        "compensated_coulomb_friction": Number(FORCE, least=0),
        "compensated_damping": Number(DAMPING, least=0),
        "compensation_speed": Number(SPEED, least=0),
    },
    default=None,
)
TANGENTS = Record(
    {
        **{name: Number(least=0, most=1, default=Fraction(1)) for name in ("leader", "follower")},
        "speed": Choice("last move", "any mean", default="last move"),
    },
    default=None,
)
"""The r of each arm, and what v̂ is."""
BITS = 128
"""Of tanh in a motion that is run again."""
_BITS = 192
"""Of what comes before."""


class Line(NamedTuple):
    """What a tangent takes: h of Coulomb friction, of damping, and of local damping."""

    height: Fraction
    still: Fraction
    moving: Fraction


NO_LINE = Line(Fraction(0), Fraction(0), Fraction(0))


def line_of(law: Read | None, r: Fraction, speed: str = "last move") -> Line:
    """The tangent at r of F tanh(v/v_s), its height rounded up, and C."""
    if law is None:
        return NO_LINE
    height, slope = law.compensated_coulomb_friction, Fraction(0)
    if r < 1:
        if not law.compensation_speed:
            raise Invalid("compensation in the direction of motion at any speed has no tangent below 1")
        rest = 1 - r**2
        height, slope = height * (r - rest * artanh_below(r)), height / law.compensation_speed * rest
    if speed == "any mean":
        return Line(height, law.compensated_damping + slope, Fraction(0))
    return Line(height, slope / 2, law.compensated_damping + slope / 2)


def artanh_below(r: Fraction) -> Fraction:
    """A number that is no more than artanh r and within 2^−150 of it in proportion, 0 ≤ r < 1.

    2 artanh r = ln (1 + r)/(1 − r) = ln 2^k m, 1 ≤ m < 4: so artanh r = k artanh ⅓ + artanh (m − 1)/(m + 1).
    """
    y = (1 + r) / (1 - r)
    spend(400, _BITS, y.numerator.bit_length())
    k = max(0, y.numerator.bit_length() - y.denominator.bit_length() - 1)
    m = y / 2**k
    rest = (m - 1) / (m + 1)
    return Fraction(k * _series(Fraction(1, 3)) + _series(rest), 1 << _BITS)


def _series(t: Fraction) -> int:
    """t + t³/3 + t⁵/5 + …, every term rounded down, in units of 2^−192; t ≤ 3/5."""
    power = (t.numerator << _BITS) // t.denominator
    square = power * power >> _BITS
    total, n = 0, 1
    while power:
        total, power, n = total + power // n, power * square >> _BITS, n + 2
    return total


def tanh_between(x: Fraction) -> tuple[int, int]:
    """Two numbers with tanh x between them, in units of 2^−`BITS`; x ≥ 0."""
    one, unit = 1 << BITS, 1 << _BITS
    if x > BITS // 2:  # 1 − tanh x < 2 e^{−2x} < 2^{−bits}
        return one - 1, one
    far = _exponential(2 * x)
    found = ((far - unit) << BITS) // (far + unit)
    return max(0, found - 1), found + 2


def _exponential(y: Fraction) -> int:
    """e^y in units of 2^−192, 0 ≤ y ≤ 128, by less than 2^−180 of it too small.

    No term is negative, and each of some 500 is rounded down.
    """
    spend(600, 2 * _BITS, y.numerator.bit_length())
    small = (y.numerator << _BITS) // y.denominator
    total = term = 1 << _BITS
    n = 1
    while term:
        term = term * small // (n << _BITS)
        total, n = total + term, n + 1
    return total


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
