"""How a text is laid out: its delimiter, its decimal sign, its header, and where the numbers begin.

The numbers begin at the first of the lines that all split into as many numbers.
What stands above is a header, a line of units below it, or a preamble.
"""

from __future__ import annotations

import csv
import re
from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Literal, NamedTuple

from zwidth.data.logs.cells import are_plain, decimal_of, is_clock, is_date, is_nothing, is_number
from zwidth.data.logs.columns import is_unit
from zwidth.errors import InputError

_DELIMITERS = (",", ";", "\t", "|", " ")
_COMMENTS = ("#", "%", "//")
MOST_SAMPLED = 2000
"""Rows at the start by which it is judged how numbers are written."""

_DATE = re.compile(r"\d{4}-\d\d-\d\d[T ]\d\d:\d\d")
_NUMBER_AND_UNIT = re.compile(r"[+-]?\d[\d.,]*\s*[^\W\d_]+\Z")

Sample = tuple[tuple[str, ...], ...]
"""The first rows of numbers, split."""

Kind = Literal["float", "int", "date", "calendar", "clock", "text", "words"]


@dataclass(frozen=True, kw_only=True)
class Layout:
    delimiter: str
    """One character; a space stands for any white space."""
    decimal: str
    """The decimal sign of columns that do not say it themselves."""
    names: tuple[str, ...]
    """Of the columns; "column 1" … where there is no header."""
    units: Mapping[str, str]
    """The unit of each column that a line below the header states."""
    skipped: int
    """Lines before the first numbers."""
    header: str
    """The line with the names, as it stands, or ""."""
    sample: Sample
    comments: tuple[str, ...]
    """Lines before the numbers that are comments."""
    counted: tuple[float, float] | None = None
    """[s] Where the first column counts samples: the time of number 0, and from one to the next."""
    words: tuple[str, ...] = ()
    """Columns that are read as they stand."""

    def kind(self, column: str) -> Kind:
        """What the first rows of a column hold; "int" is too long for a float, a "date" in ISO 8601."""
        return self._kinds[self.names.index(column)]

    @cached_property
    def _kinds(self) -> list[Kind]:
        return ["words" if name in self.words else _kind(self.fields(name)) for name in self.names]

    def fields(self, column: str) -> list[str]:
        return [row[self.names.index(column)] for row in self.sample]


def _kind(fields: list[str]) -> Kind:
    values = fields if are_plain(fields) else [field for field in fields if not is_nothing(field)]
    if not values:
        return "float"
    if all(_DATE.match(value) for value in values):
        return "date"
    if all(re.fullmatch(r"\d{16,19}", value) for value in values):
        return "int"
    if values is fields:
        return "float"
    shares: dict[Kind, int] = {
        "float": sum(map(is_number, values)),
        "clock": sum(map(is_clock, values)),
        "calendar": sum(map(is_date, values)),
    }
    kind = max(shares, key=lambda each: shares[each])
    return kind if 2 * shares[kind] > len(values) else "text"


_OF_A_BUS = re.compile(
    r"^\s*(?:\([^()]+\)\s+)?\w+\s+[0-9A-F]{3,8}(?:##?[0-9A-FR]|\s+\[\d+\]\s)"  # candump
    r"|^Time ?Stamp[,;]ID[,;]Extended|^timestamp,arbitration_id,"  # SavvyCAN, python-can
    r"|^;\$FILEVERSION=|^base (?:hex|dec)\s+timestamps ",  # PCAN-View, Vector
    re.MULTILINE,
)


