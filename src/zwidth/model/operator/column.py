"""One column of numbers from a text file."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Iterator
from itertools import islice
from pathlib import Path
from typing import TextIO

from zwidth.errors import InputError

MOST_LINES = 50_000_000
"""Lines read at most: 14 hours at 1 kHz."""

LONGEST_LINE = 2**20
"""Characters of the longest line."""


def read_column(path: str | Path, column: str | int | None = None) -> list[float]:
    """The numbers of one column, in the order of the lines.

    Parameters
    ----------
    path
        Comma, semicolon or blank separates; "#" starts a comment; the first line may be names.
    column
        Its name or its number from 0; None where there is only one.
    """
    try:
        with Path(path).open(encoding="utf-8-sig", newline="") as lines:
            return _numbers(path, _lines(path, lines), column)
    except OSError as error:
        raise InputError(f"{path} cannot be read: {error.strerror or error}") from None
    except (UnicodeDecodeError, csv.Error):
        raise InputError(f"{path} is not a text file of numbers; give one number on each line") from None


def _lines(path: str | Path, file: TextIO) -> Iterator[str]:
    while line := file.readline(LONGEST_LINE + 1):
        if len(line) > LONGEST_LINE:
            raise InputError(f"{path} has a line of more than {LONGEST_LINE} characters; it is no table")
        yield line


def _numbers(path: str | Path, lines: Iterable[str], column: str | int | None) -> list[float]:
    index, width, numbers = -1, 0, list[float]()
    for number, line in enumerate(islice(lines, MOST_LINES), start=1):
        cells = _cells(line)
        if not cells:
            continue
        if width == 0:
            width = len(cells)
            header = cells if any(_float(cell) is None for cell in cells) else None
            index = _index(path, header, width, column)
            if header:
                continue
        if len(cells) != width:
            raise InputError(f"{path}, line {number}: {len(cells)} values where the first line has {width}")
        value = _float(cells[index])
        if value is None:
            raise InputError(f"{path}, line {number}: expected a number, got {cells[index][:40]!r}")
        numbers.append(value)
    if not numbers:
        raise InputError(f"{path} holds no number; give one on each line")
    return numbers


def _cells(line: str) -> list[str]:
    text = line.split("#", 1)[0].strip()
    for separator in (",", ";", "\t"):
        if separator in text:
            return [cell.strip() for cell in next(csv.reader([text], delimiter=separator))]
    return text.split()


def _float(cell: str) -> float | None:
    try:
        return float(cell)
    except ValueError:
        return None


def _index(path: str | Path, header: list[str] | None, width: int, column: str | int | None) -> int:
    names = f": {', '.join(header)}" if header else ""
    if column is None:
        if width > 1:
            raise InputError(f"{path} has {width} columns{names}; say which one holds the force")
        return 0
    if isinstance(column, str):
        if header is None or column not in header:
            raise InputError(f"{path} has no column {column!r}{names or ', its columns have no names'}")
        if header.count(column) > 1:
            raise InputError(f"{path} has more than one column {column!r}; give its number, counted from 0")
        return header.index(column)
    if not 0 <= column < width:
        raise InputError(f"{path} has no column {column}: it has {width}, counted from 0")
    return column
