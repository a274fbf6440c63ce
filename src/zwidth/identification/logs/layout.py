"""How a text is laid out: its delimiter, its decimal sign, its header, and where the numbers begin.

The numbers begin at the first of the lines that all split into as many numbers.
What stands above is a header, a line of units below it, or a preamble.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass

from zwidth.errors import InputError
from zwidth.identification.logs.scales import is_unit

SNIFFED = 2**16
"""[bytes] at the start of a file that its layout is read from."""

_DELIMITERS = (",", ";", "\t", "|", " ")
_COMMENTS = ("#", "%", "//")
_NUMBER = re.compile(r"[+-]?(?:\d+[.,]?\d*|[.,]\d+)(?:[eEdD][+-]?\d+)?\Z")
_NOTHING = {
    "",
    "nan",
    "-nan",
    "inf",
    "-inf",
    "+inf",
    "infinity",
    "-infinity",
    "null",
    "none",
    "na",
    "n/a",
    "#n/a",
    "-",
    "true",
    "false",
}
_DATE = re.compile(r"\d{4}-\d\d-\d\d[T ]\d\d:\d\d")
_BYTES = re.compile(r"[\x00-\x08\x0e-\x1a\x1c-\x1f]")


@dataclass(frozen=True, kw_only=True)
class Layout:
    """The layout of a text.

    Parameters
    ----------
    delimiter
        One character; a space stands for any white space.
    comma
        The decimal sign is a comma.
    names
        Of the columns; "column 1" … where there is no header.
    units
        The unit of each column that a line below the header states.
    skipped
        Lines before the first numbers.
    header
        The line with the names, as it stands, or "".
    sample
        The first rows, split.
    comments
        Lines before the numbers that are comments.
    """

    delimiter: str
    comma: bool
    names: tuple[str, ...]
    units: Mapping[str, str]
    skipped: int
    header: str
    sample: tuple[tuple[str, ...], ...]
    comments: tuple[str, ...]

    def kind(self, column: str) -> str:
        """What the first rows of a column hold: "float", "int" too long for a float, "date" or "text"."""
        values = [row[self.names.index(column)].strip().strip('"') for row in self.sample]
        if all(_DATE.match(value) for value in values):
            return "date"
        if all(re.fullmatch(r"\d{16,19}", value) for value in values):
            return "int"
        return "float" if all(_is_number(value) for value in values) else "text"


def layout_of(start: bytes, source: str, whole: bool) -> Layout:
    """The layout of a text that starts so; `whole` says that this is all of it."""
    text = _decoded(start, source)
    lines = text.splitlines()
    if not whole and len(lines) > 1:
        lines = lines[:-1]  # the last is cut in the middle
    if not text.strip():
        raise InputError(f"{source} is empty: {len(start)} bytes, none of them a number")
    ranked = sorted((_ranked(lines, d) for d in _DELIMITERS), key=lambda found: found[:2], reverse=True)
    columns, _, delimiter, first = ranked[0]
    if first < 0:
        raise InputError(
            f"{source} holds no table of numbers: no line splits into numbers at , ; tab | or space"
        )
    return _layout(lines, delimiter, columns, first)


def _decoded(start: bytes, source: str) -> str:
    if start[:2] in (b"\xff\xfe", b"\xfe\xff"):
        raise InputError(f"{source} is UTF-16 text; save it as UTF-8")
    try:
        text = start.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        last = error.start >= len(start) - 4 and error.reason == "unexpected end of data"
        text = start[: error.start].decode("utf-8-sig") if last else start.decode("latin-1")
    odd = len(_BYTES.findall(text[:4096]))
    if odd:
        raise InputError(f"{source} is no text: its first bytes hold control characters; which format is it?")
    return text


def _split(line: str, delimiter: str) -> list[str]:
    if delimiter == " ":
        return line.split()
    return [field.strip().strip('"') for field in line.split(delimiter)]


def _is_number(field: str) -> bool:
    return bool(_NUMBER.match(field)) or field.lower() in _NOTHING


def _is_value(field: str) -> bool:
    return _is_number(field) or bool(_DATE.match(field))


def _numeric(fields: list[str]) -> bool:
    """A row of a table: it begins or goes on with numbers, and text is rare in it."""
    values = sum(map(_is_value, fields))
    return any(_NUMBER.match(f) or _DATE.match(f) for f in fields) and values * 2 > len(fields)


def _ranked(lines: list[str], delimiter: str) -> tuple[int, int, str, int]:
    """Columns, preference, delimiter and first line of numbers (−1: none) if the lines are split so."""
    rows = [
        (k, _split(line, delimiter)) for k, line in enumerate(lines) if line.strip() and not _comment(line)
    ]
    numeric = [(k, fields) for k, fields in rows if _numeric(fields)]
    preference = -_DELIMITERS.index(delimiter)
    if not numeric:
        return 0, preference, delimiter, -1
    sizes = [len(fields) for _, fields in numeric]
    common = max(set(sizes), key=sizes.count)
    first = next(k for k, fields in numeric if len(fields) == common)
    following = [fields for k, fields in rows if k >= first]
    good = sum(len(fields) == common and _numeric(fields) for fields in following)
    if good < 0.8 * len(following):
        return 0, preference, delimiter, -1
    if delimiter == "," and any(";" in line or "\t" in line for line in lines[first : first + 9]):
        return 0, preference, delimiter, -1  # the comma is the decimal sign
    return common, preference, delimiter, first


def _comment(line: str) -> bool:
    return line.lstrip().startswith(_COMMENTS)


def _layout(lines: list[str], delimiter: str, columns: int, first: int) -> Layout:
    above = [line for line in lines[:first] if line.strip()]
    comments = tuple(line.strip() for line in above if _comment(line))
    plain = [line for line in above if not _comment(line)]
    header, units_line = _header(plain, comments, delimiter, columns)
    names = _split(header.lstrip("#%/ "), delimiter) if header else []
    names = _distinct([name or f"column {k + 1}" for k, name in enumerate(names or [""] * columns)])
    units = {n: u.strip("[]() ") for n, u in zip(names, units_line, strict=False) if u.strip("[]() -")}
    body = [
        _split(line, delimiter) for line in lines[first : first + 200] if line.strip() and not _comment(line)
    ]
    sample = tuple(tuple(fields) for fields in body if len(fields) == columns and _numeric(fields))
    comma = delimiter != "," and any("," in field for fields in sample for field in fields)
    return Layout(
        delimiter=delimiter,
        comma=comma,
        names=tuple(names),
        units=units,
        skipped=first,
        header=header if header in plain else "",
        sample=sample,
        comments=comments,
    )


def _header(
    plain: list[str], comments: tuple[str, ...], delimiter: str, columns: int
) -> tuple[str, list[str]]:
    """The line with the names, and the fields of the line of units below it."""
    fitting = [line for line in plain if len(_split(line, delimiter)) == columns]
    below = _split(fitting[-1], delimiter) if fitting else []
    if (
        len(fitting) >= 2
        and plain[-2:] == fitting[-2:]
        and all(is_unit(field.strip("[]() -")) for field in below)
    ):
        return fitting[-2], below
    if fitting and fitting[-1] == plain[-1]:
        return fitting[-1], []
    for other in _DELIMITERS[:-1]:
        if plain and len(_split(plain[-1], other)) == columns > 1:
            return plain[-1].replace(other, delimiter), []
    for line in reversed(comments):
        if len(_split(line.lstrip("#%/ "), delimiter)) == columns and not line.startswith("# {"):
            return line, []
    return "", []


def _distinct(names: list[str]) -> list[str]:
    seen: Counter[str] = Counter()
    result = []
    for name in names:
        seen[name] += 1
        result.append(name if seen[name] == 1 else f"{name} ({seen[name]})")
    return result
