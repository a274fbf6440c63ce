"""How environments say their numbers in one line."""

from __future__ import annotations

from collections.abc import Sequence

from zwidth.quantity.exact import Exact, Interval
from zwidth.quantity.text import told_quantity

_SUPERSCRIPT = str.maketrans("0123456789", "⁰¹²³⁴⁵⁶⁷⁸⁹")
_LONGEST = 6


def with_unit(key: str, value: Exact | Interval, motion: str) -> str:
    """A value and the unit its glossary entry has for the motion."""
    return told_quantity(value, key, motion)


def never_pulls(clamped: bool) -> str:
    """How the line of a clamped law ends."""
    return ", never pulls" if clamped else ""


def polynomial_text(coefficients: Sequence[float], variable: str) -> str:
    """A polynomial in descending powers; only its order if it is long."""
    order = len(coefficients) - 1
    if order > _LONGEST:
        return f"[order {order}]"
    terms = [_term(c, order - i, variable) for i, c in enumerate(coefficients) if c]
    return " + ".join(terms).replace("+ -", "− ").replace("-", "−") or "0"


def _term(coefficient: float, power: int, variable: str) -> str:
    number = f"{coefficient:.6g}"
    if power == 0:
        return number
    symbol = variable if power == 1 else variable + str(power).translate(_SUPERSCRIPT)
    return symbol if number == "1" else f"{number} {symbol}"
