"""A number that was answered: whether it needs its unit, and how it was understood."""

from __future__ import annotations

import math

from zwidth.errors import InputError
from zwidth.quantity.exact import Exact, Interval, ends
from zwidth.quantity.text import readable, shown

_LIKELY = {"m": "mm", "rad": "deg"}
"""What a person means who writes a length or an angle without its unit."""


def is_bare(answer: str) -> bool:
    """True of a number without a unit."""
    return not any(c.isalpha() or c in "°%" for c in answer)


def with_unit(answer: str, unit: str) -> str:
    """The answer with the unit that a bare number has, as a file should show it."""
    return f"{answer} {unit}" if is_bare(answer) and unit not in ("", "1") else answer


def need_unit(answer: str, number: Exact | Interval, unit: str, key: str) -> None:
    """Ask for the unit of a length or an angle: 1000 is hardly a kilometre, 10 hardly ten radians."""
    if unit in _LIKELY and is_bare(answer) and any(ends(number)):
        raise InputError(
            f'{key} needs its unit, got {answer[:40]}: write "{answer[:40]} {_LIKELY[unit]}", '
            f'or "{answer[:40]} {unit}" if that is meant'
        )


def understood(number: Exact | Interval, unit: str) -> str:
    """A number as it was understood, in SI; an angle in degrees too."""
    if isinstance(number, Interval):
        return shown(number, unit)
    value = float(number)
    degrees = f" ({math.degrees(value):.6g}°)" if unit == "rad" else ""
    return readable(value, unit, 6) + degrees
