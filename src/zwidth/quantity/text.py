"""Numbers as text: rationals digit for digit, and values with their units as people read them."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from decimal import ROUND_CEILING, ROUND_FLOOR, Context, Decimal
from fractions import Fraction
from math import floor, inf, log10
from pathlib import Path

from zwidth.quantity.exact import Exact, Interval
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.spoken import spoken
from zwidth.writing import writing_whole

PREFIXES = {-12: "p", -9: "n", -6: "µ", -3: "m", 0: "", 3: "k", 6: "M", 9: "G"}
"""By the power of ten."""

_AS_IT_IS = {
    "m": (1.0, inf), "s": (1.0, inf), "m/s": (0.1, inf), "J": (1.0, 1e3), "Hz": (0.0, 1e3),
    "N": (0.01, 1e3), "N*m": (0.01, 1e3), "rad": (0.01, inf), "rad/s": (0.01, inf),
    "A": (0.01, 1e3), "V": (0.01, 1e3), "H": (0.01, 1e3), "kg": (0.01, inf), "m/N": (1.0, inf),
}  # fmt: skip
"""From where to where people say a unit without a prefix: 0.12 N and 300 Hz, and 2.3 mm, 12 kHz."""

_FORCES = {"N*m": (0.01, 1e6), "N": (0.001, 1e6)}
"""The same of units that begin so: stiffness and damping of a wheel, and of a handle."""

_FAR = 1e4
"""Numbers of an interval stay below it, where a larger prefix helps."""


def unit_text(unit: str) -> str:
    """A unit as people write it: "N*s/m" as "N·s/m", "m/N/s" as "m/(N·s)", "1" as nothing."""
    above, *below = unit.replace("^2", "²").split("/")
    under = f"({'*'.join(below)})" if len(below) > 1 else "".join(below)
    return "" if unit == "1" else (f"{above}/{under}" if below else above).replace("*", "·")


def quantity_unit(name: str, motion: str = "linear") -> str:
    """The unit of a quantity of the glossary as people write it."""
    return unit_text(GLOSSARY[name].unit_for(motion))


_TURNING = {
    "mass": "inertia", "force": "torque", "forces": "torques", "position": "angle", "positions": "angles",
}  # fmt: skip


def in_words(key: str, motion: str = "linear") -> str:
    """A key as words, in which Coulomb is a name; the "force_limit" of what turns is a "torque limit"."""
    words = key.replace("_", " ").replace("coulomb", "Coulomb").split(" ")
    return " ".join(_TURNING.get(word, word) if motion == "rotary" else word for word in words)


def shown(value: float | Fraction | Exact | Interval | None, unit: str, digits: int = 4) -> str:
    """A value with its unit, to `digits` significant digits, as people say it: 22.4e-6 m is "22.4 µm".

    The one place where a number and its unit become text: an angle is in the unit that was typed, and where
    people prefix a unit 1 to 999 stand before the point.
    """
    if value is None:
        return "none"
    if isinstance(value, Interval):
        return _between(value, unit, digits)
    number = float(value)
    if abs(number) == inf:
        return "any" if number > 0 else "none"
    factor, unit = spoken(unit)
    number *= factor
    power, name = prefixed(number, unit, digits)
    return f"{_rounded(number / 10.0**power, digits)} {name}".rstrip()


def told_quantity(value: float | Fraction | Exact | Interval, name: str, motion: str, digits: int = 6) -> str:
    """The same with the unit of a quantity of the glossary: "0.4 N·m/deg"."""
    return shown(value, GLOSSARY[name].unit_for(motion), digits)


def from_to(low: float, high: float, unit: str, digits: int = 4) -> str:
    """A range as it is said: "-50 to 50 mm"."""
    return shown(Interval(low, high), unit, digits).replace("…", "to")


def _between(value: Interval, unit: str, digits: int) -> str:
    """Both ends with one prefix: that of the smaller one, or a larger that keeps the other short."""
    factor, unit = spoken(unit)
    ends = (float(value.low) * factor, float(value.high) * factor)
    small, large = sorted(abs(end) for end in ends)
    least = small or large
    power, name = prefixed(least, unit, digits)
    while least < large >= _FAR * 10.0**power:
        least *= 10
        power, name = prefixed(least, unit, digits)
    return f"{' … '.join(_rounded(end / 10.0**power, digits) for end in ends)} {name}".rstrip()


def prefixed(number: float, unit: str, digits: int) -> tuple[int, str]:
    """The power of ten of a prefix, and the unit with it."""
    size, name = float(f"{abs(number):.{digits}g}"), unit_text(unit)
    plain = unit.replace("·", "*")
    begins = (bounds for begin, bounds in _FORCES.items() if plain.startswith(begin))
    least, most = _AS_IT_IS.get(plain) or next(begins, (0.0, inf))
    power = 3 * floor(floor(log10(size)) / 3) if size > 0 and not least <= size < most else 0
    if name == "kg" and power:
        return power, f"{PREFIXES.get(power + 3, '')}g"
    return (power, f"{PREFIXES[power]}{name}") if power in PREFIXES else (0, name)


def _rounded(number: float, digits: int) -> str:
    """So many significant digits; 490, and not 4.9e+02."""
    text = f"{number:.{digits}g}"
    return f"{float(text):.0f}" if "e+" in text and abs(number) < 1e6 else text


def outward_decimal(value: float, more: bool, digits: int = 4) -> float:
    """So many significant digits, never less with `more` and never more without; noise of doubles aside."""
    told = Decimal(f"{value:.15g}")
    if not told.is_finite() or told == 0:
        return value
    step = Decimal((0, (1,), told.adjusted() - digits + 1))
    return float(told.quantize(step, ROUND_CEILING if more else ROUND_FLOOR))


def at_most(value: float | None, unit: str, digits: int = 6) -> float | None:
    """The same of a value up to which something holds, in the unit in which it is told."""
    factor = spoken(unit)[0]
    return None if value is None else outward_decimal(value * factor, False, digits) / factor


def at_least(value: float | None, unit: str, digits: int = 6) -> float | None:
    """Of a value from which on something holds."""
    factor = spoken(unit)[0]
    return None if value is None else outward_decimal(value * factor, True, digits) / factor


def shown_at_most(value: float | None, unit: str, digits: int = 4) -> str:
    """`shown` of a value up to which something holds, never rounded up."""
    return shown(at_most(value, unit, digits), unit, digits)


def shown_at_least(value: float | None, unit: str, digits: int = 4) -> str:
    """`shown` of a value from which on something holds, never rounded down."""
    return shown(at_least(value, unit, digits), unit, digits)


def in_a_table(value: float, digits: int = 4) -> str:
    """A number without its unit; a whole one where there are more digits before the point."""
    return f"{value:.0f}" if 1000 <= abs(value) < 1e6 else f"{value:.{digits}g}"


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


def save_json(path: str | Path, document: object) -> None:
    """Write a document whole, or not at all."""
    with writing_whole(Path(path)) as file:
        file.write(json_file(document))


def json_file(document: object) -> bytes:
    """A document as `save_json` writes it."""
    return f"{to_json(document)}\n".encode()


def to_json(document: object, indent: int | None = 2) -> str:
    """JSON text in which a Fraction is written digit for digit.

    A rational that is no finite decimal becomes the text "p/q".
    """
    return _text(document, indent, 0)


def _text(value: object, indent: int | None, level: int) -> str:
    if isinstance(value, Fraction):
        decimal = as_decimal(value)
        return json.dumps(f"{value.numerator}/{value.denominator}") if decimal is None else _plain(decimal)
    if isinstance(value, Mapping):
        items = [f"{json.dumps(str(k))}: {_text(v, indent, level + 1)}" for k, v in value.items()]
        return _bracket("{", items, "}", indent, level)
    if isinstance(value, Sequence) and not isinstance(value, str):
        scalar = not any(isinstance(v, (Mapping, list, tuple)) for v in value)
        items = [_text(v, indent, level + 1) for v in value]
        return f"[{', '.join(items)}]" if scalar else _bracket("[", items, "]", indent, level)
    if isinstance(value, float):
        return json.dumps(value if abs(value) < float("inf") else None)
    return json.dumps(value, ensure_ascii=False)


def _bracket(opening: str, items: list[str], closing: str, indent: int | None, level: int) -> str:
    if indent is None or not items:
        return opening + ", ".join(items) + closing
    pad = "\n" + " " * indent * (level + 1)
    return opening + pad + ("," + pad).join(items) + "\n" + " " * indent * level + closing


def _plain(decimal: Decimal) -> str:
    """Decimal text that JSON accepts, without exponent padding surprises."""
    if decimal == 0:
        return "0"
    exact = Context(prec=len(decimal.as_tuple().digits))  # the usual one would round to 28 digits
    text = str(decimal.normalize(exact) if decimal.adjusted() < 25 else decimal)
    return text.replace("E+", "e").replace("E", "e")
