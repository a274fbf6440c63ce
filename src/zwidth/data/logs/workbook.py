"""Workbooks, .xlsx and .xlsm: the table on each sheet, as the program that wrote it left the numbers.

A formula is its result as it was kept in the file.  Charts, pictures and macros are not looked at.  Read with
openpyxl, row by row: a quicker library makes room for every cell between the first and the last one, and two
cells far apart end the program.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from datetime import date, datetime, time, timedelta
from pathlib import Path
from typing import Any

from zwidth.data.logs.archive import check_workbook
from zwidth.data.logs.cells import decimal_of, is_nothing, is_number, number
from zwidth.data.logs.encoded import plain_signs
from zwidth.data.logs.sheets import Sheets, table_of_sheets
from zwidth.data.logs.table import Table
from zwidth.errors import InputError

MOST_ROWS = 2**20
"""Of a sheet: no program writes more."""

MOST_CELLS = 2**25
"""Of a sheet, with those left empty before the last of each row."""

_DAY_0 = datetime(1899, 12, 31)
"""A time of more than a day counts from there."""


def workbook_table(path: Path, sheet: str | None) -> Table:
    """The tables in a workbook, or that of one sheet."""
    check_workbook(path)
    with _opened(path, results=True) as book:
        shown = {each.title: each.sheet_state == "visible" for each in book.worksheets}
        others = {each.title for each in book.chartsheets}
    return table_of_sheets(
        Sheets(
            path,
            shown,
            frozenset(others),
            rows=lambda name: _rows(path, name),
            formulas=lambda name, column, begin: _is_formula(path, name, column, begin),
        ),
        sheet,
    )


@contextmanager
def _opened(path: Path, results: bool) -> Iterator[Any]:
    """The workbook with the results of its formulas, or with the formulas themselves."""
    from openpyxl import load_workbook  # takes its time

    with warnings.catch_warnings(), open(path, "rb") as file:
        warnings.simplefilter("ignore")  # of styles and of features that are not looked at
        try:
            book = load_workbook(file, read_only=True, data_only=results, keep_links=False)
            if not book.worksheets:
                raise InputError(
                    f"{path} has no sheet that can be read; if it is a strict Open XML workbook, save it as "
                    "an ordinary .xlsx"
                )
            yield book
        except (InputError, MemoryError):
            raise
        except Exception as error:  # what the library raises on foreign bytes is not documented
            reason = (str(error) or type(error).__name__).splitlines()[0][:120]
            raise InputError(
                f"{path} cannot be read as a workbook ({reason}); open it in a spreadsheet program and save "
                "it anew, or save the sheet as CSV"
            ) from None


def _rows(path: Path, name: str) -> list[list[str]]:
    """The cells of a sheet as text."""
    found: list[list[str]] = []
    numbers: set[int] = set()
    cells = 0
    for row in _values(path, name, results=True):
        cells += len(row)
        if len(found) == MOST_ROWS or cells > MOST_CELLS:
            raise InputError(
                f'{path}, sheet "{name}", is not read: it has more than {MOST_ROWS} rows or {MOST_CELLS} '
                "cells; leave in it what was measured"
            )
        numbers |= {k for k, value in enumerate(row) if isinstance(value, float)}
        found.append([_written(value) for value in row])
        while found[-1] and not found[-1][-1]:
            found[-1].pop()
    while found and not found[-1]:
        found.pop()
    for column in numbers:
        _alike(found, column)
    return found


def _alike(rows: list[list[str]], column: int) -> None:
    """Write texts in a column of numbers, "0,5", as the numbers are; what may be two numbers stays a text."""
    texts = [row for row in rows if column < len(row) and "," in row[column] and is_number(row[column])]
    sign = decimal_of(row[column] for row in texts)
    for row in texts:
        value = None if sign is None else number(row[column], sign)
        row[column] = f"{row[column]} (a text)" if value is None else _written(value)


def _values(path: Path, name: str, results: bool) -> Iterator[tuple[Any, ...]]:
    with _opened(path, results) as book:
        sheet = book[name]
        sheet.reset_dimensions()  # not every program states them as they are
        yield from sheet.iter_rows(values_only=True)


def _is_formula(path: Path, name: str, column: int, begin: int) -> bool:
    """True where the first row of a column holds a formula, whose result is not in the file."""
    for k, row in enumerate(_values(path, name, results=False)):
        if k == begin:
            value = row[column] if column < len(row) else None
            return isinstance(value, str) and value.startswith("=")
    return False


def _written(value: object) -> str:
    """A cell as text; a number with the decimal point, never in such a way that the point may group."""
    if value is None:
        return ""
    if isinstance(value, float):
        text = repr(value)
        return text + "0" if text[-4:-3] == "." else text
    if isinstance(value, bool | int):
        return str(value)
    if isinstance(value, timedelta):
        return _clock(value)
    if isinstance(value, datetime):
        return _clock(value - _DAY_0) if value.year <= 1900 else value.isoformat(" ")
    if isinstance(value, date):
        return f"{value.isoformat()} 00:00:00"
    if isinstance(value, time):
        return value.isoformat()
    text = plain_signs(" ".join(str(value).split())).replace('"', "″")
    return "" if is_nothing(text) else text.lstrip("#%/ ")


def _clock(since: timedelta) -> str:
    """Hours, minutes and seconds."""
    seconds = since.total_seconds()
    if seconds < 0:
        return ""
    return f"{int(seconds // 3600)}:{int(seconds // 60) % 60:02d}:{seconds % 60:09.6f}"
