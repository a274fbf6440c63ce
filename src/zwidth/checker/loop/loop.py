"""The loop that a document is about: a device of one axis, and a law H(z) that is linear."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from math import lcm
from typing import NamedTuple

from ..document.fields import Flag, Number, Read, Record, numbers
from ..document.number import DAMPING, FORCE, LENGTH, SECONDS, common_scale
from ..document.refusal import Invalid
from ..exact.polynomial import multiply, same

MOST_DELAY = 2000
"""In samples."""

DEVICE = {
    "damping": Number(DAMPING, least=0),
    "coulomb_friction": Number(FORCE, least=0),
    "resolution": Number(LENGTH, least=0),
    "sample_period": Number(SECONDS, above=0),
    "delay": Number(SECONDS, least=0),
}
LAW = {"numerator": numbers(least=1), "denominator": numbers(least=1)}
"""In descending powers of z, as many of the one as of the other or fewer."""

LOOP = Record({**DEVICE, **LAW, "unilateral": Flag()})


class Loop(NamedTuple):
    """A loop; a force acts `whole` + `part` samples after its position was read."""

    numerator: list[Fraction]  # N, D in ascending powers of 1/z
    denominator: list[Fraction]
    damping: Fraction
    coulomb_friction: Fraction
    resolution: Fraction
    period: Fraction
    whole: int
    part: Fraction
    unilateral: bool


def loop_of(told: Read) -> Loop:
    """The loop of a document, H(z) proper and of ordinary size."""
    numerator, denominator = proper(told.numerator, told.denominator)
    whole = told.delay // told.sample_period
    if whole > MOST_DELAY:
        raise Invalid(f"the delay is more than {MOST_DELAY} samples")
    return Loop(
        numerator,
        denominator,
        told.damping,
        told.coulomb_friction,
        told.resolution,
        told.sample_period,
        int(whole),
        told.delay / told.sample_period - whole,
        told.unilateral,
    )


def proper(
    numerator: Sequence[Fraction], denominator: Sequence[Fraction]
) -> tuple[list[Fraction], list[Fraction]]:
    """Both of one length, of a law that needs no reading before it is there."""
    if denominator[0] == 0 or len(numerator) > len(denominator):
        raise Invalid("H(z) must be proper, with a denominator that does not begin with 0")
    common_scale((*numerator, *denominator))
    padding = [Fraction(0)] * (len(denominator) - len(numerator))
    return [*padding, *numerator], list(denominator)


def require_whole_delay(p: Loop) -> None:
    """Refuse a delay that ends within a sample."""
    if p.part:
        raise Invalid("the delay must be a whole number of samples")


def require_surface(p: Loop) -> None:
    """Refuse a law that acts on both sides."""
    if not p.unilateral:
        raise Invalid("contact is made and broken with a law that acts inside only")


def require_law(p: Loop, top: Sequence[Fraction], bottom: Sequence[Fraction], message: str) -> None:
    """Refuse H(z) that is not top/bottom."""
    if not same(multiply(top, p.denominator), multiply(p.numerator, bottom)):
        raise Invalid(message)


def in_whole_numbers(coefficients: Sequence[Fraction], p: Loop) -> list[int]:
    """N or D times the integer that makes both whole."""
    scale = lcm(*(c.denominator for c in (*p.numerator, *p.denominator)))
    return [c.numerator * (scale // c.denominator) for c in coefficients]
