"""Small pictures in text: an account as bars, a motion as a row of levels."""

from __future__ import annotations

from collections.abc import Sequence
from math import inf, isfinite

_EIGHTHS = " ▏▎▍▌▋▊▉█"
_LEVELS = "▁▂▃▄▅▆▇█"
_ASCII_LEVELS = "_.-=+*%#"

PICTURE = _EIGHTHS + _LEVELS
"""Every character that the Unicode form uses."""


def bar(start: float, end: float, scale: float, width: int, fancy: bool) -> str:
    """A bar from `start` to `end` on an axis from 0 to `scale`, `width` cells long."""
    low, high = sorted((_cells(start, scale, width), _cells(end, scale, width)))
    if high - low <= 0:
        return ""
    first = int(low)
    if not fancy:
        return " " * first + "#" * max(1, round(high) - first)
    whole, part = divmod(high - first, 1)
    tail = _EIGHTHS[round(8 * part)].strip()
    return " " * first + "█" * int(whole) + (tail or ("" if whole else _EIGHTHS[1]))


def _cells(value: float, scale: float, width: int) -> float:
    if not scale or not isfinite(value):
        return float(width) if value == inf else 0.0
    return min(max(value / scale, 0.0), 1.0) * width


def levels(values: Sequence[float], fancy: bool) -> str:
    """Each value as a character of its height, the smallest to the largest."""
    marks = _LEVELS if fancy else _ASCII_LEVELS
    low, high = min(values), max(values)
    span = (high - low) or 1.0
    return "".join(marks[round((v - low) / span * (len(marks) - 1))] for v in values)
