"""A violated criterion: a proof that a hand can take any amount of energy out of the loop.

With ζ = z⁻¹ = e^{−jθ}, c = cos θ, H = N(ζ)/D(ζ), M = ζᵈ (1 − α + α ζ) N and the delay (d + α) T any one
of these is enough, whatever Coulomb friction and encoder are, behind a surface and without one
(docs/theory/criterion.md):

criterion
    2b²/T |D|² + b (−R + (1 + c) S) − T α(1−α)/2 |N|² < 0 at one c of [−1, 1], where M D̄ = R + j sin θ S;
    for α = 0 without the factor b and the last term.
negative static stiffness
    H(1) < 0.
unstable environment
    A pole of H on or outside the unit circle; for α = 0 that b + T z⁻ᵈ H/(z − 1) is not positive real.

A polynomial is evaluated at the one point by Chebyshev's recurrences, in whole numbers.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from math import acos, pi
from typing import NamedTuple

from ..document.fields import Number, OneOf, Read, Record, document
from ..document.number import about
from ..document.refusal import Invalid, only_if
from ..exact.polynomial import bits
from ..exact.roots import inside_unit_circle
from .linear import positive_real_denominator, require_coprime
from .loop import LOOP, Loop, in_whole_numbers, loop_of

MOST_WORK = 2e10
"""Length of the polynomials squared, times the bits of c, times the bits of the longest factor."""

MOST_TERMS = 150
"""Coefficients of H(z) and samples of delay up to which roots are placed."""

VIOLATION = document(
    {
        "loop": LOOP,
        "proof": OneOf(
            "kind",
            {
                "criterion": Record({"cosine": Number(least=-1, most=1)}),
                "negative static stiffness": Record({}),
                "unstable environment": Record({"offset": Number(above=0, default=None)}),
            },
            shown=False,
        ),
    }
)


def violation(told: Read) -> str:
    """Confirm that the loop is active, and say why."""
    p, proof = loop_of(told.loop), told.proof
    if proof.kind == "criterion":
        return _violated(p, proof.cosine)
    if proof.kind == "negative static stiffness":
        return _negative(p)
    if only_if(not p.part, proof.offset, "offset"):
        return _not_positive_real(p, proof.offset)
    return _unstable(p)


def _violated(p: Loop, cosine: Fraction) -> str:
    if criterion_at(p, cosine) >= 0:
        raise Invalid("the criterion is not violated at this frequency")
    turns = Fraction(acos(cosine) / (2 * pi))
    return f"the linear criterion is violated at {about(turns / p.period)} Hz"


def _negative(p: Loop) -> str:
    if sum(p.numerator) * sum(p.denominator) >= 0:
        raise Invalid("the static stiffness H(1) is not negative")
    return "the static stiffness H(1) is negative"


def _not_positive_real(p: Loop, offset: Fraction) -> str:
    """With b + T z⁻ᵈ H/(z − 1) = n/d in lowest terms, n + g d has a root on or outside the circle, g > 0."""
    _require_lowest_terms(p)
    if inside_unit_circle(positive_real_denominator(p, offset)):
        raise Invalid("b + T z⁻ᵈ H/(z − 1) may be positive real: the offset does not show that it is not")
    return "the environment is unstable: b + T z⁻ᵈ H/(z − 1) is not positive real"


def _unstable(p: Loop) -> str:
    _require_lowest_terms(p)
    if inside_unit_circle(p.denominator):
        raise Invalid("every pole of H(z) lies inside the unit circle")
    return "the environment is unstable: H(z) has a pole on or outside the unit circle"


def _require_lowest_terms(p: Loop) -> None:
    if len(p.denominator) + p.whole > MOST_TERMS:
        raise Invalid("too many coefficients and samples of delay for the roots to be placed")
    require_coprime(p)


class _Value(NamedTuple):
    """Σ a_j ζʲ at one point, even − j sin θ odd, times the denominator of c to the power of its degree."""

    even: int
    odd: int


def criterion_at(p: Loop, c: Fraction) -> Fraction:
    """The criterion at cos θ = c = x/y, times b where α > 0, and times a power of y."""
    n, d = in_whole_numbers(p.numerator, p), in_whole_numbers(p.denominator, p)
    _bounded(len(n) + p.whole + 1, c, [*n, *d])
    x, y = c.numerator, c.denominator
    top, bottom, law = _at([*[0] * p.whole, *_mixed(n, p.part)], c), _at(d, c), _at(n, c)
    longer: int = y ** (p.whole + 1)  # M has so many coefficients more than D
    real = y * y * top.even * bottom.even + (y * y - x * x) * top.odd * bottom.odd
    slope = top.even * bottom.odd - top.odd * bottom.even
    hold = Fraction((x + y) * y * slope - real, p.part.denominator)
    dissipated = longer * _square_modulus(bottom, c)
    if not p.part:
        return 2 * p.damping / p.period * dissipated + hold
    lost = p.period * p.part * (1 - p.part) / 2 * longer * _square_modulus(law, c)
    return 2 * p.damping * p.damping / p.period * dissipated + p.damping * hold - lost


def _square_modulus(value: _Value, c: Fraction) -> int:
    """even² + sin² θ odd², times y²."""
    x, y = c.numerator, c.denominator
    return (y * value.even) ** 2 + (y * y - x * x) * value.odd**2


def _mixed(n: list[int], part: Fraction) -> list[int]:
    """(1 − α + α ζ) N times the denominator of α."""
    late, early = part.numerator, part.denominator - part.numerator
    return [early * x + late * y for x, y in zip([*n, 0], [0, *n], strict=True)]


def _bounded(size: int, c: Fraction, coefficients: list[int]) -> None:
    digits = max(c.denominator.bit_length(), 2)
    if size**2 * digits * (digits + bits(coefficients)) > MOST_WORK:
        raise Invalid("too many coefficients and digits for the criterion to be evaluated")


def _at(a: Sequence[int], c: Fraction) -> _Value:
    """cos jθ = T_j(c) and sin jθ/sin θ = U_{j−1}(c), each times the j-th power of the denominator of c."""
    x, y = c.numerator, c.denominator
    cosine, next_cosine, sine, next_sine = 1, x, 0, y
    even = odd = 0
    for coefficient in a:
        even, odd = even * y + coefficient * cosine, odd * y + coefficient * sine
        cosine, next_cosine = next_cosine, 2 * x * next_cosine - y * y * cosine
        sine, next_sine = next_sine, 2 * x * next_sine - y * y * sine
    return _Value(even, odd)
