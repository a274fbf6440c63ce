"""Rationals as text, digit for digit."""

from __future__ import annotations

from decimal import Decimal
from fractions import Fraction


def exact_text(value: Fraction) -> str:
    """A rational as decimal text where it ends, else as "p/q"."""
    decimal = as_decimal(value)
    return f"{value.numerator}/{value.denominator}" if decimal is None else str(decimal)


def as_decimal(value: Fraction) -> Decimal | None:
    """The finite decimal equal to a rational, or None."""
    rest, twos, fives = value.denominator, 0, 0
    while rest % 2 == 0:
        rest, twos = rest // 2, twos + 1
    while rest % 5 == 0:
        rest, fives = rest // 5, fives + 1
    if rest != 1:
        return None
    places = max(twos, fives)
    digits = value.numerator * 10**places // value.denominator
    return Decimal((int(digits < 0), tuple(int(d) for d in str(abs(digits))), -places))
