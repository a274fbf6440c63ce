"""Numbers of a document, exact: whole, decimal or a fraction, in plain digits, of ordinary size; units."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from decimal import ROUND_CEILING, ROUND_FLOOR, ROUND_HALF_EVEN, Context, Decimal
from fractions import Fraction
from itertools import pairwise
from math import lcm
from typing import Any, NamedTuple

from .refusal import Invalid, spend

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


def increasing(told: Sequence[Sequence[Fraction]], what: str) -> list[tuple[Fraction, Fraction]]:
    """Pairs whose first numbers increase."""
    found = [(a, b) for a, b in told]
    if any(before[0] >= after[0] for before, after in pairwise(found)):
        raise Invalid(f"{what} must increase")
    return found


def exactly(value: Fraction) -> str:
    """As a decimal where one ends soon, else as it is written."""
    if max(value.denominator, abs(value.numerator)).bit_length() <= 200:
        rest = value.denominator
        for prime in (2, 5):
            while rest % prime == 0:
                rest //= prime
        if rest == 1:
            return about(value, 200)
    short = value.numerator.bit_length() + value.denominator.bit_length() <= 128
    return str(value) if short else f"about {about(value, 12)}"


# Units that the keys of a document end in, of a device that slides and of one that turns.


class Unit(NamedTuple):
    """Of a linear device, and of a rotary one."""

    linear: str
    rotary: str

    def of(self, motion: str) -> str:
        """The ending of a key."""
        return self.rotary if motion == "rotary" else self.linear


def always(unit: str) -> Unit:
    """The same for both."""
    return Unit(unit, unit)


_SEVERAL = {
    "m_N": "m, N",
    "rad_N_m": "rad, N·m",
    "m_per_s_N": "m/s, N",
    "rad_per_s_N_m": "rad/s, N·m",
    "N_N_s_per_m": "N, N·s/m",
    "N_m_N_m_s_per_rad": "N·m, N·m·s/rad",
    "N_m_rad": "in N, m, rad",
    "N_m_s_rad": "in N, m, s, rad",
}
"""Keys of pairs, and of matrices that hold forces and moments."""


def in_words(ending: str) -> str:
    """The ending of a key as people write a unit: "N_s_per_m" is N·s/m."""
    plain = ending.replace("_per_", "/").replace("_", "·").replace("2", "²")
    return _SEVERAL.get(ending, plain)


NONE = always("")
SECONDS = always("s")
JOULES = always("J")
HERTZ = always("Hz")
FORCE = Unit("N", "N_m")
LENGTH = Unit("m", "rad")
SPEED = Unit("m_per_s", "rad_per_s")
MASS = Unit("kg", "kg_m2")
DAMPING = Unit("N_s_per_m", "N_m_s_per_rad")
STIFFNESS = Unit("N_per_m", "N_m_per_rad")
FORCE_AT = Unit("m_N", "rad_N_m")
FORCE_AT_SPEED = Unit("m_per_s_N", "rad_per_s_N_m")
FRICTION_MODEL = Unit("N_N_s_per_m", "N_m_N_m_s_per_rad")
PER_LENGTH = Unit("m", "rad")
