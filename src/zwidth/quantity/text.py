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

_PREFIXED = ("m", "s", "J", "N", "Hz", "m/s")
"""Units that people prefix in text; N·s/m stays as it is, and 300 N/m too."""

_READABLE = (*_PREFIXED, "rad", "N*m", "N·m", "rad/s")
"""Those that `readable` prefixes."""

_FAR = 1e4
"""How many times the smaller end of an interval the larger is, for both to have the prefix of the smaller."""

_NO_EXPONENT = ("N*m", "N·m", "rad")
"""How units begin that have a prefix in the place of an exponent: those of torques, and radians."""


def unit_text(unit: str) -> str:
    """A unit as people write it: "N*s/m" as "N·s/m", "m/N/s" as "m/(N·s)", "1" as nothing."""
    above, *below = unit.replace("^2", "²").split("/")
    under = f"({'*'.join(below)})" if len(below) > 1 else "".join(below)
    return "" if unit == "1" else (f"{above}/{under}" if below else above).replace("*", "·")


def quantity_unit(name: str, motion: str = "linear") -> str:
    """The unit of a quantity of the glossary as people write it."""
    return unit_text(GLOSSARY[name].unit_for(motion))


def in_words(key: str) -> str:
    """A key as words, in which Coulomb is a name."""
    return key.replace("_", " ").replace("coulomb", "Coulomb")


def shown(value: float | Exact | Interval | None, unit: str, digits: int = 4) -> str:
    """A value with its unit, to `digits` significant digits: 22.4e-6 m is "22.4 µm"."""
    if value is None:
        return "none"
    if isinstance(value, Interval):
        return _between(value, unit, digits)
    number = float(value)
    if abs(number) == inf:
        return "any" if number > 0 else "none"
    factor, unit = spoken(unit)
    number *= factor
    power, name = _prefix(number, unit, digits)
    return f"{_rounded(number / 10.0**power, digits)} {name}".rstrip()


def _between(value: Interval, unit: str, digits: int) -> str:
    """Both ends with one prefix: that of the smaller one, unless it is 0 or far below the other."""
    factor, unit = spoken(unit)
    ends = (float(value.low) * factor, float(value.high) * factor)
    small, large = sorted(abs(end) for end in ends)
    least = small if small and large < _FAR * small else large
    power, name = _prefix(least, unit, digits)
    return f"{' … '.join(f'{end / 10.0**power:.{digits}g}' for end in ends)} {name}".rstrip()


def _prefix(number: float, unit: str, digits: int) -> tuple[int, str]:
    if number == 0:
        return 0, unit_text(unit)
    if unit not in _PREFIXED:
        return _instead_of_exponent(number, unit, digits)
    rounded = float(f"{abs(number):.{digits}g}")
    power = 3 * floor(floor(log10(rounded)) / 3)
    if (unit == "m" and power > 0) or (unit == "N" and 0.01 <= rounded < 1000) or not -9 <= power <= 9:
        return 0, unit  # nobody says kilometres here, nor 120 mN for 0.12 N
    return power, PREFIXES[power] + unit


def _instead_of_exponent(number: float, unit: str, digits: int) -> tuple[int, str]:
    """77.2 µN·m·s/deg for what would be 7.72e-05."""
    power = 3 * floor(log10(abs(number)) / 3)
    if "e-" not in f"{number:.{digits}g}" or not unit.startswith(_NO_EXPONENT) or power not in PREFIXES:
        return 0, unit_text(unit)
    return power, PREFIXES[power] + unit_text(unit)


def told(value: float | Exact | Interval, unit: str, digits: int = 6) -> str:
    """A value to `digits` significant digits in this unit, an angle in the unit that was typed."""
    factor, unit = spoken(unit)
    if isinstance(value, Interval):
        ends = f"{float(value.low) * factor:g} … {float(value.high) * factor:g}"
        return f"{ends} {unit_text(unit)}".rstrip()
    number = float(value) * factor
    power, name = _instead_of_exponent(number, unit, digits) if number else (0, unit_text(unit))
    return f"{_rounded(number / 10.0**power, digits)} {name}".rstrip()


def _rounded(number: float, digits: int) -> str:
    """So many significant digits; 490, and not 4.9e+02."""
    text = f"{number:.{digits}g}"
    return f"{float(text):.0f}" if "e+" in text and abs(number) < 1e6 else text


def told_quantity(value: float | Exact | Interval, name: str, motion: str, digits: int = 6) -> str:
    """The same with the unit of a quantity of the glossary: "0.4 N·m/deg"."""
    return told(value, GLOSSARY[name].unit_for(motion), digits)


def readable(value: float, unit: str, digits: int = 4) -> str:
    """A value with its unit; a prefix replaces an exponent and noughts: "0.15 J", and "1.5 mJ"."""
    factor, unit = spoken(unit)
    value *= factor
    power, name = _readable_prefix(value, unit, digits)
    return f"{value / 10.0**power:.{digits}g} {name}".rstrip()


def alike(unit: str, values: Sequence[float], digits: Sequence[int]) -> tuple[str, ...]:
    """Values of one line as `readable` has them, each to its digits; torques and angles with one prefix.

    It is that of the smallest value that is not 0, unless another is far above.
    """
    factor, said = spoken(unit)
    numbers = [value * factor for value in values]
    sizes = sorted(abs(number) for number in numbers if number)
    if not sizes or sizes[-1] >= _FAR * sizes[0] or not said.startswith(_NO_EXPONENT):
        return tuple(readable(value, unit, n) for value, n in zip(values, digits, strict=True))
    power, name = _readable_prefix(sizes[0], said, min(digits))
    return tuple(
        f"{_rounded(number / 10.0**power, n)} {name}" for number, n in zip(numbers, digits, strict=True)
    )


def _readable_prefix(value: float, unit: str, digits: int) -> tuple[int, str]:
    text = f"{value:.{digits}g}"
    is_long = "e" in text or 0.0 < abs(value) < 0.01
    power = 3 * floor(log10(abs(value)) / 3) if is_long and unit in _READABLE else 0
    if power in PREFIXES and power:
        return power, f"{PREFIXES[power]}{unit_text(unit)}"
    return _instead_of_exponent(value, unit, digits) if value else (0, unit_text(unit))


def in_unit(value: float | None, unit: str) -> str:
    """A value of six digits, a tiny one with a prefix; "none" and "any" for what is no number."""
    if value is None:
        return "none"
    if value == inf:
        return "any"
    return readable(value, unit, 6) if "e-" in f"{value * spoken(unit)[0]:.6g}" else told(value, unit)


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


def enough(value: float | None, unit: str) -> str:
    """`in_unit` of a value from which on something holds, never rounded down."""
    return in_unit(at_least(value, unit), unit)


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
