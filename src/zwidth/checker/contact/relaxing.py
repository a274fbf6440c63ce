"""Contact made and broken with a law that relaxes: the law is the one it says, and b and f_c cover it."""

from __future__ import annotations

from fractions import Fraction

from ..document.fields import Choice, Flag, List, Number, Read, Record, document
from ..document.refusal import Invalid
from ..document.unit import STIFFNESS
from ..exact.polynomial import add, multiply
from ..loop.loop import LOOP, Loop, loop_of, require_law, require_surface, require_whole_delay

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
    _require_same_law(p, law)
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


def _require_same_law(p: Loop, law: Read) -> None:
    """K + Σ g (1 − ζ)/(1 − p ζ) is N/D."""
    top, bottom = [law.stiffness], [Fraction(1)]
    for part in law.parts:
        line = [Fraction(1), -part.pole]
        moved = multiply(bottom, [part.stiffness, -part.stiffness])
        top, bottom = add(multiply(top, line), moved), multiply(bottom, line)
    require_law(p, top, bottom, "H(z) is not the law of the stiffness and parts given")
