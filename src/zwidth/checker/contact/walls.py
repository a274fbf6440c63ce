"""Closed conditions with contact made and broken: damped walls, slow hands on them, laws that relax."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import Any, NamedTuple

from ..document.fields import Choice, Either, Flag, List, Number, Read, Record, document, numbers
from ..document.number import DAMPING, FORCE, SPEED, STIFFNESS, down
from ..document.refusal import Invalid, only_if
from ..exact.polynomial import add, multiply
from ..loop.loop import LOOP, Loop, loop_of, require_law, require_surface, require_whole_delay
from ..loop.spring import spring

# Contact made and broken with a damped wall: the law is the one it says, and b and f_c cover it.

_POLE = Record({"pole": Number(least=0, below=1)})
WALL = Record(
    {
        "stiffness": Number(STIFFNESS, least=0),
        "virtual_damping": Number(DAMPING),
        "weights": Either(_POLE, numbers(), lambda value: isinstance(value, Mapping)),
    }
)
CONTACT = document({"loop": LOOP, "law": WALL})


class _Estimate(NamedTuple):
    """v = W(ζ) (1 − ζ) q/T, ζ = 1/z: W as a fraction, ascending in ζ; Σ|w_j| and T ‖h_v‖₁."""

    top: list[Fraction]
    bottom: list[Fraction]
    gain: Fraction
    variation: Fraction


def contact(told: Read) -> str:
    """b (b − Q) ≥ α(1 − α) (K T + 2 |B| Σ|w_j|)²/4, b ≥ Q, and 2 f_c ≥ (K + |B| ‖h_v‖₁) Δ, with K ≥ 0.

    Q = (2d + 1 + 2α) K T/2 + |B| Σ|w_j|.  Storage: ½ K max(x − Δ/2, 0)², and of each past move its
    square times what the velocity estimate and the delay will still make of it.  Where a delay of d + α
    samples changes the force inside one, the hand leans on the stronger of the two: what that is worth, the
    square of their difference, is in the sum no more than the right side times that of the moves.
    """
    p, law = loop_of(told.loop), told.law
    require_surface(p)
    k, b = law.stiffness, abs(law.virtual_damping)
    estimate = _estimate(law.weights)
    _require_same_law(p, k, law.virtual_damping, estimate)
    reach = k * p.period / 2 * (2 * p.whole + 1 + 2 * p.part) + b * estimate.gain
    inside = p.part * (1 - p.part) / 4 * (k * p.period + 2 * b * estimate.gain) ** 2
    if p.damping < reach or p.damping * (p.damping - reach) < inside:
        raise Invalid("the damping is below what hold, delay and virtual damping of this wall need")
    if 2 * p.coulomb_friction < (k + b * estimate.variation / p.period) * p.resolution:
        raise Invalid("the Coulomb friction is below (K + |B| ‖h_v‖₁) Δ/2")
    return "b and f_c cover this wall, clamped or not, with contact made and broken"


def _estimate(weights: Any) -> _Estimate:
    one = [Fraction(1)]
    if isinstance(weights, Read):
        pole: Fraction = weights.pole
        return _Estimate([1 - pole], [Fraction(1), -pole], Fraction(1), 2 * (1 - pole))
    response = multiply(weights, [Fraction(1), Fraction(-1)])
    gain, variation = (sum(map(abs, w), Fraction(0)) for w in (weights, response))
    return _Estimate(weights, one, gain, variation)


def _require_same_law(p: Loop, k: Fraction, b: Fraction, estimate: _Estimate) -> None:
    """K + B W(ζ) (1 − ζ)/T is N/D."""
    moved = multiply(estimate.top, [b / p.period, -b / p.period])
    top = add(moved, [k * c for c in estimate.bottom])
    message = "H(z) is not the wall of the stiffness, virtual damping and weights given"
    require_law(p, top, estimate.bottom, message)


# Slow hands: Coulomb friction that is left over makes up for damping that is missing.
#
#     f_c + b u ≥ f_0 + b_0 u  for all 0 ≤ u ≤ v     exactly if    f_c ≥ f_0  and  f_c − f_0 ≥ (b_0 − b) v
#
# Of a move D in a time t during which the force is held, friction takes at least f_c |D| + (b/t) D², as much
# as (f_0, b_0) would where |D|/t ≤ v.  So what covers every hand with (f_0, b_0) covers these hands with
# (f_c, b).


_ENOUGH = Record(
    {
        "kind": Choice("spring", "contact"),
        "damping": Number(DAMPING, least=0),
        "coulomb_friction": Number(FORCE, least=0),
    },
    shown=False,
)
"""What covers every hand, with contact made and broken."""
SLOW_HANDS = document(
    {
        "loop": LOOP,
        "law": Record(WALL.fields, default=None),
        "largest_speed": Number(SPEED, least=0),
        "enough": _ENOUGH,
    }
)


def slow_hands(told: Read) -> str:
    """Say what was proved."""
    enough, loop = told.enough, told.loop
    left_over = loop.coulomb_friction - enough.coulomb_friction
    if left_over < 0 or left_over < (enough.damping - loop.damping) * told.largest_speed:
        raise Invalid("at this speed the friction left over is less than the damping that is missing")
    stronger = Read(**{**vars(loop), "damping": enough.damping, "coulomb_friction": enough.coulomb_friction})
    if only_if(enough.kind == "contact", told.law, "law"):
        contact(Read(loop=stronger, law=told.law))
    else:
        spring(Read(loop=stronger))
    unit = "rad/s" if told.units == "rotary" else "m/s"
    return (
        f"for hands of up to {down(told.largest_speed)} {unit}, over each time in which one force is held, "
        "Coulomb friction makes up for the damping that is missing, contact made and broken"
    )


# Contact made and broken with a law that relaxes: the law is the one it says, and b and f_c cover it.


MOST_PARTS = 60
_PART = Record({"pole": Number(above=-1, below=1), "stiffness": Number(STIFFNESS)})
_LAW = Record(
    {
        "stiffness": Number(STIFFNESS, least=0),
        "parts": List(_PART, most=MOST_PARTS),
        "fed_with": Choice("penetration", "position"),
        "never_pulls": Flag(),
    }
)
RELAXING_CONTACT = document({"loop": LOOP, "law": _LAW})


def relaxing_contact(told: Read) -> str:
    """b and f_c are what the law needs, however it is touched and left.

    Fed with the penetration, without delay, with g > 0 and 0 ≤ p < 1 in every part, and with one
    part at most if it never pulls: b ≥ K T/2 + Σ g T/(1 + p) and 2 f_c ≥ (K + 2 Σ g) Δ.  Otherwise
    b ≥ (2d + 1) K T/2 + T Σ |g|/(1 − |p|) and 2 f_c ≥ (K + Σ |g| n) Δ, n = 2 or 2/(1 − |p|) for p < 0.
    """
    p, law = loop_of(told.loop), told.law
    require_surface(p)
    require_whole_delay(p)
    _require_parts(p, law)
    if p.damping < p.period * _damping(law, p.whole):
        raise Invalid("the damping is below what this law needs when it is touched and left")
    if 2 * p.coulomb_friction < (law.stiffness + sum(_norms(law), Fraction(0))) * p.resolution:
        raise Invalid("the Coulomb friction is below ‖h‖₁ Δ/2")
    clamp = "that never pulls, " if law.never_pulls else ""
    return f"b and f_c cover this law, fed with the {law.fed_with}, {clamp}with contact made and broken"


def _damping(law: Read, delay: int) -> Fraction:
    """The damping it needs, over T."""
    relaxes = all(part.stiffness > 0 and part.pole >= 0 for part in law.parts)
    moves_back = law.never_pulls and len(law.parts) > 1
    stiffness: Fraction = law.stiffness
    if law.fed_with == "penetration" and delay == 0 and relaxes and not moves_back:
        return stiffness / 2 + sum((part.stiffness / (1 + part.pole) for part in law.parts), Fraction(0))
    moved = sum((abs(part.stiffness) / (1 - abs(part.pole)) for part in law.parts), Fraction(0))
    return (2 * delay + 1) * stiffness / 2 + moved


def _norms(law: Read) -> list[Fraction]:
    """‖h‖₁ of each part."""
    return [2 * abs(part.stiffness) / (1 + min(part.pole, Fraction(0))) for part in law.parts]


def _require_parts(p: Loop, law: Read) -> None:
    """K + Σ g (1 − ζ)/(1 − p ζ) is N/D."""
    top, bottom = [law.stiffness], [Fraction(1)]
    for part in law.parts:
        line = [Fraction(1), -part.pole]
        moved = multiply(bottom, [part.stiffness, -part.stiffness])
        top, bottom = add(multiply(top, line), moved), multiply(bottom, line)
    require_law(p, top, bottom, "H(z) is not the law of the stiffness and parts given")