@lru_cache(maxsize=2)
def layout_of(text: str, source: str, whole: bool) -> Layout:
    """The layout of a text that starts so; `whole` says that this is all of it. A file that is opened again,
    as to see first whether it holds two arms, is not looked at again."""
    lines = text.splitlines()
    if not whole and len(lines) > 1:
        lines = lines[:-1]  # the last is cut in the middle
    if not text.strip():
        raise InputError(f"{source} is empty: {len(text)} characters, none of them a number")
    if _OF_A_BUS.search(text[:4096]):
        raise InputError(
            f"{source} holds the frames of a CAN bus: the numbers stand in their bytes, and its DBC file, or "
            "its maker, says where; decode it to a table with a column for each signal, such as SavvyCAN "
            "writes by File, Save Decoded Frames"
        )
    rows = [(k, line) for k, line in enumerate(lines) if line.strip() and not is_comment(line)]
    found = _most_columns(lines, rows)
    if found.first < 0:
        raise InputError(f"{source} holds no table of numbers: {_why_none(lines)}")
    _refuse_rows_for_columns(found, len(rows), source)
    return laid_out(lines, found.delimiter, found.columns, found.first, found.sample, source)


def _most_columns(lines: list[str], rows: list[tuple[int, str]]) -> _Split:
    """The table by the delimiter that makes most columns of the rows."""
    bare = "\n".join(line for _, line in rows)
    dividing = [d for d in _DELIMITERS if (len(bare.split()) > len(rows) if d == " " else d in bare)]
    found = [_split_at(lines, rows, d) for d in dividing]
    if not any(table.columns > 1 for table in found):  # of the others every line is one field
        found += [_split_at(lines, rows, d) for d in _DELIMITERS if d not in dividing]
    return max(found, key=lambda table: (table.columns, -_DELIMITERS.index(table.delimiter)))


def split(line: str, delimiter: str) -> list[str]:
    if delimiter == " ":
        return line.split()
    if '"' in line:
        try:
            found = next(csv.reader([line], delimiter=delimiter, skipinitialspace=True), [])
        except csv.Error:
            found = line.split(delimiter)
        return [field.strip().strip('"') for field in found]
    return [field.strip() for field in line.split(delimiter)]


def is_comment(line: str) -> bool:
    return line.lstrip().startswith(_COMMENTS)


def _why_none(lines: list[str]) -> str:
    with_unit = next((f for line in lines for f in split(line, ",") if _NUMBER_AND_UNIT.match(f)), None)
    if with_unit is not None:
        return f'cells such as "{with_unit[:40]}" hold a unit; write it once, in the header: "force [N]"'
    return "no line splits into numbers at , ; tab | or space"


def _refuse_rows_for_columns(table: _Split, count: int, source: str) -> None:
    """A sheet in which each quantity is a row."""
    if table.columns <= 3 * count or count > 8:
        return
    if sum(_is_text(row[0]) for row in table.rows if len(row) == table.columns) == count:
        raise InputError(
            f"{source} has {count} rows of {table.columns} fields, each with a name: the quantities are its "
            "rows; transpose the sheet, so that each is a column with its name above it"
        )


def _is_text(field: str) -> bool:
    return not (is_value(field) or is_nothing(field))


def is_value(field: str) -> bool:
    """True where a cell is a number, a time of day or a date."""
    return is_number(field) or is_clock(field) or is_date(field) or bool(_DATE.match(field))


def _numeric(fields: list[str]) -> bool:
    """A row of a table: numbers stand in it, and text is rare."""
    if are_plain(fields):
        return bool(fields)
    values = sum(map(is_value, fields))
    return values > 0 and 2 * (values + sum(map(is_nothing, fields))) > len(fields)


_LABELS = "topic name signal channel variable series key field metric label parameter"


def columns_of_topics(names: Iterable[str]) -> tuple[str, ...]:
    """Where each row holds one number, the columns that say which, and last that of the number; else none."""
    bare = {name.strip("_ ").lower(): name for name in names}
    labels = [bare[word] for word in _LABELS.split() if word in bare]
    return (*labels, bare["value"]) if labels and "value" in bare else ()


class _Split(NamedTuple):
    """A text whose lines are split: how many columns of numbers that makes (0: none), from which line on
    (−1: none), all its rows, and the first ones of numbers."""

    delimiter: str
    columns: int
    first: int
    rows: list[list[str]]
    sample: Sample = ()


