"""A hand of activity a: in the place of b stands b − a, everywhere or below f₀ only.

everywhere   the loop with damping b − a is passive, by a proof of its own
below f₀     q ≥ 0 with b on all of [−1, 1], and with b_in on [c₀, 1], c₀ ≤ cos 2πf₀T
             b_in = b − a, or b (b − a)/(b − a θ²/12) where a > b, 2πf₀T ≤ θ
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction

from .contact.multiplier import MULTIPLIER_CONTACT, multiplier_contact
from .contact.walls import CONTACT, RELAXING_CONTACT, contact, relaxing_contact
from .document.fields import Either, Number, OneOf, Read, Record, document
from .document.number import DAMPING, HERTZ
from .document.refusal import Invalid, only_if
from .exact.positivity import POSITIVITY, require_nonnegative
from .loop.linear import (
    CRITERION,
    LINEAR,
    NORM,
    QUANTIZED,
    criterion,
    linear,
    quantized,
    require_criterion,
    require_friction,
)
from .loop.loop import LOOP, Loop, loop_of
from .loop.spring import SPRING, spring

MOST_BITS_OF_ANGLE = 4000  # high powers of it are taken
_PI = Fraction(31415926535897932385, 10**19)
"""Above π, by less than its last digit."""
_LESS_THAN_PI = _PI - Fraction(1, 10**19)
REDUCED: dict[str, tuple[Record, Callable[[Read], str]]] = {
    "spring": (SPRING, spring),
    "linear": (LINEAR, linear),
    "quantized": (QUANTIZED, quantized),
    "contact": (CONTACT, contact),
    "relaxing contact": (RELAXING_CONTACT, relaxing_contact),
    "multiplier contact": (MULTIPLIER_CONTACT, multiplier_contact),
}
"""Proofs of passivity that the loop with less damping may have."""
_EVERYWHERE = Record({"reduced": OneOf("kind", {kind: fields for kind, (fields, _) in REDUCED.items()})})
_IN_BAND = Record(
    {
        **CRITERION,
        "norm": NORM,
        "angle": Number(above=0, most=4),
        "cosine": Number(least=-1),
        "in_band": POSITIVITY,
    }
)
ACTIVE_HAND = document(
    {
        "loop": LOOP,
        "activity": Number(DAMPING, least=0),
        "below": Number(HERTZ, above=0, default=None),
        "proof": Either(_EVERYWHERE, _IN_BAND, lambda value: "reduced" in value, shown=False),
    }
)


def active_hand(told: Read) -> str:
    """Say what was proved."""
    p = loop_of(told.loop)
    if only_if(hasattr(told.proof, "in_band"), told.below, "below_Hz"):
        return _in_band(p, told.activity, told.below, told.proof)
    return _everywhere(p, told.activity, told.proof.reduced)


def _everywhere(p: Loop, activity: Fraction, reduced: Read) -> str:
    _, check = REDUCED[reduced.kind]
    reason = check(reduced)
    less = loop_of(reduced.loop)
    if less._replace(damping=less.damping + activity) != p:
        raise Invalid("the loop that is proved is not this one with the activity taken from its damping")
    return f"with the activity taken from the damping, {reason}"


def _in_band(p: Loop, activity: Fraction, below: Fraction, proof: Read) -> str:
    if p.part:
        raise Invalid("a band is proved for delays of whole samples")
    if proof.stability.kind != "open loop":
        raise Invalid("a band is proved for laws that are stable by themselves")
    require_criterion(proof, p)
    if only_if(p.resolution, proof.norm, "norm"):
        require_friction(p, proof.norm)
    if 2 * below * p.period > 1:
        raise Invalid("the band must end at most at half the rate")
    if max(x.denominator for x in (proof.angle, proof.cosine)).bit_length() > MOST_BITS_OF_ANGLE:
        raise Invalid("the angle of the band has too many digits")
    if proof.angle < 2 * _PI * below * p.period or proof.cosine > _least_cosine(proof.angle):
        raise Invalid("the band of the proof is narrower than what is said")
    inside = p._replace(damping=_inside(p.damping, activity, proof.angle))
    require_nonnegative(_from(criterion(inside), proof.cosine), proof.in_band)
    return "the criterion holds with b − a in the band and with b above it, and the environment is stable"


def _inside(b: Fraction, a: Fraction, angle: Fraction) -> Fraction:
    if a <= b:
        return b - a
    rest = b - a * angle**2 / 12
    if rest <= 0:
        raise Invalid("no damping of a wall is enough for this activity in so wide a band")
    return b * (b - a) / rest


def _least_cosine(angle: Fraction) -> Fraction:
    """Below cos x for every x from 0 to an angle: beyond π the cosine rises again."""
    return max(Fraction(-1), _cosine_from_below(angle)) if angle < _LESS_THAN_PI else Fraction(-1)


def _cosine_from_below(angle: Fraction) -> Fraction:
    """Σ_{k<16} (−1)ᵏ x²ᵏ/(2k)!, which ends with a negative term: below cos x for all x."""
    total, term = Fraction(0), Fraction(1)
    for k in range(16):
        total += term
        term *= -(angle**2) / ((2 * k + 1) * (2 * k + 2))
    return total


def _from(q: Sequence[Fraction], low: Fraction) -> list[Fraction]:
    """q(c) in t, c = ((1 + low) + (1 − low) t)/2: −1 … 1 is low … 1."""
    middle, half = (1 + low) / 2, (1 - low) / 2
    total = [Fraction(0)]
    for c in reversed(q):
        times = [Fraction(0), *total]
        total = [middle * x for x in total] + [Fraction(0)]
        total = [x + half * y for x, y in zip(total, times, strict=True)]
        total[0] += c
    return total
