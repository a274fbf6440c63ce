"""Values with units: "22.4 um" means 224/10⁷ m, exactly.

A value is a number and a product of units, each an SI unit with a prefix:

    "1 kHz"   "22.4 µm"   "0.15 N*s/m"   "0.15 N s/m"   "10 mN·m"   "0.9 Nm/A"   "500 g"   "1/3000 s"

read from left to right, so N*s/m is (N·s)/m.  A number without a unit is SI.
The arithmetic is rational: the typed decimal times the exact scale.  Only
degrees and turns bring in π; their result is rounded to the nearest double.

Dimensions are exponents of kg, m, s, A and rad.  The radian is kept, so that
a rate of "60 rad/s" is refused instead of being read as 60 Hz; but where a
quantity is per radian the radian may be left out, as in N*m*s for N*m*s/rad.
"""

from __future__ import annotations

import re
from decimal import Decimal
from difflib import get_close_matches
from fractions import Fraction
from functools import lru_cache
from numbers import Real
from typing import NamedTuple

from zwidth.errors import InputError
from zwidth.quantity.exact import Exact, Interval
from zwidth.quantity.spoken import note
from zwidth.showing import one_line

LONGEST_TEXT = 120
"""A value longer than this is a mistake, whatever it says."""

_NUMBER = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?")
_SPELLING = str.maketrans(
    {"µ": "u", "μ": "u", "·": "*", "⋅": "*", "×": "*", "−": "-", "°": "deg", "…": "..", "²": "^2", "³": "^3"}
)


def parse(value: object, unit: str, what: str) -> Exact | Interval:
    """Read a number (SI), a text such as "22.4 um" or "0.1 .. 0.2 N", or a list or tuple of two of them.

    The result is in `unit`, such as "N*s/m"; `what` is the quantity's name, for the messages.
    """
    if isinstance(value, Interval):
        return value
    if isinstance(value, (list, tuple)):
        if len(value) != 2:
            raise InputError(f"{what}: an interval has two ends, got {len(value)} values")
        return _interval(parse_number(value[0], unit, what), parse_number(value[1], unit, what), what)
    if isinstance(value, str) and ".." in value.translate(_SPELLING):
        return _interval(*_text_ends(value, unit, what), what)
    return parse_number(value, unit, what)


def parse_number(value: object, unit: str, what: str) -> Exact:
    """Read one number or text, in `unit`; an interval is refused."""
    if isinstance(value, str):
        return _parse_text(value, unit, what)
    if isinstance(value, bool) or not isinstance(value, (Real, Decimal)):
        raise InputError(f"{_is(what, unit)}; got {_type_name(value)} where a number belongs")
    if _digits(value) > LONGEST_TEXT:
        raise InputError(f"{_is(what, unit)}; got a number of more than {LONGEST_TEXT} digits")
    try:
        return Exact(value)  # type: ignore[arg-type]  # every Real is read as its shortest decimal
    except InputError as error:
        raise InputError(f"{_is(what, unit)}: {error}") from None


def in_si(value: object, unit: str, what: str) -> float:
    """The same as a double."""
    return float(parse_number(value, unit, what))


def _parse_text(value: str, unit: str, what: str) -> Exact:
    number, rest = _split(value, unit, what)
    try:
        fraction = Exact(number).fraction
        # "counts" or "steps" may stand where these are counted
        counted = unit == "1" and "count" in what and _COUNTED.fullmatch(rest)
        such_as = "N*s/m" if unit in ("", "1") else unit
        given, wanted = unit_of("" if counted else rest, such_as), unit_of(unit)
        if not any(map(str.isalpha, rest)):  # SI like a number; perhaps a ratio, such as 1/3000
            return Exact(fraction * given.scale)
        if not compatible(given, wanted):
            raise InputError(f'{_is(what, unit)}; got "{_short(value)}", {_kind(rest, given, wanted)}')
        read = _scaled(fraction * given.scale / wanted.scale, given.turns - wanted.turns)
    except InputError as error:
        if str(error).startswith(what):
            raise
        raise InputError(f'{_is(what, unit)}; got "{_short(value)}": {error}') from None
    if wanted.dimension[4]:  # of an angle, or per angle; counts per turn are a plain number
        note(rest, int(wanted.dimension == (1, 2, -2, 0, -1)))  # a stiffness says what the others are told in
    return read


_COUNTED = re.compile(r"(?:counts?|steps?|cpr|1)?\s*(?:(?:/|per )\s*(?:turn|rev))?")


