"""Reading a certificate or a witness: plain JSON data into exact numbers, every size bounded."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from decimal import Decimal
from fractions import Fraction
from math import lcm
from typing import Any, NamedTuple

from .effort import spend
from .refusal import Invalid

__all__ = [
    "Invalid",
    "Loop",
    "common_scale",
    "get",
    "in_its_unit",
    "integer",
    "number",
    "numbers",
    "quantity",
    "read_loop",
    "the_one",
]

MOST_COEFFICIENTS = 2000
MOST_SAMPLES = 4_000_000
LONGEST_NUMBER = 20_000
MOST_BITS = 400_000
MOST_BITS_OF_A_LAW = 20_000


def get(document: Mapping[str, Any], key: str) -> Any:
    if not isinstance(document, Mapping) or key not in document:
        raise Invalid(f"{key} is missing")
    return document[key]


_DAMPING, _STIFFNESS = ("N_s_per_m", "N_m_s_per_rad"), ("N_per_m", "N_m_per_rad")
_FORCE, _LENGTH = ("N", "N_m"), ("m", "rad")
_UNITS: dict[str, tuple[str, ...]] = {
    "mass": ("kg", "kg_m2"),
    "damping": _DAMPING,
    "virtual_damping": _DAMPING,
    "activity": _DAMPING,
    "stiffness": _STIFFNESS,
    "taps": _STIFFNESS,
    "coulomb_friction": _FORCE,
    "force_limit": _FORCE,
    "force_step": _FORCE,
    "force_resolution": _FORCE,
    "resolution": _LENGTH,
    "sample_period": ("s",),
    "delay": ("s",),
    "points": ("m_N", "rad_N_m"),
    "rate_per": _LENGTH,
    "friction_curve": ("m_per_s_N", "rad_per_s_N_m"),
    "friction_models": ("N_N_s_per_m", "N_m_N_m_s_per_rad"),
    "credit": _STIFFNESS,
    "friction": _FORCE,
    "count": _LENGTH,
    "half_step": _FORCE,
    "hair": (),
    "roundoff": (),
}


def in_its_unit(key: str, name: str) -> str:
    """A key of a quantity, once its ending is the unit that the number is taken for, or nothing."""
    units = _UNITS[name.removeprefix("hand_")]
    if key != name and key.removeprefix(f"{name}_") not in units:
        raise Invalid(f"the unit of {name} must be {' or '.join(units) or 'left out'}: {key[:60]}")
    return key


_REQUIRED = object()


def the_one(table: Any, name: str, default: Any = _REQUIRED) -> Any:
    """What stands under a name and its unit, which must be there once, or once at most with a default."""
    if not isinstance(table, Mapping) or not all(isinstance(key, str) for key in table):
        raise Invalid("loop and law must be objects")
    of_others = tuple(f"{other}_" for other in _UNITS if other.startswith(f"{name}_"))
    keys = [k for k in table if k == name or (k.startswith(f"{name}_") and not k.startswith(of_others))]
    if len(keys) > 1 or (not keys and default is _REQUIRED):
        raise Invalid(f"{name} must be given once")
    return table[in_its_unit(keys[0], name)] if keys else default


def quantity(table: Any, name: str) -> Fraction:
    """A number by its name, its unit in the key."""
    return number(the_one(table, name))


def with_no_more_than(table: Mapping[str, Any], count: int) -> None:
    """As many entries as were read: what nobody reads would be taken for a part of what is proved."""
    if len(table) != count:
        raise Invalid(f"{len(table)} entries where {count} are read: {', '.join(map(str, table))[:200]}")


_NUMBER = re.compile(r"[+-]?[0-9]+/[0-9]+|[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?[0-9]+)?")
"""A fraction or a decimal in plain digits: no spaces, no underscores, no digits of other scripts."""


def number(value: Any) -> Fraction:
    if isinstance(value, bool) or not isinstance(value, (int, str, Decimal, float, Fraction)):
        raise Invalid(f"expected a number, got {type(value).__name__}")
    if isinstance(value, (int, Fraction)):
        return Fraction(value)
    text = repr(value) if isinstance(value, float) else str(value)
    if len(text) > LONGEST_NUMBER:
        raise Invalid("a number has too many digits")
    if not _NUMBER.fullmatch(text):
        raise Invalid(f"expected a number, got {text[:40]!r}")
    top, _, bottom = text.partition("/")
    if bottom:
        if int(bottom) == 0:
            raise Invalid(f"expected a number, got {text[:40]!r}")
        return Fraction(int(top), int(bottom))
    decimal = Decimal(text)
    if decimal and abs(decimal.adjusted()) > 5000:
        raise Invalid(f"expected a finite number of ordinary size, got {text[:40]}")
    return Fraction(decimal)


def integer(value: Any, least: int = 0) -> int:
    found = number(value)
    if found.denominator != 1 or found < least:
        raise Invalid(f"expected a whole number of at least {least}, got {found}")
    return int(found)


def numbers(values: Any, most: int = MOST_COEFFICIENTS) -> list[Fraction]:
    if not isinstance(values, Sequence) or isinstance(values, (str, bytes)):
        raise Invalid("expected a list of numbers")
    if len(values) > most:
        raise Invalid(f"a list has {len(values)} entries, more than {most}")
    return [number(v) for v in values]


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


class Loop(NamedTuple):
    numerator: list[Fraction]  # N, D in ascending powers of 1/z
    denominator: list[Fraction]
    damping: Fraction
    coulomb_friction: Fraction
    resolution: Fraction
    period: Fraction
    whole: int
    part: Fraction
    unilateral: bool


def read_loop(document: Mapping[str, Any]) -> Loop:
    loop = get(document, "loop")
    if not isinstance(loop, Mapping) or not all(isinstance(key, str) for key in loop):
        raise Invalid("the loop must be an object")

    names = ("damping", "coulomb_friction", "resolution", "sample_period", "delay")
    b, friction, resolution, period, delay = (quantity(loop, name) for name in names)
    if period <= 0 or min(b, friction, resolution, delay) < 0:
        raise Invalid("T must be > 0 and b, f_c, Δ and the delay ≥ 0")
    numerator, denominator = numbers(get(loop, "numerator")), numbers(get(loop, "denominator"))
    numerator = [Fraction(0)] * (len(denominator) - len(numerator)) + numerator
    if not denominator or denominator[0] == 0 or len(numerator) != len(denominator):
        raise Invalid("H(z) must be proper, with a denominator that does not begin with 0")
    common_scale((*numerator, *denominator))
    whole = delay // period
    if whole > MOST_COEFFICIENTS:
        raise Invalid(f"the delay is {float(whole):g} samples, more than {MOST_COEFFICIENTS}")
    unilateral = get(loop, "unilateral")
    with_no_more_than(loop, 8)
    if not isinstance(unilateral, bool):
        raise Invalid("unilateral must be true or false")
    return Loop(
        numerator,
        denominator,
        b,
        friction,
        resolution,
        period,
        int(whole),
        delay / period - whole,
        unilateral,
    )