def _split_at(lines: list[str], rows: list[tuple[int, str]], delimiter: str) -> _Split:
    """Of the lines those that are rows, each with its number, split at a delimiter."""
    found = [split(line, delimiter) for _, line in rows]
    none = _Split(delimiter, 0, -1, found)
    long = bool(columns_of_topics(found[0]))
    numeric = [_numeric(fields) or (long and k > 0) for k, fields in enumerate(found)]
    sizes = [len(fields) for fields, good in zip(found, numeric, strict=True) if good]
    if not sizes:
        return none
    common = max(set(sizes), key=sizes.count)
    fits = [good and len(fields) == common for fields, good in zip(found, numeric, strict=True)]
    start = _start(found, fits)
    if sum(fits[start:]) < 0.8 * len(fits[start:]):
        return none
    first = rows[start][0]
    if delimiter == "," and any(sign in line for line in lines[first : first + 9] for sign in ";\t"):
        return none  # the comma is the decimal sign
    sample = (
        tuple(fields)
        for (k, _), fields, good in zip(rows[start:], found[start:], fits[start:], strict=True)
        if good and k < first + MOST_SAMPLED
    )
    return _Split(delimiter, common, first, found, tuple(sample))


def _start(found: list[list[str]], fits: list[bool]) -> int:
    """The first row of numbers; one that begins with a word, where most begin with a number, is a setting, or
    names and units beside which somebody typed numbers, if words of names stand in it or below it."""
    rows = [k for k, good in enumerate(fits) if good]
    first = [found[k][0] for k in rows]
    if are_plain(first) or 2 * sum(map(is_value, first)) <= len(rows):
        return rows[0]
    above = range(rows[list(map(_is_text, first)).index(False)])
    names = [k for k in above if sum(map(_is_text, found[k])) > 1]
    return next(k for k in rows if k > max(names, default=-1))


def sample_of(lines: list[str], delimiter: str, columns: int, first: int) -> Sample:
    """The first rows of numbers, of lines of which it is known how they split and where the numbers begin."""
    body = [
        split(line, delimiter)
        for line in lines[first : first + MOST_SAMPLED]
        if line.strip() and not is_comment(line)
    ]
    return tuple(tuple(fields) for fields in body if len(fields) == columns and _numeric(fields))


def laid_out(
    lines: list[str], delimiter: str, columns: int, first: int, sample: Sample, source: str
) -> Layout:
    """The layout of lines of which it is known how they split, where numbers begin, and the first rows."""
    above = [line for line in lines[:first] if line.strip()]
    comments = tuple(line.strip() for line in above if is_comment(line))
    plain = [line for line in above if not is_comment(line)]
    filled = [any(row[k] for row in sample) for k in range(columns)]
    counted = _counted(plain, delimiter)
    header, names, units_line = _header(plain, comments, delimiter, filled)
    names = ["time", *names[1:]] if counted else names
    if not header and delimiter == ",":
        _refuse_two_commas(plain, columns, source)
    names = _distinct([name or f"column {k + 1}" for k, name in enumerate(names or [""] * columns)])
    units = {n: u.strip("[]() ") for n, u in zip(names, units_line, strict=False) if u.strip("[]() -")}
    units |= {"time": "s"} if counted else {}
    fields = [field for row in sample for field in row]
    commas = delimiter != "," and any("," in field for field in fields)
    return Layout(
        delimiter=delimiter,
        decimal=decimal_of(fields) or ("," if commas else "."),
        names=tuple(names),
        units=units,
        skipped=lines.index(header) + 1 if header.startswith(LABVIEW) else first,  # rows with comments count
        header=header if header in plain else "",
        sample=sample,
        comments=comments,
        counted=counted,
    )


def _counted(plain: list[str], delimiter: str) -> tuple[float, float] | None:
    """As of `Layout`: oscilloscopes of Rigol write both behind the names and the units, which are left."""
    names, below = ([split(line, delimiter) for line in plain[-2:]] + [[], []])[:2]
    said = dict(zip(names, below, strict=False))
    if not {"Start", "Increment"} <= said.keys() or not are_plain((said["Start"], said["Increment"])):
        return None
    known = [unit if is_unit(unit) else "" for unit in below[: names.index("Start")]]
    plain[-2:] = [delimiter.join(names[: len(known)]), *[delimiter.join(known)] * any(known)]
    return float(said["Start"]), float(said["Increment"])


