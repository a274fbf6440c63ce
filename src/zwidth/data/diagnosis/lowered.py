"""One number that is lowered until the verdict is passive, with a margin: of a loop as of a pair."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import floor, log10
from typing import Protocol

from zwidth.quantity.text import shown

PASSIVE = ("passive", "passive in contact")
"""Outcomes that a change may have."""

_HALVINGS = 14
_MARGIN = 0.8
"""Of the largest value that is passive: at that itself a motion that is there need not die out."""

_DIGITS = 3


class Judged(Protocol):
    """A verdict of any kind of loop."""

    @property
    def outcome(self) -> str:
        """As of `check`."""


@dataclass(frozen=True, kw_only=True)
class Lowered:
    """One number, from where it is to where it may be.

    Parameters
    ----------
    parameter
        Its key, such as "stiffness".
    current, to
        In `unit`.
    unit
        SI.
    text
        In words.
    verdict
        What `check` says to what has the number changed.
    """

    parameter: str
    current: float
    to: float
    unit: str
    text: str
    verdict: Judged

    def to_dict(self) -> dict[str, object]:
        """As plain data."""
        return {
            "parameter": self.parameter,
            "from": self.current,
            "to": self.to,
            "unit": self.unit,
            "text": self.text,
            "outcome": self.verdict.outcome,
        }


def lowered_to(name: str, current: float, to: float, unit: str) -> str:
    """What to do, in words."""
    return f"lower the {name} from {shown(current, unit, 3)} to {shown(to, unit, 3)}"


def largest(decided: Callable[[float], Judged | None], current: float) -> float | None:
    """The largest value up to the current one that is passive, of a few digits; None where only 0 is, or
    none.
    """

    def passive(value: float) -> bool:
        verdict = decided(value)
        return verdict is not None and verdict.outcome in PASSIVE

    low, high = 0.0, current
    if not passive(0.0) and not passive(1e-3 * current):
        return None
    if passive(current):
        low = current
    for _ in range(_HALVINGS if low < high else 0):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if passive(middle) else (low, middle)
    to = with_margin(low)
    return to if to > 1e-3 * current and passive(to) else None


def with_margin(limit: float) -> float:
    """Four fifths of a limit, of a few digits."""
    return rounded(_MARGIN * limit)


def rounded(value: float) -> float:
    """Down to three digits."""
    if value <= 0:
        return 0.0
    step = 10.0 ** (floor(log10(value)) - _DIGITS + 1)
    return float(f"{floor(value / step * (1 + 1e-12)) * step:.{_DIGITS}g}")


def text_of(value: float) -> str:
    """The decimal that is meant."""
    return f"{value:.6g}"
