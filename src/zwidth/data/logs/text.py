"""Text: comma, semicolon, tab, white space; with or without a header; read a few megabytes at a time."""

from __future__ import annotations

import json
import re
import warnings
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from io import BytesIO, TextIOWrapper
from pathlib import Path
from typing import Any

import numpy as np

from zwidth.data.logs.cells import (
    SNIFFED,
    clock,
    decimal_of,
    is_nothing,
    is_number,
    number,
    opened_text,
    past_midnight,
    plain_lines,
    stamps_of,
    text_of,
)
from zwidth.data.logs.layout import LABVIEW, Layout, columns_of_topics, is_comment, layout_of, split
from zwidth.data.logs.records import Records
from zwidth.data.logs.table import Finding, Table, Values, listed
from zwidth.errors import InputError

_PIECE = 2**23
_NULLS = rb" *(?:null|NULL|None|none|NA|N/A|#N/A|-)? *"
"""What stands where a number is missing, for the quick reader."""

_INSTANT = rb"(?:19|20)\d\d-\d\d-\d\d(?:[T ]\d\d:\d\d(?::\d\d(?:\.\d{1,9})?)?)?"
_TYPES = {"float": np.float64, "int": np.int64, "date": np.dtype("M8[ns]"), "words": np.object_}
_SWAPPED = bytes.maketrans(b".,", b",.")
_UNITS = {"date": "ns", "calendar": "ns", "clock": "s"}
"""Of what is read from times that are written out."""

_MOST_BROKEN = 0.01
"""Share of rows of another length beyond which the file is not what it seems."""

MOST_NOTES = 50
"""Lines of text below a table; more are no notes."""


def text_table(path: Path) -> Table:
    with opened_text(path) as file:
        start = file.read(SNIFFED)
        whole = not file.read(1)
        left = file.left_out if isinstance(file, Records) else ""
    layout = layout_of(text_of(start, str(path)), str(path), whole)
    _refuse_one_column(layout, path)
    notes = {"left out": Finding(kind="left out", text=left)} if left else {}
    read = partial(_read, path, notes)
    table = Table(
        source=str(path),
        units={name: unit_in(layout, name) for name in layout.names},
        read=partial(read, layout),
        attributes=_attributes(layout),
        notes=notes,
    )
    return wide(table, layout, read)


def unit_in(layout: Layout, name: str) -> str | None:
    """The unit of a column: of times that are written out, or as the line below the header says."""
    return _UNITS.get(layout.kind(name), layout.units.get(name))


def _refuse_one_column(layout: Layout, path: Path) -> None:
    for sign, name in ((",", "comma"), (";", "semicolon"), ("\t", "tab"), ("|", "|")):
        if len(layout.names) == 1 and (more := layout.header.count(sign)):
            raise InputError(
                f"{path}: the header splits into {more + 1} names at each {name}, but the rows do not; "
                "use one delimiter throughout"
            )


def wide(
    table: Table, layout: Layout, read: Callable[[Layout, tuple[str, ...]], Iterator[tuple[Values, ...]]]
) -> Table:
    """A table of a row for each number, beside which its topic stands, as one with a column for each topic,
    whose rows still hold one number; another table as it is."""
    *labels, value = columns_of_topics(layout.names) or ("",)
    labels = [n for n in labels if layout.kind(n) == "text" or all(map(str.isdecimal, layout.fields(n)))]
    layout = replace(layout, words=(*labels, value))
    found = read(layout, tuple(labels)) if labels else ()
    topics = Counter(topic for columns in found for topic in _topics(columns))
    if len(topics) < 2:
        return table
    others = {name: unit for name, unit in table.units.items() if name not in layout.words}
    decimal = decimal_of(layout.fields(value)) or layout.decimal

    def pivoted(names: tuple[str, ...]) -> Iterator[tuple[Values, ...]]:
        stamps = tuple(name for name in names if name in others)
        wanted = [name for name in names if name not in others]
        if wanted and (left := topics.total() - sum(topics[topic] for topic in wanted)):
            text = f"a row for each number, by {listed(labels)}: {left} of other topics are left out"
            table.notes["topics"] = Finding(kind="topics left out", text=text, samples=left)
        for columns in read(layout, (*stamps, *layout.words)):
            given = dict(zip(stamps, columns, strict=False))
            of_row = np.array(_topics(columns[len(stamps) : -1]))
            for topic in wanted:
                found = [number(text or "", decimal) for text in columns[-1][of_row == topic]]
                if None in found:
                    raise InputError(f'{table.source}: "{topic}" holds text; only numbers are read')
                given[topic] = np.full(of_row.size, np.nan)
                given[topic][of_row == topic] = found
            kept = np.isin(of_row, wanted or list(topics))
            yield tuple(given[name][kept] for name in names)

    return replace(table, units={**dict.fromkeys(topics), **others}, read=pivoted)


