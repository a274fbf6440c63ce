"""The tables on the sheets of a workbook, and which of them is meant."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from difflib import get_close_matches
from pathlib import Path
from typing import NamedTuple

from zwidth.data.logs.block import Finding
from zwidth.data.logs.grid import Grid, grid_of
from zwidth.data.logs.table import PIECE, Table, Values, listed
from zwidth.data.logs.text import Parser, unit_in
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

    Sheets that are hidden are read where they are named.
    """
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
    """The sheet of a name, however its letters are written."""
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

    def read(columns: tuple[str, ...]) -> Iterator[tuple[Values, ...]]:
        _refuse_formulas(book, name, grid, columns)
        parser = Parser(_source(book, name), layout, columns)
        for k in range(layout.skipped, len(grid.lines), PIECE):
            yield from parser.parse(("\n".join(grid.lines[k : k + PIECE]) + "\n").encode())
        parser.report(notes)

    units = {column: unit_in(layout, column) for column in layout.names}
    return Table(source=_source(book, name), units=units, read=read, notes=notes, sheet=name)


def _refuse_formulas(book: Sheets, name: str, grid: Grid, columns: tuple[str, ...]) -> None:
    """A column in which nothing stands, because its results were never computed."""
    for column in columns:
        place = grid.layout.names.index(column)
        if not any(grid.layout.fields(column)) and book.formulas(name, place, grid.layout.skipped):
            raise InputError(
                f'{_source(book, name)}: column "{column}" holds formulas, and their results are not in the '
                "file; open it in a spreadsheet program and save it, then they are"
            )
