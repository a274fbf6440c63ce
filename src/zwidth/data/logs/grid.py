"""Where the table stands on the sheet of a workbook: among titles, settings, results and notes.

A row with names, in which two cells or more hold text and none a number, stands above each table.  The
longest table is taken; those below it under the same names go on with it, as when tests are put under each
other.  What else is a table of its own is left out, and said.
"""

from __future__ import annotations

from itertools import pairwise
from typing import NamedTuple

from zwidth.data.logs.cells import is_nothing
from zwidth.data.logs.layout import Layout, is_value, laid_out, sample_of

FEWEST_ROWS = 3
"""Of a table; a setting or a mean is none."""

_FEWEST_NAMES = 2


class Grid(NamedTuple):
    """A sheet as lines with tabs, how they are laid out, the rows of the table, and those of others,
    (first, last) from 1."""

    lines: list[str]
    layout: Layout
    rows: int
    left: list[tuple[int, int]]


class _Row(NamedTuple):
    values: int
    texts: int


def grid_of(rows: list[list[str]], source: str) -> Grid | None:
    """The longest table of a sheet; None where there is none."""
    kinds = [_kinds(row) for row in rows]
    heads = [k for k, kind in enumerate(kinds) if not kind.values and kind.texts >= _FEWEST_NAMES]
    blocks = [
        (before + 1, end)
        for before, end in pairwise([-1, *heads, len(rows)])
        if _rows(kinds, before + 1, end) >= FEWEST_ROWS
    ]
    if not blocks:
        return None
    main = max(blocks, key=lambda block: _rows(kinds, *block))
    first = _first(kinds, main)
    width = max(map(len, rows[max(main[0] - 2, 0) : main[1]]))
    lines = [_line(row, width) for row in rows]
    lines[main[0] : first] = [""] * (first - main[0])
    upper = lines[: main[1]]
    layout = laid_out(upper, "\t", width, first, sample_of(upper, "\t", width, first), source)
    own = [main] + [b for b in blocks if b[0] > main[0] and _again(b[0], heads, lines, layout.header)]
    inside = {k for start, end in own for k in range(start, _end(kinds, start, end))}
    inside |= set(range(*own[-1]))  # with the notes below it
    left = [(start + 1, _end(kinds, start, end)) for start, end in blocks if (start, end) not in own]
    body = [lines[k] if k in inside else "" for k in range(first, len(rows))]
    return Grid(lines[:first] + body, layout, _rows(kinds, *main), left)


def _kinds(row: list[str]) -> _Row:
    values = sum(map(is_value, row))
    return _Row(values, len(row) - values - sum(map(is_nothing, row)))


def _rows(kinds: list[_Row], start: int, end: int) -> int:
    """How many rows of a block hold two numbers or more."""
    return sum(kind.values >= _FEWEST_NAMES for kind in kinds[start:end])


def _end(kinds: list[_Row], start: int, end: int) -> int:
    """Behind the last row of a block that holds two numbers."""
    return next(k + 1 for k in range(end - 1, start - 1, -1) if kinds[k].values >= _FEWEST_NAMES)


def _again(start: int, heads: list[int], lines: list[str], header: str) -> bool:
    """True where the names of the main table stand above a block again, or above its units."""
    above = [k for k in heads if k < start][-2:]
    return bool(header) and any(lines[k] == header and start - k <= 2 for k in above)


def _first(kinds: list[_Row], block: tuple[int, int]) -> int:
    """Where the numbers begin: a setting with its number, "preload 0.5", is no row of the table."""
    start, end = block
    most = max(kind.values for kind in kinds[start:end])
    return next(k for k in range(start, end) if 2 * kinds[k].values > most or kinds[k].values == most)


def _line(row: list[str], width: int) -> str:
    if not row:
        return ""
    return "\t".join(row[:width] + [""] * (width - len(row)))
