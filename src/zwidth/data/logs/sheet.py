"""Rows of a spreadsheet cell by cell, where they are not written plainly enough for the quick reader.

Thousands in groups, columns with different decimal signs, times of day, dates as people write them, words for
a missing number, lines of text below the table.  A line of text between numbers is refused: nobody knows
what it was.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from zwidth.data.logs.cells import (
    clock,
    decimal_of,
    is_nothing,
    number,
    past_midnight,
    stamps_of,
)
from zwidth.data.logs.layout import Layout, is_comment, split
from zwidth.data.logs.table import Values
from zwidth.errors import InputError

MOST_NOTES = 50
"""Lines of text below a table; more are no notes."""


class Piece(NamedTuple):
    """Columns, how many rows were of another length, and the lines of text below, the first of them."""

    columns: tuple[Values, ...]
    broken: int
    notes: int
    first_note: str


class Sheet:
    """The cells of some columns; how a column is written is decided once."""

    def __init__(self, source: str, layout: Layout, names: tuple[str, ...]) -> None:
        self.source, self.layout, self.names = source, layout, names
        self._decimal = {name: decimal_of(layout.fields(name)) or layout.decimal for name in names}
        self._last = dict.fromkeys(names, float("nan"))

    def read(self, lines: str, before: int) -> Piece:
        """The columns of whole lines, which come after so many of the file."""
        rows, broken = [], 0
        for k, line in enumerate(lines.splitlines()):
            if not line.strip() or is_comment(line):
                continue
            fields = self._fitted(split(line, self.layout.delimiter))
            if fields is None:
                broken += 1
            else:
                rows.append((before + k + 1, fields))
        wanted = [self.layout.names.index(name) for name in self.names]
        columns = [
            self._column(name, [fields[k] for _, fields in rows])
            for name, k in zip(self.names, wanted, strict=True)
        ]
        end = self._end(rows, columns, wanted)
        notes = [fields for _, fields in rows[end:] if any(fields)]
        note = " ".join(field for field in notes[0] if field)[:60] if notes else ""
        return Piece(
            tuple(self._values(name, column[:end]) for name, column in zip(self.names, columns, strict=True)),
            broken,
            len(notes),
            note,
        )

    def _fitted(self, fields: list[str]) -> list[str] | None:
        """As many as there are names: empty ones at the end do not count."""
        count = len(self.layout.names)
        if len(fields) > count and not any(fields[count:]):
            return fields[:count]
        return fields if len(fields) == count else None

    def _column(self, name: str, fields: list[str]) -> list[object]:
        """What each cell says; None where it is something else."""
        kind = self.layout.kind(name)
        if kind == "clock":
            return [float("nan") if is_nothing(field) else clock(field) for field in fields]
        if kind in ("calendar", "date"):
            stamps = stamps_of(fields)
            if stamps is None:
                raise InputError(
                    f'{self.source}: in the dates of column "{name}", such as "{fields[0]}", day and month '
                    "may be either; write them as 2026-11-26 10:15:03"
                )
            nothing = np.datetime64("NaT", "ns")
            return [
                nothing if is_nothing(field) else stamp for field, stamp in zip(fields, stamps, strict=True)
            ]
        return [number(field, self._decimal[name]) for field in fields]

    def _end(self, rows: list[tuple[int, list[str]]], columns: list[list[object]], wanted: list[int]) -> int:
        """Where the lines of text below the table begin; a line of text before is refused."""
        bad = [any(column[k] is None for column in columns) for k in range(len(rows))]
        end = len(rows)
        while end and (bad[end - 1] or not any(rows[end - 1][1])):
            end -= 1
        first = next((k for k in range(end) if bad[k]), end if len(rows) - end > MOST_NOTES else None)
        if first is not None and first < len(rows):
            line, fields = rows[first]
            place = next(k for k, column in enumerate(columns) if column[first] is None)
            raise InputError(
                f'{self.source}: column "{self.names[place]}" holds text near line {line}: '
                f'"{fields[wanted[place]][:40]}"; leave the cell empty if there is no number'
            )
        return end

    def _values(self, name: str, column: list[object]) -> Values:
        kind = self.layout.kind(name)
        if kind in ("calendar", "date"):
            return np.array(column, dtype="datetime64[ns]")
        values = np.array(column, dtype=float)
        if kind == "clock" and values.size:
            values = past_midnight(values, self._last[name])
            self._last[name] = float(values[-1])
        return values
