"""The numbers that entered the proof, as the checker read them: rounded, the file beside has every digit."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from fractions import Fraction

from zwidth.quantity.text import in_words, readable
from zwidth.show.report.proof import NAME, Examined
from zwidth.showing import Part, Table

_DIGITS = 6

_LONGEST = 44
"""Characters of a list that are shown."""

_MOST_ROWS = 24
"""Numbers that entered the proof up to which they are shown."""

_NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:[eE][+-]?\d+)?(?:/\d+)?")
_LIST = re.compile(r"\[[\[\](),…\s\d./eE+-]*\]")

Rows = tuple[tuple[str, str], ...]


def what_was_read(pieces: Sequence[Examined]) -> Iterator[Part]:
    """A table for each piece of evidence; of two that say the same, one."""
    told: list[Rows] = []
    for piece in pieces:
        rows = _rows(piece)
        if 0 < len(rows) <= _MOST_ROWS and rows not in told:
            told.append(rows)
            yield Table(rows=rows, caption=piece.name)
    if told:
        yield f"Rounded to {_DIGITS} digits; the proof is about the exact numbers, which stand in {NAME}."


def _rows(piece: Examined) -> Rows:
    return tuple(
        (in_words(row.name), as_read(row.text, row.unit)) for row in piece.found.rows if not row.told
    )


def as_read(text: str, unit: str) -> str:
    """A value of a document with its unit, for people: a number with a prefix, a list in short."""
    if text == "[]":
        return "none"
    if _NUMBER.fullmatch(text):
        return _rounded(text, unit)
    if _LIST.fullmatch(text):
        text = _in_short(_NUMBER.sub(lambda number: _rounded(number[0]), text))
    elif len(text) > _LONGEST:
        text = f"{text[:_LONGEST]}…"
    return f"{text} {unit}".rstrip()


def _rounded(text: str, unit: str = "") -> str:
    try:
        return readable(float(Fraction(text)), unit, _DIGITS)
    except (ArithmeticError, ValueError):  # larger than any quantity
        return f"{text[:_LONGEST]} {unit}".rstrip()


def _in_short(text: str) -> str:
    """So much of a list as fits, its last number, or list of numbers, whole."""
    if len(text) <= _LONGEST:
        return text
    between = "], " if text.startswith("[[") else ", "
    return f"{text[:_LONGEST].rpartition(between)[0]}{between}…]"
