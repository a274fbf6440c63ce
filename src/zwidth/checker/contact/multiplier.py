"""Contact made and broken with a law fed with the position: one multiplier, and a sign on the circle."""

from __future__ import annotations

from fractions import Fraction
from itertools import accumulate

from ..document.fields import Choice, Flag, Number, Read, Record, document
from ..document.number import common_scale
from ..document.refusal import Invalid, only_if
from ..exact.polynomial import square_modulus
from ..exact.positivity import POSITIVITY, require_nonnegative
from ..loop.linear import NORM, one_norm_bound, require_stable_by_itself
from ..loop.loop import LOOP, Loop, loop_of, require_surface, require_whole_delay

MULTIPLIER_CONTACT = document(
    {
        "loop": LOOP,
        "law": Record({"fed_with": Choice("position"), "never_pulls": Flag()}),
        "proof": Record({"multiplier": Number(above=0), "positivity": POSITIVITY, "norm": NORM}, shown=False),
    }
)


def multiplier_contact(told: Read) -> str:
    """4 λ κ |D|² ≥ |D − λ ζ^{d+1} N_G|² on the circle, κ = b/T − (2d + 1) K/2; 2 f_c ≥ (K + ‖H − K‖₁) Δ.

    H = K + (1 − ζ) N_G/D with K = H(1) ≥ 0 and D stable.  The force is K max(q, 0) + θ y with
    y = N_G/D Δq and any θ from 0 to 1: the law inside, nothing outside, a clamp between.
    """
    p, proof = loop_of(told.loop), told.proof
    require_surface(p)
    require_whole_delay(p)
    require_stable_by_itself(p)
    stiffness = sum(p.numerator, Fraction(0)) / sum(p.denominator, Fraction(0))
    rest = [n - stiffness * d for n, d in zip(p.numerator, p.denominator, strict=True)]
    left = p.damping / p.period - (2 * p.whole + 1) * stiffness / 2
    if left < 0:
        raise Invalid("the damping is below what the spring alone needs")
    require_nonnegative(_circle(p, rest, proof.multiplier, left), proof.positivity)
    if only_if(p.resolution, proof.norm, "norm"):
        bound = one_norm_bound(p._replace(numerator=rest), proof.norm)
        if 2 * p.coulomb_friction < (stiffness + bound) * p.resolution:
            raise Invalid("the Coulomb friction is below (K + ‖H − K‖₁) Δ/2")
    return "b and f_c cover this law, fed with the position, clamped or not, with contact made and broken"


def _circle(p: Loop, rest: list[Fraction], multiplier: Fraction, left: Fraction) -> list[Fraction]:
    """4 λ κ |D|² − |D − λ ζ^{d+1} N_G|², ascending in c."""
    moved = [Fraction(0)] * (p.whole + 1) + [multiplier * c for c in accumulate(rest[:-1])]
    d = [*p.denominator, *[Fraction(0)] * (len(moved) - len(p.denominator))]
    scale = common_scale((*moved, *d))
    bottom = [int(c * scale) for c in d]
    gap = [int((x - y) * scale) for x, y in zip(d, moved, strict=True)]
    share = 4 * multiplier * left
    squares = (square_modulus(part, len(d)) for part in (bottom, gap))
    return [share * x - y for x, y in zip(*squares, strict=True)]
