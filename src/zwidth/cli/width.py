"""How wide a report may be, and lines that keep to it, whatever characters they are made of."""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from unicodedata import combining, east_asian_width

from zwidth.showing import Lines, Part, Table

PIPED, WIDEST, NARROWEST = 80, 100, 20
"""Columns without a terminal; the most that read well; the fewest into which words are put."""

GLUE = "\ue000"
"""Stands for a blank at which no line may break; whoever prints it puts the blank back."""

_BETWEEN = "  "
_MARK = re.compile(r"\s*([·*✓✗-]|\d+\.) ")


def columns() -> int:
    """The columns of a report: those of COLUMNS or of the terminal, at most 100; 80 without either."""
    return min(max(_there(), NARROWEST), WIDEST)


def _there() -> int:
    asked = os.environ.get("COLUMNS", "")
    if asked.isdecimal() and int(asked):
        return int(asked)
    if sys.stdout is None or not sys.stdout.isatty():
        return PIPED
    try:
        return os.get_terminal_size(sys.stdout.fileno()).columns or PIPED
    except (OSError, ValueError):  # it says that it is a terminal, and has no size
        return PIPED


def width_of(text: str) -> int:
    """The columns that a text takes: two for a wide character, none for an accent that stands on another."""
    return sum(0 if combining(c) else 2 if east_asian_width(c) in "WF" else 1 for c in text)


def wrapped(text: str, width: int) -> Iterator[str]:
    """The text in lines of at most `width` columns, broken at blanks; inside a word, or inside
    quotes, only where it must be.

    What belongs to an item of a list goes on under its own beginning.
    """
    for line in text.split("\n"):
        if width_of(line) <= width:
            yield line
        else:
            yield from _broken(line, width)


def _broken(line: str, width: int) -> Iterator[str]:
    so_far, blank = "", ""
    indent = line[: len(line) - len(line.lstrip())]
    mark = _MARK.match(line)
    hanging = " " * (len(mark[0]) if mark else len(indent))
    for word in _words(line, width - len(hanging)):
        joined = f"{so_far}{blank}{word}" if so_far else indent + word
        if width_of(joined) <= width:
            so_far, blank = joined, " "
            continue
        if so_far.strip():
            yield so_far
        so_far, blank = (hanging if so_far.strip() else indent) + word, " "
        while width_of(so_far) > width:
            head = _as_much_as_fits(so_far, width)
            yield head
            so_far = hanging + so_far[len(head) :]
    yield so_far


_QUOTED = r"""(?<!\w)'[^'\s][^']*'(?!\w)|(?<!\w)"[^"\s][^"]*"(?!\w)"""
_WORD = re.compile(rf"(?:{_QUOTED}|\S)+")


def _words(line: str, width: int) -> Iterator[str]:
    """What stands between blanks, and what is quoted in one piece where it fits into a line."""
    for found in _WORD.finditer(line):
        yield from [found[0]] if width_of(found[0]) <= width else found[0].split()


def _as_much_as_fits(text: str, width: int) -> str:
    """At least one character more than blanks, else it would never end."""
    length = next((n for n in range(len(text)) if width_of(text[: n + 1]) > width), len(text))
    return text[: max(length, len(text) - len(text.lstrip()) + 1)]


def fitted(parts: Iterable[Part], width: int, spelled: Callable[[str], str] = str) -> Iterator[str]:
    """The parts of a report, line by line, in so many columns; each text as it will be shown."""
    for part in parts:
        if isinstance(part, Table):
            if part.caption:
                yield from (*wrapped(spelled(part.caption), width), "")
            heads, rows = ([[*map(spelled, cells)] for cells in lines] for lines in (part.heads, part.rows))
            yield from _table(replace(part, heads=heads, rows=rows), width)
        elif isinstance(part, Lines):
            for item in part.items:
                yield from wrapped(spelled(f"{part.mark} {item}"), width)
        else:
            yield from wrapped(spelled(str(part)), width)


def _table(table: Table, width: int) -> Iterator[str]:
    """As it is where it fits; else names with texts that break, or several tables below each other."""
    sizes = [max(map(width_of, column)) for column in zip(*table.heads, *table.rows, strict=True)]
    if sum(sizes) + len(_BETWEEN) * (len(sizes) - 1) <= width:
        yield from _set(table, sizes)
    elif len(sizes) == 2 and not table.heads:
        yield from _names_with_texts(table.rows, min(sizes[0], width // 2), width)
    else:
        yield from _stacked(table, sizes, width)


def _set(table: Table, sizes: Sequence[int]) -> Iterator[str]:
    lefts = len(sizes) if table.lefts is None else table.lefts
    for cells in (*table.heads, *table.rows):
        padded = (
            _padded(cell, size, place < lefts)
            for place, (cell, size) in enumerate(zip(cells, sizes, strict=True))
        )
        yield _BETWEEN.join(padded).rstrip()


def _padded(cell: str, size: int, left: bool) -> str:
    blanks = " " * (size - width_of(cell))
    return cell + blanks if left else blanks + cell


def _names_with_texts(rows: Sequence[Sequence[str]], size: int, width: int) -> Iterator[str]:
    for name, text in rows:
        names = list(wrapped(name, size))
        texts = list(wrapped(text, max(width - size - len(_BETWEEN), 1)))
        for place in range(max(len(names), len(texts))):
            left = names[place] if place < len(names) else ""
            right = texts[place] if place < len(texts) else ""
            yield f"{_padded(left, size, True)}{_BETWEEN}{right}".rstrip()


def _stacked(table: Table, sizes: Sequence[int], width: int) -> Iterator[str]:
    """As many columns at a time as fit beside the first, which names the rows of each of the tables."""
    first, rest = [0], list(range(1, len(sizes)))
    while rest:
        taken = [rest.pop(0)]
        while rest and _together(sizes, [*first, *taken, rest[0]]) <= width:
            taken.append(rest.pop(0))
        places = [*first, *taken]
        if _together(sizes, places) > width:  # a column wider than the page: a line for each of its cells
            yield from _one_by_one(table, taken[0], width)
        else:
            lefts = sum(place < (len(sizes) if table.lefts is None else table.lefts) for place in places)
            heads, rows = (
                [[cells[p] for p in places] for cells in part] for part in (table.heads, table.rows)
            )
            yield from _set(Table(rows=rows, heads=heads, lefts=lefts), [sizes[p] for p in places])
        if rest:
            yield ""


def _together(sizes: Sequence[int], places: Sequence[int]) -> int:
    return sum(sizes[p] for p in places) + len(_BETWEEN) * (len(places) - 1)


def _one_by_one(table: Table, place: int, width: int) -> Iterator[str]:
    for cells in (*table.heads, *table.rows):
        text = f"{cells[0]}: {cells[place]}".strip(": ")
        if text:
            yield from wrapped(text, width)