def _kind(rest: str, given: Unit, wanted: Unit) -> str:
    """What was given, and for nanometres in the place of a torque, or a weight, what to write."""
    if rest in ("g", "kg") and wanted.dimension == unit_of("N").dimension:
        return f"{kind_of(given)}; its weight is in {rest}f"
    torque = unit_of("N*m").dimension
    slip = rest.startswith(("nm", "mnm")) and wanted.dimension[:2] == torque[:2]
    return kind_of(given) + ("; nm is a nanometre, a newton metre is Nm" if slip else "")


def _scaled(fraction: Fraction, turns: int) -> Exact:
    if turns == 0:
        return Exact(fraction)
    # Validated before it becomes a float, which could overflow.
    return Exact(float(Exact(fraction * PI**turns).fraction))


def _split(value: str, unit: str, what: str) -> tuple[str, str]:
    """The number and the unit of one value, both in plain ASCII spelling."""
    text = " ".join(value.translate(_SPELLING).split())
    if not text:
        raise InputError(f"{_is(what, unit)}; got an empty text")
    match = _NUMBER.match(text) if len(text) <= LONGEST_TEXT and text.isprintable() else None
    if match is None or text[match.end() :].startswith(","):
        problem = _without_comma(text, unit) or f": expected a number, such as {_example(unit)}"
        if text.lstrip("+-").lower().startswith(("nan", "inf")):
            problem = ": it must be finite"
        raise InputError(f'{_is(what, unit)}; got "{_short(value)}"{problem}')
    return match[0], text[match.end() :].strip()


_THOUSANDS = re.compile(r"[+-]?[1-9][0-9]{0,2}(?:,[0-9]{3})+(?![0-9,])")
_WITH_COMMA = re.compile(r"[+-]?[0-9]+,[0-9]+(?![0-9.,])")


def _without_comma(text: str, unit: str) -> str:
    """What to write in the place of a number with a comma; "" where there is none.

    Before three digits it may part thousands: 65,536 is never said to be 65.536.
    """
    if "," not in text:
        return ""
    if len(text) > LONGEST_TEXT:
        return f"; write a fraction with a point, such as {_example(unit)}"
    if parted := _THOUSANDS.match(text):
        plain = parted[0].replace(",", "") + text[parted.end() :]
        return f'; write "{plain}", without a comma; a fraction has a point'
    pointed = text.replace(",", ".", 1)
    right = f'"{pointed}"' if _WITH_COMMA.match(text) else _example(unit)
    return f"; write {right}, with a point"


def _example(unit: str) -> str:
    return '"0.15"' if unit in ("", "1") else f'"0.15 {unit}"'


def _text_ends(value: str, unit: str, what: str) -> tuple[Exact, Exact]:
    parts = value.translate(_SPELLING).split("..")
    if len(parts) != 2 or len(value) > 2 * LONGEST_TEXT or "..." in value:
        raise InputError(
            f'{_is(what, unit)}; got "{_short(value)}": an interval is two numbers, such as "0.1 .. 0.2"'
        )
    (_, first_unit), (_, second_unit) = (_split(part, unit, what) for part in parts)
    if first_unit and not second_unit:
        raise InputError(
            f'{what}: in "{_short(value)}" the unit belongs after the second number, or after both'
        )
    low = parts[0] if first_unit else f"{parts[0]} {second_unit}"
    return _parse_text(low, unit, what), _parse_text(parts[1], unit, what)


def _interval(low: Exact, high: Exact, what: str) -> Interval:
    try:
        return Interval(low, high)
    except InputError as error:
        raise InputError(f"{what}: {error}") from None


def _is(what: str, unit: str) -> str:
    return f"{what} is a plain number" if unit in ("", "1") else f"{what} is in {unit}"


def _short(text: str) -> str:
    return one_line(text, 40)


def _digits(value: object) -> int:
    if isinstance(value, int):
        return value.bit_length() * 3 // 10
    return len(value.as_tuple().digits) if isinstance(value, Decimal) else 0


def _type_name(value: object) -> str:
    names = {bool: "true or false", dict: "a table", list: "a list", tuple: "a list", type(None): "nothing"}
    return names.get(type(value), f"a value of type {type(value).__name__}")


Dimension = tuple[int, int, int, int, int]


class Unit(NamedTuple):
    """scale · π^turns in SI, and the exponents of kg, m, s, A, rad."""

    scale: Fraction
    turns: int
    dimension: Dimension


