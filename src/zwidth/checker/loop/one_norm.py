"""The encoder's error is at most Δ/2 about its middle: it moves the force by ‖h‖₁ Δ/2, which f_c must cover.

‖H‖₁ ≤ Σ|r|/(1 − |p|) + ‖R E‖₁/(|e₀| − ‖S E − e₀‖₁),    H = Σ r/(1 − p ζ) + R/S, any polynomial E
"""

from __future__ import annotations

from fractions import Fraction

from ..document.effort import spend
from ..document.fields import List, Number, Read, Record, numbers
from ..document.refusal import Invalid
from ..exact.polynomial import add, bits, cleared, multiply
from .loop import Loop, require_law

MOST_MODES = 60

NORM = Record(
    {
        "modes": List(Record({"pole": Number(above=-1, below=1), "residue": Number()}), most=MOST_MODES),
        "rest_numerator": numbers(),
        "rest_denominator": numbers(least=1),
        "inverse": numbers(least=1),
    },
    default=None,
    shown=False,
)


def require_friction(p: Loop, norm: Read) -> None:
    """Refuse a loop whose Coulomb friction does not cover its encoder."""
    if one_norm_bound(p, norm) * p.resolution > 2 * p.coulomb_friction:
        raise Invalid("the Coulomb friction is below ‖h‖₁ Δ/2")


def one_norm_bound(p: Loop, norm: Read) -> Fraction:
    """The bound that the document gives, of a sum that is shown to be H(z)."""
    top, bottom = norm.rest_numerator or [Fraction(0)], norm.rest_denominator
    bound = _of_the_rest(top, bottom, norm.inverse)
    for mode in norm.modes:
        bound += abs(mode.residue) / (1 - abs(mode.pole))
        line = [Fraction(1), -mode.pole]
        top, bottom = add(multiply(top, line), [mode.residue * c for c in bottom]), multiply(bottom, line)
    require_law(p, top, bottom, "the modes and the rest do not sum to H(z)")
    return bound


def _of_the_rest(top: list[Fraction], bottom: list[Fraction], inverse: list[Fraction]) -> Fraction:
    longest = sum(bits(cleared(part)) for part in (top, bottom, inverse))
    spend(len(inverse) * (len(top) + len(bottom)), longest)
    product = multiply(bottom, inverse)
    slack = abs(product[0]) - sum(abs(c) for c in product[1:])
    if slack <= 0:
        raise Invalid("the inverse does not bound the impulse response")
    return sum((abs(c) for c in multiply(top, inverse)), Fraction(0)) / slack
