"""Numbers of a document, exact: whole, decimal or a fraction, in plain digits, of ordinary size."""

from __future__ import annotations

import re
from collections.abc import Iterable
from decimal import ROUND_CEILING, ROUND_FLOOR, ROUND_HALF_EVEN, Context, Decimal
from fractions import Fraction
from math import lcm
from typing import Any

from .effort import spend
from .refusal import Invalid

LONGEST_NUMBER = 20_000
_READ = 60
"""What reading a number costs, and showing it, beside its digits, in steps of work."""
LARGEST_EXPONENT = 5000
MOST_BITS = 400_000
MOST_BITS_OF_A_LAW = 20_000

_NUMBER = re.compile(r"[+-]?[0-9]+/[0-9]+|[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?[0-9]+)?")
"""A fraction or a decimal: no spaces, no underscores, no digits of other scripts."""

PATTERN = f"^({_NUMBER.pattern})$"


def number(value: Any) -> Fraction:
    """The rational that is written, whether as a number or as text."""
    if isinstance(value, bool) or not isinstance(value, (int, str, Decimal, float, Fraction)):
        raise Invalid(f"expected a number, got {type(value).__name__}")
    if isinstance(value, (int, Fraction)):
        spend(_READ)
        return Fraction(value)
    text = repr(value) if isinstance(value, float) else str(value)
    if len(text) > LONGEST_NUMBER:
        raise Invalid("a number has too many digits")
    if not _NUMBER.fullmatch(text):
        raise Invalid(f"expected a number, got {text[:40]!r}")
    spend(1, 3.4 * len(text), each=_READ / 10)
    return _fraction(text) if "/" in text else _decimal(text)


def _fraction(text: str) -> Fraction:
    top, bottom = (int(Decimal(part)) for part in text.split("/"))  # int() alone stops at 4300 digits
    if bottom == 0:
        raise Invalid(f"expected a number, got {text[:40]!r}")
    return Fraction(top, bottom)


def _decimal(text: str) -> Fraction:
    found = Decimal(text)
    if found and abs(found.adjusted()) > LARGEST_EXPONENT:
        raise Invalid(f"expected a finite number of ordinary size, got {text[:40]}")
    spend(3, 3.4 * abs(found.adjusted()) if found else 0)
    return Fraction(found)


def common_scale(values: Iterable[Fraction], most: int = MOST_BITS_OF_A_LAW) -> int:
    """The smallest whole number that makes all of them whole, of at most so many bits, they of twice that."""
    values, scale = list(values), 1
    for value in values:
        bits = value.denominator.bit_length()
        spend(2, scale.bit_length(), bits)
        if scale % value.denominator:
            spend(bits / 30, scale.bit_length(), 30)
            scale = lcm(scale, value.denominator)
        if scale.bit_length() > most:
            raise Invalid("the numbers have too many digits")
    if any(scale.bit_length() + value.numerator.bit_length() > 2 * most for value in values):
        raise Invalid("a number has too many digits")
    return scale


def about(value: Fraction, digits: int = 6) -> str:
    """A rational to so many digits, for people; also where a double would overflow."""
    return _digits(value, Context(prec=digits, rounding=ROUND_HALF_EVEN))


def down(value: Fraction) -> str:
    """The same rounded down: words of how far a proof reaches say no more than is proved."""
    return _digits(value, Context(prec=6, rounding=ROUND_FLOOR))


def up(value: Fraction) -> str:
    """The same rounded up."""
    return _digits(value, Context(prec=6, rounding=ROUND_CEILING))


def _digits(value: Fraction, context: Context) -> str:
    found = context.divide(Decimal(value.numerator), Decimal(value.denominator)).normalize(context)
    return f"{found:f}" if not found or -6 < found.adjusted() < context.prec + 3 else f"{found:e}".lower()