PI = Fraction("3.1415926535897932384626433832795028841972")
ONE = Unit(Fraction(1), 0, (0, 0, 0, 0, 0))
_PREFIXES = {
    "n": Fraction(1, 10**9),
    "u": Fraction(1, 10**6),
    "m": Fraction(1, 1000),
    "c": Fraction(1, 100),
    "k": Fraction(1000),
    "M": Fraction(10**6),
}
_PREFIXED = {
    "g": Unit(Fraction(1, 1000), 0, (1, 0, 0, 0, 0)),
    "m": Unit(Fraction(1), 0, (0, 1, 0, 0, 0)),
    "s": Unit(Fraction(1), 0, (0, 0, 1, 0, 0)),
    "A": Unit(Fraction(1), 0, (0, 0, 0, 1, 0)),
    "rad": Unit(Fraction(1), 0, (0, 0, 0, 0, 1)),
    "Hz": Unit(Fraction(1), 0, (0, 0, -1, 0, 0)),
    "N": Unit(Fraction(1), 0, (1, 1, -2, 0, 0)),
    "J": Unit(Fraction(1), 0, (1, 2, -2, 0, 0)),
    "V": Unit(Fraction(1), 0, (1, 2, -3, -1, 0)),
    "H": Unit(Fraction(1), 0, (1, 2, -2, -2, 0)),
}
WEIGHT = Fraction("9.80665")
"""Of a kilogram [N], by definition (3rd CGPM, 1901)."""

POUND = WEIGHT * Fraction("0.45359237")
"""Of force [N]."""

_FORCES = {"gf": WEIGHT / 1000, "pond": WEIGHT / 1000, "kgf": WEIGHT, "kp": WEIGHT, "lbf": POUND}
_UNITS = {
    **{
        p + name: Unit(f * u.scale, 0, u.dimension)
        for p, f in _PREFIXES.items()
        for name, u in _PREFIXED.items()
    },
    **_PREFIXED,
    **{name: Unit(scale, 0, (1, 1, -2, 0, 0)) for name, scale in _FORCES.items()},
    "min": Unit(Fraction(60), 0, (0, 0, 1, 0, 0)),
    "deg": Unit(Fraction(1, 180), 1, (0, 0, 0, 0, 1)),
    "turn": Unit(Fraction(2), 1, (0, 0, 0, 0, 1)),
    "rev": Unit(Fraction(2), 1, (0, 0, 0, 0, 1)),
    "rpm": Unit(Fraction(1, 30), 1, (0, 0, -1, 0, 1)),
}
_JOINED = {
    **{f"{force}N{way}": (f"{force}N", way) for force in ("", "u", "m", "k") for way in ("m", "mm", "cm")},
    **{f"{force}N{rest}": (f"{force}N", *rest) for force in ("", "u", "m", "k") for rest in ("s", "ms")},
    **{f"{mass}{way}": (mass, way) for mass in ("kg", "g") for way in ("m", "mm", "cm")},
    **{f"{first}s": (first, "s") for first in ("V", "mV", "J", "mJ")},
}
"""Products that data sheets write as one word, each with the one meaning that it has there."""

_KINDS: dict[Dimension, str] = {
    (0, 0, 0, 0, 0): "a plain number",
    (1, 0, 0, 0, 0): "a mass (kg)",
    (0, 1, 0, 0, 0): "a length (m)",
    (0, 0, 1, 0, 0): "a time (s)",
    (0, 0, -1, 0, 0): "a frequency (1/s)",
    (0, 0, 0, 0, 1): "an angle (rad)",
    (0, 0, -1, 0, 1): "an angular speed (rad/s)",
    (0, 1, -1, 0, 0): "a speed (m/s)",
    (0, -1, 1, 0, 0): "a dissipation (s/m)",
    (0, 0, 1, 0, -1): "a rotary dissipation (s/rad)",
    (1, 1, -2, 0, 0): "a force (N)",
    (1, 0, -2, 0, 0): "a stiffness (N/m)",
    (1, 0, -1, 0, 0): "a damping (N*s/m)",
    (1, 2, -2, 0, 0): "a torque or an energy (N*m)",
    (1, 2, -2, 0, -1): "a rotary stiffness (N*m/rad)",
    (1, 2, -1, 0, 0): "a rotary damping (N*m*s)",
    (1, 2, -1, 0, -1): "a rotary damping (N*m*s/rad)",
    (1, 2, 0, 0, 0): "a moment of inertia (kg*m^2)",
    (0, 0, 0, 1, 0): "a current (A)",
    (1, 2, -3, -1, 0): "a voltage (V)",
    (1, 2, -2, -2, 0): "an inductance (H)",
}

_FACTOR = re.compile(
    r"\s*([*/]?)\s*(?:([A-Za-z]+)(?:(?:\^|\*\*)([+-]?[0-9])|([23]))?|([0-9]{1,15}))(?![0-9])"
)


