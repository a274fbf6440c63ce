"""Compensation of friction: a force φ(v̂) in the direction of motion, v̂ an arm's move over a sample.

    φ(v) = F tanh(v/v_s) + C v;    v_s = 0: F in the direction of v

tanh is concave for v > 0, so each of its tangents lies above it: at tanh = r

    F tanh(v/v_s) ≤ h + s v,    s = (F/v_s)(1 − r²),    h = F (r − (1 − r²) artanh r),

and r = 1 is h = F, s = 0.  As 0 ≤ F tanh for v > 0, what is left of it beside s v/2 is at most h + s v/2: by
Cauchy–Schwarz it takes no more than h of Coulomb friction and s/2 of damping.  The rest, (C + s/2) v̂, is a
local damping of minus that (docs/theory/pairs.md).

All of h + (C + s) |v̂| takes no more than h and C + s, if v̂ is any mean of past moves with fixed weights whose
sizes add up to 1 at most: then it is in the mean of squares no more than the speed.
"""

from __future__ import annotations

from fractions import Fraction
from typing import NamedTuple

from ..document.effort import spend
from ..document.fields import Choice, Number, Read, Record
from ..document.refusal import Invalid
from ..document.unit import DAMPING, FORCE, SPEED

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
