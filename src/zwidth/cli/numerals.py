"""Numbers with units as a report shows them: 22.4e-6 m is "22.4 µm"."""

from __future__ import annotations

from math import floor, inf, log10

from zwidth.quantity.exact import Exact, Interval

_PREFIXES = {-9: "n", -6: "µ", -3: "m", 0: "", 3: "k", 6: "M", 9: "G"}
_PREFIXED = ("m", "s", "J", "N", "Hz", "m/s")
"""Units that people prefix; N·s/m stays as it is, and 300 N/m too."""


def shown(value: float | Exact | Interval | None, unit: str, digits: int = 4) -> str:
    """A value with its unit, to `digits` significant digits."""
    if value is None:
        return "none"
    if isinstance(value, Interval):
        return f"{float(value.low):g} … {float(value.high):g} {unit_text(unit)}".rstrip()
    number = float(value)
    if abs(number) == inf:
        return "any" if number > 0 else "none"
    power, name = _prefix(number, unit, digits)
    return f"{number / 10.0**power:.{digits}g} {name}".rstrip()


def unit_text(unit: str) -> str:
    """A unit as it is printed: "N*s/m" as "N·s/m", "1" as nothing."""
    return "" if unit == "1" else unit.replace("*", "·").replace("^2", "²")


def _prefix(number: float, unit: str, digits: int) -> tuple[int, str]:
    if unit not in _PREFIXED or number == 0:
        return 0, unit_text(unit)
    rounded = float(f"{abs(number):.{digits}g}")
    power = 3 * floor(floor(log10(rounded)) / 3)
    if (unit == "m" and power > 0) or (unit == "N" and 0.01 <= rounded < 1000) or power not in _PREFIXES:
        return 0, unit  # nobody says kilometres here, nor 120 mN for 0.12 N
    return power, _PREFIXES[power] + unit
