"""Contact made and broken with a law fed with the position: one multiplier, and a sign on the circle."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from itertools import accumulate
from typing import Any

from ..document.reading import Invalid, Loop, common_scale, get, number, read_loop, with_no_more_than
from ..loop.proofs import _inside_unit_circle, _one_norm_bound, _positivity, _square_modulus


def multiplier_contact(document: Mapping[str, Any]) -> str:
    """4 λ κ |D|² ≥ |D − λ ζ^{d+1} N_G|² on the circle, κ = b/T − (2d + 1) K/2; 2 f_c ≥ (K + ‖H − K‖₁) Δ.

    H = K + (1 − ζ) N_G/D with K = H(1) ≥ 0 and D stable.  The force is K max(q, 0) + θ y with
    y = N_G/D Δq and any θ from 0 to 1: the law inside, nothing outside, a clamp between.
    """
    p = read_loop(document)
    law = get(document, "law")
    if get(law, "fed_with") != "position" or not isinstance(get(law, "never_pulls"), bool):
        raise Invalid("the law must be fed with the position, and never_pulls true or false")
    with_no_more_than(law, 2)
    if not p.unilateral:
        raise Invalid("contact is made and broken with a law that acts inside only")
    if p.part:
        raise Invalid("the delay is no whole number of samples")
    if not _inside_unit_circle(p.denominator):
        raise Invalid("H(z) has a pole outside or on the unit circle")
    stiffness = sum(p.numerator, Fraction(0)) / sum(p.denominator, Fraction(0))
    if stiffness < 0:
        raise Invalid("the static stiffness H(1) is negative")
    rest = [n - stiffness * d for n, d in zip(p.numerator, p.denominator, strict=True)]
    proof = get(document, "proof")
    multiplier = number(get(proof, "multiplier"))
    left = p.damping / p.period - (2 * p.whole + 1) * stiffness / 2
    if multiplier <= 0 or left < 0:
        raise Invalid("the multiplier must be > 0, and the damping at least what the spring alone needs")
    _positivity(get(proof, "positivity"), _circle(p, rest, multiplier, left))
    if p.resolution:
        bound = _one_norm_bound(p._replace(numerator=rest), get(proof, "norm"))
        if 2 * p.coulomb_friction < (stiffness + bound) * p.resolution:
            raise Invalid("the Coulomb friction is below (K + ‖H − K‖₁) Δ/2")
    return "b and f_c cover this law, fed with the position, clamped or not, with contact made and broken"


def _circle(p: Loop, rest: list[Fraction], multiplier: Fraction, left: Fraction) -> list[Fraction]:
    """4 λ κ |D|² − |D − λ ζ^{d+1} N_G|², ascending in c."""
    moved = [Fraction(0)] * (p.whole + 1) + [multiplier * c for c in accumulate(rest[:-1])]
    size = max(len(moved), len(p.denominator))
    moved, d = ([*c, *[Fraction(0)] * (size - len(c))] for c in (moved, p.denominator))
    scale = common_scale((*moved, *d))
    bottom = [int(c * scale) for c in d]
    gap = [int((x - y) * scale) for x, y in zip(d, moved, strict=True)]
    share = 4 * multiplier * left
    squares = (_square_modulus(part, size) for part in (bottom, gap))
    return [share * x - y for x, y in zip(*squares, strict=True)]