def _topics(columns: tuple[Values, ...]) -> list[str]:
    """What each row names, in one column or in several."""
    return [".".join(filter(None, parts)) for parts in zip(*columns, strict=True)]


def _attributes(layout: Layout) -> dict[str, Any]:
    try:
        found = json.loads(next((line[2:] for line in layout.comments if line.startswith("# {")), "{}"))
    except ValueError:
        return {}
    return found if isinstance(found, dict) else {}


def _read(
    path: Path, notes: dict[str, Finding], layout: Layout, names: tuple[str, ...]
) -> Iterator[tuple[Values, ...]]:
    parser = Parser(str(path), layout, names)
    with opened_text(path) as file:
        rest, above = b"", layout.skipped
        while piece := file.read(_PIECE):
            if above:
                piece, above = piece.split(b"\n", above)[-1], 0
            end = piece.rfind(b"\n") + 1
            if end == 0 and len(rest) + len(piece) > 2 * _PIECE:
                if not piece.strip(b"\0"):
                    break
                raise InputError(f"{path} has a line of more than {_PIECE >> 20} MB; it is no table")
            lines, rest = rest + piece[:end], piece[end:] if end else rest + piece
            if b"\0" in lines:
                rest = lines[lines.index(b"\0") :]
                lines = lines[: len(lines) - len(rest)]
                lines = lines[: lines.rfind(b"\n") + 1]
                yield from parser.parse(lines)
                break
            yield from parser.parse(lines)
    if rest.strip(b"\0 \r\n"):
        parser.unfinished = True
    if b"\0" in rest or (not rest.strip(b"\0") and rest):
        notes["zeros"] = Finding(kind="zeros", text="the file ends in zero bytes: its end was never written")
    parser.report(notes)


