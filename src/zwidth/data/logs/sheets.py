"""The tables on the sheets of a workbook, and which of them is meant."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from difflib import get_close_matches
from functools import partial
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

from zwidth.data.logs.cells import is_nothing
from zwidth.data.logs.layout import Layout, is_value, laid_out, sample_of
from zwidth.data.logs.table import PIECE, Finding, Table, Values, listed
from zwidth.data.logs.text import Parser, unit_in, wide
from zwidth.errors import InputError


class Sheets(NamedTuple):
    """A workbook: its sheets and whether they are shown, others such as charts, the cells of a sheet as text,
    and whether a column, from 0, holds a formula without its result in a row, from 0."""

    path: Path
    shown: Mapping[str, bool]
    others: frozenset[str]
    rows: Callable[[str], list[list[str]]]
    formulas: Callable[[str, int, int], bool]


def table_of_sheets(book: Sheets, sheet: str | None) -> Table:
    """The longest table, and in `Table.sheets` all of them where there are several; or that of one sheet.
    Sheets that are hidden are read where they are named."""
    names = [name for name, shown in book.shown.items() if shown] if sheet is None else [_named(book, sheet)]
    grids = {name: grid for name in names if (grid := grid_of(book.rows(name), _source(book, name)))}
    if not grids:
        where = listed(names) if sheet is None else f'"{names[0]}"'
        hidden = [name for name, shown in book.shown.items() if not shown] if sheet is None else []
        more = f"; hidden are {listed(hidden)}" if hidden else ""
        raise InputError(f"{book.path} holds no table of numbers on {where}{more}")
    tables = {name: _table(book, name, grid) for name, grid in grids.items()}
    longest = max(grids, key=lambda name: grids[name].rows)
    if len(tables) > 1:
        tables[longest].sheets = tuple(tables.values())
    return tables[longest]


def _named(book: Sheets, sheet: str) -> str:
    found = [name for name in book.shown if name == sheet] or [
        name for name in book.shown if name.strip().lower() == sheet.strip().lower()
    ]
    if len(found) == 1:
        return found[0]
    if sheet in book.others:
        raise InputError(
            f'{book.path}: "{sheet}" is a chart; there are the sheets {listed(list(book.shown))}'
        )
    near = get_close_matches(sheet, list(book.shown), n=1)
    hint = f'; did you mean "{near[0]}"?' if near else ""
    raise InputError(f'{book.path} has no sheet "{sheet}"{hint}; there are {listed(list(book.shown))}')


def _source(book: Sheets, name: str) -> str:
    return f'{book.path}, sheet "{name}"' if len(book.shown) > 1 else str(book.path)


def _table(book: Sheets, name: str, grid: Grid) -> Table:
    layout = grid.layout
    notes: dict[str, Finding] = {}
    if len(book.shown) > 1:
        notes["sheet"] = Finding(kind="sheet", text=f'read is the sheet "{name}" of {len(book.shown)}')
    for first, last in grid.left:
        text = f"rows {first} to {last} of the sheet are another table and left out"
        notes[f"rows {first}"] = Finding(kind="other table", text=text)

    def read(layout: Layout, columns: tuple[str, ...]) -> Iterator[tuple[Values, ...]]:
        _refuse_formulas(book, name, grid, columns)
        parser = Parser(_source(book, name), layout, columns)
        for k in range(layout.skipped, len(grid.lines), PIECE):
            yield from parser.parse(("\n".join(grid.lines[k : k + PIECE]) + "\n").encode())
        parser.report(notes)

    units = {column: unit_in(layout, column) for column in layout.names}
    table = Table(
        source=_source(book, name), units=units, read=partial(read, layout), notes=notes, sheet=name
    )
    return wide(table, layout, read)


def _refuse_formulas(book: Sheets, name: str, grid: Grid, columns: tuple[str, ...]) -> None:
    """A column in which nothing stands, because its results were never computed."""
    for column in columns:
        place = grid.layout.names.index(column)
        if not any(grid.layout.fields(column)) and book.formulas(name, place, grid.layout.skipped):
            raise InputError(
                f'{_source(book, name)}: column "{column}" holds formulas, and their results are not in the '
                "file; open it in a spreadsheet program and save it, then they are"
            )


# Where the table stands on the sheet of a workbook: among titles, settings, results and notes.
#
# A row with names, in which two cells or more hold text and none a number of a column, stands above each
# table.  The longest table is taken; those below it under the same names go on with it, as when tests are put
# under each other.  What else is a table of its own is left out, and said.

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
    heads = [k for k, kind in enumerate(kinds) if kind.texts >= _FEWEST_NAMES and _names(rows, kinds, k)]
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


def _names(rows: list[list[str]], kinds: list[_Row], k: int) -> bool:
    """True where a row with texts holds no number, or only such as stand above nothing: they were typed
    beside the names."""
    if not kinds[k].values:
        return True
    typed = [c for c, cell in enumerate(rows[k]) if is_value(cell)]
    near = zip(rows[k + 1 : k + 20], kinds[k + 1 :], strict=False)
    below = [row for row, kind in near if kind.texts < _FEWEST_NAMES]
    return bool(below) and not any(row[c] for row in below for c in typed if c < len(row))


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