@lru_cache(maxsize=256)
def unit_of(text: str, example: str = "N*s/m") -> Unit:
    """The unit that a text such as "N*s/m" spells; "" and "1" are the plain number.

    Parameters
    ----------
    text
        The unit as it was typed.
    example
        A unit that would do, for the message.
    """
    total, position = ONE, 0
    while position < len(text):
        factor = _FACTOR.match(text, position)
        if factor is None or (position == 0 and factor[1] == "*"):
            raise InputError(f'"{text}" is not a product of units such as {example}')
        for unit, power in _factors(factor, text):
            total = _times(total, unit, power)
        position = factor.end()
    return total


def _factors(match: re.Match[str], text: str) -> list[tuple[Unit, int]]:
    """One factor, or those of a joined word, of which the last has the exponent: kgm^2 is kg*m^2."""
    operator, name, exponent, raised, number = match.groups()
    sign = -1 if operator == "/" else 1
    if number is not None:
        # "1/3000 s" and "60 1/min" are values; "1 2 N" is a slip.
        if int(number) == 0 or (sign > 0 and number != "1"):
            raise InputError(f'the number {number} stands inside the unit "{text}"')
        return [(Unit(Fraction(int(number)), 0, ONE.dimension), sign)]
    name = WORDS.get(name, name)
    if name not in _UNITS and name not in _JOINED:
        raise InputError(f'"{name}" is not a known unit{_suggestion(name)}')
    *before, last = (name,) if name in _UNITS else _JOINED[name]
    power = int(exponent or raised or 1)
    return [*((_UNITS[one], sign) for one in before), (_UNITS[last], sign * power)]


def _times(a: Unit, b: Unit, power: int) -> Unit:
    k, m, s, i, r = (x + power * y for x, y in zip(a.dimension, b.dimension, strict=True))
    return Unit(a.scale * b.scale**power, a.turns + power * b.turns, (k, m, s, i, r))


def _suggestion(name: str) -> str:
    if name in ("counts", "count", "cpr", "ppr", "lines"):
        return "; counts in a turn are given as counts_per_turn"
    every = [*_JOINED, *_UNITS]
    same = [known for known in every if known.lower() == name.lower()]
    near = same or get_close_matches(name, every, n=1, cutoff=0.75)
    return f'; did you mean "{near[0]}"?' if near else ""


def compatible(given: Unit, wanted: Unit) -> bool:
    """True when `given` may stand for `wanted`; "per radian" may be left out."""
    if given.dimension == wanted.dimension:
        return True
    # Only below the bar: an angle without its radian would leave nothing to check.
    return wanted.dimension[4] < 0 and given.dimension == (*wanted.dimension[:4], 0)


def kind_of(unit: Unit) -> str:
    """What a unit measures, in words: "a frequency (1/s)"."""
    if unit.dimension in _KINDS:
        return _KINDS[unit.dimension]
    names = zip(("kg", "m", "s", "A", "rad"), unit.dimension, strict=True)
    return "in " + "*".join(n if e == 1 else f"{n}^{e}" for n, e in names if e)


WORDS = {
    **dict.fromkeys(("sec", "secs", "second", "seconds"), "s"),
    **dict.fromkeys(("msec", "milliseconds", "millisecond"), "ms"),
    **dict.fromkeys(("usec", "microseconds", "microsecond"), "us"),
    **dict.fromkeys(("nsec", "nanoseconds", "nanosecond"), "ns"),
    **dict.fromkeys(("degree", "degrees"), "deg"),
    **dict.fromkeys(("radian", "radians"), "rad"),
    **dict.fromkeys(("meter", "meters", "metre", "metres"), "m"),
    **dict.fromkeys(("newton", "newtons"), "N"),
    **dict.fromkeys(("volt", "volts"), "V"),
    **dict.fromkeys(("ampere", "amperes", "amp", "amps"), "A"),
    **dict.fromkeys(("turns", "revs"), "turn"),
}
"""Units written out, wherever a value is read."""

_ALIASES = {
    **WORDS,
    "n": "N",
    **dict.fromkeys(("N_m", "Nm", "N.m", "N m", "N-m"), "N*m"),
    **dict.fromkeys(("mNm", "mN_m", "mN.m", "mN m"), "mN*m"),
    **dict.fromkeys(("Nmm", "N_mm", "N.mm", "N mm"), "N*mm"),
}
"""And those of the headers of recordings."""

_SIGNS = str.maketrans({"µ": "u", "μ": "u", "·": "*", "⋅": "*", "°": "deg"})


def plain(text: str) -> str:
    """The same text with signs that `unit_of` reads."""
    return text.translate(_SIGNS)


def spelled(text: str) -> str:
    """A unit as `unit_of` reads it, where it is one: "Nm" is "N*m"."""
    bare = plain(text).strip()
    return _ALIASES.get(bare) or WORDS.get(bare.lower(), bare)
