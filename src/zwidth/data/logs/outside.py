"""Units outside the SI in which spreadsheets and load cells speak."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction

from zwidth.errors import InputError
from zwidth.quantity.units import Unit, unit_of

WEIGHT = Fraction("9.80665")
"""Of a kilogram [N], by definition (3rd CGPM, 1901)."""

POUND = WEIGHT * Fraction("0.45359237")
"""Of force [N]."""

_OUTSIDE: Mapping[str, tuple[str, Fraction]] = {
    **dict.fromkeys(("gf", "pond"), ("N", WEIGHT / 1000)),
    **dict.fromkeys(("kgf", "kp"), ("N", WEIGHT)),
    "lbf": ("N", POUND),
    **dict.fromkeys(("in", "inch", "inches"), ("m", Fraction("0.0254"))),
    **dict.fromkeys(("d", "day", "days", "tag", "tage"), ("s", Fraction(86400))),
    **dict.fromkeys(("h", "hr", "hours"), ("s", Fraction(3600))),
    **dict.fromkeys(("minutes", "mins"), ("s", Fraction(60))),
}


def measured_in(text: str) -> Unit:
    """A unit as `unit_of` has it, or one of these."""
    try:
        return unit_of(text)
    except InputError:
        if text not in _OUTSIDE:
            raise
    base, scale = _OUTSIDE[text]
    return unit_of(base)._replace(scale=scale)
