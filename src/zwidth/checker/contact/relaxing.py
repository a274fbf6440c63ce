"""Contact made and broken with a law that relaxes: the law is the one it says, and b and f_c cover it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import Any, NamedTuple

from ..document.reading import Invalid, Loop, get, number, quantity, read_loop, with_no_more_than

MOST_PARTS = 60


class _Law(NamedTuple):
    """K + Σ g (1 − ζ)/(1 − p ζ), ζ = 1/z; parts as (p, g)."""

    stiffness: Fraction
    parts: list[tuple[Fraction, Fraction]]
    penetration: bool
    never_pulls: bool


def relaxing_contact(document: Mapping[str, Any]) -> str:
    """b and f_c are what the law needs, however it is touched and left.

    Fed with the penetration, without delay, with g > 0 and 0 ≤ p < 1 in every part, and with one
    part at most if it never pulls: b ≥ K T/2 + Σ g T/(1 + p) and 2 f_c ≥ (K + 2 Σ g) Δ.  Otherwise
    b ≥ (2d + 1) K T/2 + T Σ |g|/(1 − |p|) and 2 f_c ≥ (K + Σ |g| n) Δ, n = 2 or 2/(1 − |p|) for p < 0.
    """
    p = read_loop(document)
    if not p.unilateral:
        raise Invalid("contact is made and broken with a law that acts inside only")
    if p.part:
        raise Invalid("the delay is no whole number of samples")
    law = _read(get(document, "law"))
    _same_law(p, law)
    if p.damping < p.period * _damping(law, p.whole):
        raise Invalid("the damping is below what this law needs when it is touched and left")
    if 2 * p.coulomb_friction < (law.stiffness + sum(_norms(law), Fraction(0))) * p.resolution:
        raise Invalid("the Coulomb friction is below ‖h‖₁ Δ/2")
    clamp = "that never pulls, " if law.never_pulls else ""
    return f"b and f_c cover this law, fed with the {_word(law)}, {clamp}with contact made and broken"


def _word(law: _Law) -> str:
    return "penetration" if law.penetration else "position"


def _damping(law: _Law, delay: int) -> Fraction:
    """The damping it needs, over T."""
    relaxes = law.penetration and delay == 0 and all(g > 0 and p >= 0 for p, g in law.parts)
    if relaxes and (len(law.parts) <= 1 or not law.never_pulls):
        return law.stiffness / 2 + sum((g / (1 + p) for p, g in law.parts), Fraction(0))
    moved = sum((abs(g) / (1 - abs(p)) for p, g in law.parts), Fraction(0))
    return (2 * delay + 1) * law.stiffness / 2 + moved


def _norms(law: _Law) -> list[Fraction]:
    """‖h‖₁ of each part."""
    return [2 * abs(g) / (1 + min(p, Fraction(0))) for p, g in law.parts]


def _read(law: Any) -> _Law:
    parts, fed_with, never_pulls = (get(law, key) for key in ("parts", "fed_with", "never_pulls"))
    if not isinstance(parts, list) or len(parts) > MOST_PARTS:
        raise Invalid("the parts must be a short list")
    if fed_with not in ("penetration", "position") or not isinstance(never_pulls, bool):
        raise Invalid("fed_with must be penetration or position, and never_pulls true or false")
    with_no_more_than(law, 4)
    stiffness = quantity(law, "stiffness")
    if stiffness < 0:
        raise Invalid(f"the stiffness is negative: {float(stiffness):g}")
    return _Law(stiffness, [_part(part) for part in parts], fed_with == "penetration", never_pulls)


def _part(part: Any) -> tuple[Fraction, Fraction]:
    pole = number(get(part, "pole"))
    if abs(pole) >= 1:
        raise Invalid("a part does not relax")
    with_no_more_than(part, 2)
    return pole, quantity(part, "stiffness")


def _same_law(p: Loop, law: _Law) -> None:
    """K + Σ g (1 − ζ)/(1 − p ζ) is N/D."""
    top, bottom = [law.stiffness], [Fraction(1)]
    for pole, g in law.parts:
        line = [Fraction(1), -pole]
        top, bottom = _sum(_times(top, line), _times(bottom, [g, -g])), _times(bottom, line)
    left, right = _times(top, p.denominator), _times(p.numerator, bottom)
    if any(_sum(left, [-c for c in right])):
        raise Invalid("H(z) is not the law of the stiffness and parts given")


def _sum(a: Sequence[Fraction], b: Sequence[Fraction]) -> list[Fraction]:
    size = max(len(a), len(b))
    a, b = ([*c, *[Fraction(0)] * (size - len(c))] for c in (a, b))
    return [x + y for x, y in zip(a, b, strict=True)]


def _times(a: Sequence[Fraction], b: Sequence[Fraction]) -> list[Fraction]:
    out = [Fraction(0)] * (len(a) + len(b) - 1)
    for i, x in enumerate(a):
        if x:
            for j, y in enumerate(b):
                out[i + j] += x * y
    return out
