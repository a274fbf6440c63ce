"""A hand of activity a: in the place of b stands b − a, everywhere or below f₀ only.

everywhere   the loop with damping b − a is passive, by a proof of its own
below f₀     q ≥ 0 with b on all of [−1, 1], and with b_in on [c₀, 1], c₀ ≤ cos 2πf₀T
             b_in = b − a, or b (b − a)/(b − a θ²/12) where a > b, 2πf₀T ≤ θ
"""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import Any

from ..contact.damped_wall import contact
from ..contact.multiplier import multiplier_contact
from ..contact.relaxing import relaxing_contact
from ..document.reading import Invalid, Loop, get, number, quantity, read_loop
from .proofs import PROOFS, _criterion, _friction, _linear_part, _positivity

MOST_BITS_OF_ANGLE = 4000  # high powers of it are taken
_PI = Fraction(31415926535897932385, 10**19)
"""Above π, by less than its last digit."""
_LESS_THAN_PI = _PI - Fraction(1, 10**19)


def active_hand(document: Mapping[str, Any]) -> str:
    p, proof = read_loop(document), get(document, "proof")
    activity = _activity(document)
    if isinstance(proof, Mapping) and "reduced" in proof:
        return _everywhere(p, activity, proof["reduced"])
    return _in_band(document, p, activity, proof)


def _activity(document: Mapping[str, Any]) -> Fraction:
    found = quantity(document, "activity")
    if found < 0:
        raise Invalid("the activity must be ≥ 0")
    return found


def _everywhere(p: Loop, activity: Fraction, reduced: Mapping[str, Any]) -> str:
    kinds = {
        **PROOFS,
        "contact": contact,
        "relaxing contact": relaxing_contact,
        "multiplier contact": multiplier_contact,
    }
    kind = get(reduced, "kind")
    if kind not in kinds or kind == "delays":
        raise Invalid("the loop with less damping needs a proof of passivity")
    reason = kinds[kind](reduced)
    less = read_loop(reduced)
    if less._replace(damping=less.damping + activity) != p:
        raise Invalid("the loop that is proved is not this one with the activity taken from its damping")
    return f"with the activity taken from the damping, {reason}"


def _in_band(document: Mapping[str, Any], p: Loop, activity: Fraction, proof: Mapping[str, Any]) -> str:
    if p.part:
        raise Invalid("a band is proved for delays of whole samples")
    if get(get(proof, "stability"), "kind") != "open loop":
        raise Invalid("a band is proved for laws that are stable by themselves")
    _linear_part(document, p)
    if p.resolution:
        _friction(p, proof)
    below = number(get(document, "below_Hz"))
    if below <= 0 or 2 * below * p.period > 1:
        raise Invalid("the band must end above 0 and at most at half the rate")
    angle, cosine = number(get(proof, "angle")), number(get(proof, "cosine"))
    if max(x.denominator for x in (angle, cosine)).bit_length() > MOST_BITS_OF_ANGLE or angle > 4:
        raise Invalid("the angle of the band is too large, or has too many digits")
    if angle < 2 * _PI * below * p.period or not -1 <= cosine <= _least_cosine(angle):
        raise Invalid("the band of the proof is narrower than what is said")
    inside = p._replace(damping=_inside(p.damping, activity, angle))
    _positivity(get(proof, "in_band"), _from(_criterion(inside), cosine))
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


def _from(q: list[Fraction], low: Fraction) -> list[Fraction]:
    """q(c) in t, c = ((1 + low) + (1 − low) t)/2: −1 … 1 is low … 1."""
    middle, half = (1 + low) / 2, (1 - low) / 2
    total = [Fraction(0)]
    for c in reversed(q):
        times = [Fraction(0), *total]
        total = [middle * x for x in total] + [Fraction(0)]
        total = [x + half * y for x, y in zip(total, times, strict=True)]
        total[0] += c
    return total
