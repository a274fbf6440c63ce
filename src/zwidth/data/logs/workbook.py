"""Workbooks, .xlsx and .xlsm: the table on each sheet, as the program that wrote it left the numbers.

A formula is its result as it was kept in the file.  Charts, pictures and macros are not looked at.  Read with
openpyxl, row by row: a quicker library makes room for every cell between the first and the last one, and two
cells far apart end the program.
"""

from __future__ import annotations

import re
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from datetime import date, datetime, time, timedelta
from pathlib import Path
from typing import Any, Literal
from zipfile import BadZipFile, ZipFile, ZipInfo

from zwidth.data.logs.cells import decimal_of, is_nothing, is_number, number, plain_signs
from zwidth.data.logs.sheets import Sheets, table_of_sheets
from zwidth.data.logs.table import Table
from zwidth.errors import InputError
from zwidth.installing import library
from zwidth.reading import check_chunk, check_expansion

MOST_ROWS = 2**20
"""Of a sheet: no program writes more."""

MOST_CELLS = 2**25
"""Of a sheet, with those left empty before the last of each row."""

_DAY_0 = datetime(1899, 12, 31)
"""A time of more than a day counts from there."""


def workbook_table(path: Path, sheet: str | None) -> Table:
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
    openpyxl = library("openpyxl", f"{path} is not read: a workbook")
    with warnings.catch_warnings(), open(path, "rb") as file:
        warnings.simplefilter("ignore")  # of styles and of features that are not looked at
        try:
            book = openpyxl.load_workbook(file, read_only=True, data_only=results, keep_links=False)
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
    seconds = since.total_seconds()
    if seconds < 0:
        return ""
    return f"{int(seconds // 3600)}:{int(seconds // 60) % 60:02d}:{seconds % 60:09.6f}"


# What a workbook is inside, a zip archive, and what it would become: looked at before a library does.
#
# The library holds styles and texts in memory as objects, many times as large as they are in the file, and a
# row at a time; so each of these is bounded by itself.

SMALL = 2**20
"""[bytes] Most of what describes a workbook: styles, names, relations."""

TEXTS = 2**23
"""[bytes] Most of its texts."""

LONGEST_ROW = 2**22
"""[bytes] Most of one row, and of what stands behind the last."""

_STEP = 2**20
_SHEET = re.compile(r"xl/worksheets/[^/]+\.xml", re.IGNORECASE)
_NOT_READ = re.compile(
    r"xl/(media|drawings|charts|embeddings|externalLinks|pivotCache|pivotTables|printerSettings|model|"
    r"activeX|ctrlProps|queryTables|tables|threadedComments|customData|comments|calcChain|vbaProject|"
    r"worksheets/_rels)\b|customXml/|docProps/thumbnail",
    re.IGNORECASE,
)
_MAIN = re.compile(rb"<(?:\w+:)?Override\b[^>]*\bspreadsheetml\.sheet\.main\+xml[^>]*>")
_PART = re.compile(rb'PartName\s*=\s*["\']/?([^"\']*)["\']')

Kind = Literal["workbook", "binary", "open document", "other", "arrays"]


def kind_of_archive(path: Path) -> Kind:
    """What a zip archive holds, by the names in it."""
    with _unzipped(path) as archive:
        names = set(archive.namelist())
        if "xl/workbook.bin" in names:
            return "binary"
        if "content.xml" in names and "mimetype" in names:
            with archive.open("mimetype") as file:
                spreadsheet = file.read(60).startswith(b"application/vnd.oasis.opendocument.spreadsheet")
            return "open document" if spreadsheet else "other"
        if names and all(name.endswith(".npy") for name in names):
            return "arrays"
        return "workbook" if any(_SHEET.fullmatch(name) for name in names) else "other"


def check_workbook(path: Path) -> None:
    """Refuse a workbook of which a part would become too large."""
    with _unzipped(path) as archive:
        parts = archive.infolist()
        if any(part.flag_bits & 1 for part in parts):
            raise InputError(f"{path} is locked by a password; save it without one")
        check_expansion(path, sum(part.file_size for part in parts))
        described = _main_parts(archive)
        for part in parts:
            check_chunk(path, part.file_size)
            if part.filename not in described and _SHEET.fullmatch(part.filename):
                _check_rows(path, archive, part)
            elif part.filename in described or not _NOT_READ.match(part.filename):
                most = TEXTS if part.filename.lower() == "xl/sharedstrings.xml" else SMALL
                if part.file_size > most:
                    raise InputError(
                        f"{path} is not read: its {part.filename} would become {part.file_size} bytes, and "
                        f"{most} are enough for a recording; save the sheet as CSV"
                    )


def _unzipped(path: Path) -> ZipFile:
    try:
        return ZipFile(path)
    except (BadZipFile, OSError, ValueError, NotImplementedError):
        raise InputError(
            f"{path} begins as a workbook or a zip archive does, but is damaged or cut off; copy it anew"
        ) from None


def _main_parts(archive: ZipFile) -> set[str]:
    """The parts that say of themselves that they are the workbook."""
    try:
        with archive.open("[Content_Types].xml") as file:
            types = file.read(SMALL)
    except KeyError:
        return set()
    return {
        name[1].decode("utf-8", "replace")
        for one in _MAIN.findall(types)
        if (name := _PART.search(one)) is not None
    }


def _check_rows(path: Path, archive: ZipFile, part: ZipInfo) -> None:
    """Refuse a sheet with a row that fills the memory."""
    since, tail = 0, b""
    with archive.open(part) as file:
        while piece := file.read(_STEP):
            where = (tail + piece).rfind(b"row")
            since = since + len(piece) if where < 0 else len(tail) + len(piece) - where
            tail = piece[-2:]
            if since > LONGEST_ROW:
                raise InputError(
                    f"{path} is not read: a row of it has more than {LONGEST_ROW} bytes; save it as CSV"
                )