def _refuse_two_commas(plain: list[str], columns: int, source: str) -> None:
    if any(2 * len(split(line, ",")) == columns for line in plain[-2:]):
        raise InputError(
            f"{source}: the header has {columns // 2} names and each row {columns} fields: the comma is the "
            "decimal sign and stands between the columns as well; save the sheet with semicolons, or with "
            "decimal points"
        )


def _header(
    plain: list[str], comments: tuple[str, ...], delimiter: str, filled: list[bool]
) -> tuple[str, list[str], list[str]]:
    """The line with the names, its fields, and the fields of the line of units below it. A number above a
    column in which nothing stands is a note. Delimiters that end each row may be missing."""
    if head := next((line for line in reversed(plain) if line.startswith(LABVIEW + delimiter)), ""):
        return _of_labview(head, plain, delimiter, filled)
    columns = len(filled)
    fewest = columns - filled[::-1].index(True) if any(filled) else 0

    def fields_of(line: str) -> list[str] | None:
        for fields in _ways_to_split(line, delimiter):
            bare = fields[:columns] if not any(fields[columns:]) else fields
            if fewest <= len(bare) <= columns:
                bare = bare + [""] * (columns - len(bare))
                return ["" if is_value(f) and not k else f for f, k in zip(bare, filled, strict=True)]
        return None

    if plain and (below := fields_of(plain[-1])) is not None:
        names = fields_of(plain[-2]) if len(plain) > 1 else None
        if names is not None and (units := _units(below, names)):
            return plain[-2], names, units
        return plain[-1], below, []
    for other in _DELIMITERS[:-1]:
        if plain and len(split(plain[-1], other)) == columns > 1:
            return plain[-1], split(plain[-1], other), []
    for line in reversed(comments):
        found = fields_of(line.lstrip("#%/ "))
        if found is not None and not line.startswith("# {"):
            return line, found, []
    return "", [], []


LABVIEW = "X_Value"
"""How the names in a LabVIEW measurement begin."""


def _of_labview(
    head: str, plain: list[str], delimiter: str, filled: list[bool]
) -> tuple[str, list[str], list[str]]:
    """The same of a measurement that LabVIEW wrote: units stand above the names by the word Y_Unit_Label, and
    Comment is a name where no row has a comment."""
    said = {(fields := split(line, delimiter))[0]: fields[1:] for line in plain}
    labels = iter(said.get("Y_Unit_Label", []))
    of_x = "s" if "Time" in said.get("X_Dimension", ["Time"]) else ""
    names = [*split(head, delimiter), *[""] * len(filled)][: len(filled)]
    units = [
        (of_x if full else "") if name == LABVIEW else next(labels, "")
        for name, full in zip(names, filled, strict=True)
    ]
    return head, names, [unit if is_unit(unit) else "" for unit in units]


def _units(below: list[str], names: list[str]) -> list[str]:
    """Of the line above the numbers, if it holds nothing else; the first may be a word, "Sequence", where
    each has its name above."""
    known = [is_unit(field.strip("[]() -")) for field in below]
    if not (any(below) and all(known[1:])):
        return []
    if known[0]:
        return below
    named = all(name or not field for name, field in zip(names, below, strict=True))
    return ["", *below[1:]] if named and any(below[1:]) else []


def _ways_to_split(line: str, delimiter: str) -> list[list[str]]:
    """Where white space separates, names may hold some: before a bracket, or one space of several."""
    if delimiter != " ":
        return [split(line, delimiter)]
    bare = line.strip()
    return [bare.split(), re.split(r"\s+(?![\[(])", bare), re.split(r"\t+|\s{2,}", bare)]


def _distinct(names: list[str]) -> list[str]:
    seen: Counter[str] = Counter()
    result = []
    for name in names:
        seen[name] += 1
        result.append(name if seen[name] == 1 else f"{name} ({seen[name]})")
    return result