class Parser:
    """Parses whole lines, and counts what it had to leave out."""

    def __init__(self, source: str, layout: Layout, names: tuple[str, ...]) -> None:
        self.source, self.layout, self.names = source, layout, names
        self.rows = self.broken = self.headers = 0
        self.unfinished = False
        letters = re.sub(r"[^a-zA-Z]|[eEdDnNaAiIfF]", "", layout.header)
        self._letter = letters[:1].encode()  # in the header, and in no number
        for name in names:
            if layout.kind(name) == "text":
                raise InputError(f'{source}: column "{name}" holds text, such as "{self._example(name)}"')
        self._mending = 0  # 1: rows of another length and empty cells; 2: words for no number, too
        self._by_cells = not _TYPES.keys() >= set(map(layout.kind, names))
        self._decimal = {name: decimal_of(layout.fields(name)) or layout.decimal for name in names}
        self._last = dict.fromkeys(names, float("nan"))
        self.notes: list[str] = []

    def parse(self, lines: bytes) -> Iterator[tuple[Values, ...]]:
        cleaned = self._cleaned(lines)
        if cleaned.strip():
            part = self._quickly(cleaned)
            if part is None:
                self._by_cells = True
                part = self._cell_by_cell(cleaned.decode())
            if self.broken > 20 and self.broken > _MOST_BROKEN * (self.rows + self.broken):
                raise InputError(
                    f"{self.source}: {self.broken} of {self.rows + self.broken} rows have another number of "
                    f"columns than {len(self.layout.names)}; it is no table"
                )
            start, step = self.layout.counted or (0.0, 1.0)
            count = self.layout.names[0] if self.layout.counted else None
            named = zip(self.names, part, strict=True)
            yield tuple(start + step * v if name == count else v for name, v in named)

    def _quickly(self, lines: bytes) -> tuple[Values, ...] | None:
        """None where a cell is not written as the quick reader has it."""
        if self._by_cells:
            return None
        broken = self.broken
        with warnings.catch_warnings():
            warnings.simplefilter("error")  # numpy warns of a number that it guessed
            for mending in range(self._mending, 3):  # what was enough for the lines before, or more
                self._mending, self.broken = mending, broken
                try:
                    columns = self._parsed(self._even(lines) if self._mending else lines)
                except (ValueError, Warning):
                    continue
                self.rows += columns[self.names[0]].size
                return tuple(columns[name] for name in self.names)
        self.broken = broken
        return None

    def report(self, notes: dict[str, Finding]) -> None:
        if self.unfinished:
            text = "the last line has no end, it may be cut off; it is left out"
            notes["unfinished"] = Finding(kind="unfinished", text=text, samples=1)
        if self.broken:
            columns = len(self.layout.names)
            text = f"{self.broken} rows have another number of columns than {columns}; they are left out"
            notes["broken"] = Finding(kind="broken rows", text=text, samples=self.broken)
        if self.notes:
            lines = "1 line" if len(self.notes) == 1 else f"{len(self.notes)} lines"
            text = f'{lines} of text below the table left out: "{self.notes[0]}"'
            notes["text"] = Finding(kind="text", text=text)
        if self.headers:
            text = (
                f"the header stands in the rows again, {self.headers} ×: files were put one after the other"
            )
            notes["headers"] = Finding(kind="headers", text=text)

    def _even(self, lines: bytes) -> bytes:
        """The rows with as many fields as there are names; the others are counted, empty ones are not."""
        delimiter, signs = self.layout.delimiter.encode(), len(self.layout.names) - 1
        data = np.frombuffer(lines, np.uint8)
        ends, found = np.flatnonzero(data == ord("\n")), np.flatnonzero(data == ord(delimiter))
        if b'"' in lines and (np.searchsorted(np.flatnonzero(data == ord('"')), found) % 2).any():
            raise ValueError("a delimiter stands in quotes")
        kept, since = [], 0
        for k in np.flatnonzero(np.diff(np.searchsorted(found, ends), prepend=0) != signs):
            begin, end = int(ends[k - 1]) + 1 if k else 0, int(ends[k]) + 1
            self.broken += bool(lines[begin:end].strip(b" \r\n"))
            kept.append(lines[since:begin])
            since = end
        return b"".join([*kept, lines[since:]])

    def _parsed(self, lines: bytes) -> dict[str, Values]:
        """The columns; an error where a row has another number of fields, or a cell is not plain."""
        layout = self.layout
        if layout.delimiter == layout.decimal or lines.count(b"\r") > lines.count(b"\r\n"):
            raise ValueError("it is not clear what a field or a row is")
        if b'"' in lines and any(line.count(b'"') % 2 for line in lines.split(b"\n")):
            raise ValueError("quotes go on in the next line")
        columns: dict[str, Values] = {}
        for kind in dict.fromkeys(map(layout.kind, self.names)):
            names = [name for name in dict.fromkeys(self.names) if layout.kind(name) == kind]
            columns |= self._loaded(self._numbers(lines) if kind == "float" else lines, names, kind)
        if len({values.size for values in columns.values()}) > 1:
            raise ValueError("it is not clear what a row is")
        return columns

    def _numbers(self, lines: bytes) -> bytes:
        """The same with the decimal point, and NaN where a number is missing."""
        if self.layout.decimal == ",":
            lines = lines.translate(_SWAPPED)  # a point groups there, and becomes what is refused
        if not self._mending or len(self.layout.names) == 1:
            return lines
        sign, lines = self.layout.delimiter.encode(), b"\n" + lines
        if self._mending == 2:
            pattern = rb"([\n%b])" + _NULLS + rb"(?=[%b\r\n])"
            lines = re.sub(pattern % (re.escape(sign), re.escape(sign)), rb"\1", lines)
        for one, other in ((sign, sign), (sign, sign), (sign, b"\r\n"), (sign, b"\n"), (b"\n", sign)):
            lines = lines.replace(one + other, one + b"nan" + other)
        return lines

    def _loaded(self, lines: bytes, names: list[str], kind: str) -> dict[str, Values]:
        layout = self.layout
        table: Values = np.loadtxt(
            TextIOWrapper(BytesIO(lines), encoding="utf-8"),
            # with a type for every column, numpy refuses a row that has more or fewer
            dtype=[(f"{k}", _TYPES[kind] if n in names else "U1") for k, n in enumerate(layout.names)],
            delimiter=layout.delimiter,
            quotechar='"' if b'"' in lines else None,
            comments=None,
            ndmin=1,
        )
        found = {name: np.ascontiguousarray(table[f"{layout.names.index(name)}"]) for name in names}
        sign = re.escape(layout.delimiter.encode())
        for name in names if kind == "date" else ():  # numpy takes more for one: "now", zones, years alone
            before = rb"(?m)^(?:[^\n" + sign + rb"]*" + sign + rb"){%d} *(?:" % layout.names.index(name)
            dates = re.findall(before + _INSTANT + rb")? *(?:" + sign + rb"|\r?\n)", lines)
            if len(dates) != table.size:
                raise ValueError("a date is not written plainly")
        if kind == "words":
            return {name: np.frompyfunc(str.strip, 1, 1)(values) for name, values in found.items()}
        return found

    def _cleaned(self, lines: bytes) -> bytes:
        """Without comments, repeated headers and, where white space separates, more than one of it."""
        lines = plain_lines(lines)
        for sign in (b"#", b"%", b"//"):
            if sign[:1] in lines:  # one byte is searched for far quicker than two
                lines = re.sub(rb"(?m)^" + sign + rb"[^\n]*\n?", b"", lines)
        if self.layout.header.startswith(LABVIEW):  # which may write its head again for each segment
            lines = re.sub(rb"(?m)^(?:(?!X_Value|NaN|Inf)[A-Z*][^\n]*|[\t\r]*)\n", b"", lines)
        if self._letter and self._letter in lines:
            pattern = rb"(?m)^" + re.escape(self.layout.header.encode()) + rb"\r?\n"
            lines, count = re.subn(pattern, b"", lines)
            self.headers += count
        if self.layout.delimiter == " ":
            lines = re.sub(rb"[ \t]+", b" ", lines)
            lines = re.sub(rb"(?m)^ | ?\r?$", b"", lines)
        return lines

    def _example(self, name: str) -> str:
        fields = self.layout.fields(name)
        return next((field for field in fields if not (is_number(field) or is_nothing(field))), "")[:40]

    # Rows of a spreadsheet cell by cell, where they are not written plainly enough for the quick reader.
    #
    # Thousands in groups, columns with different decimal signs, times of day, dates as people write them,
    # words for a missing number, lines of text below the table.  One between numbers is refused: nobody knows
    # what it was.

    def _cell_by_cell(self, lines: str) -> tuple[Values, ...]:
        rows, before = [], self.layout.skipped + self.rows + self.broken
        for k, line in enumerate(lines.splitlines()):
            if not line.strip() or is_comment(line):
                continue
            fields = self._fitted(split(line, self.layout.delimiter))
            if fields is None:
                self.broken += 1
            else:
                rows.append((before + k + 1, fields))
        wanted = [self.layout.names.index(name) for name in self.names]
        columns = [
            self._column(name, [fields[k] for _, fields in rows])
            for name, k in zip(self.names, wanted, strict=True)
        ]
        end = self._end(rows, columns, wanted)
        self.rows += end
        self.notes += [" ".join(filter(None, fields))[:60] for _, fields in rows[end:] if any(fields)]
        return tuple(self._values(n, column[:end]) for n, column in zip(self.names, columns, strict=True))

    def _fitted(self, fields: list[str]) -> list[str] | None:
        """As many as there are names: empty ones at the end do not count."""
        count = len(self.layout.names)
        if len(fields) > count and not any(fields[count:]):
            return fields[:count]
        return fields if len(fields) == count else None

    def _column(self, name: str, fields: list[str]) -> list[object]:
        """What each cell says; None where it is something else."""
        kind = self.layout.kind(name)
        if kind == "words":
            return list(fields)
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
        if kind in ("calendar", "date", "words"):
            return np.array(column, dtype=object if kind == "words" else "datetime64[ns]")
        values = np.array(column, dtype=float)
        if kind == "clock" and values.size:
            values = past_midnight(values, self._last[name])
            self._last[name] = float(values[-1])
        return values
