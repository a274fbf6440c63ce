"""Lines that say of each number what it is, as rows under names: JSON lines, and what serial plotters take.

    {"time_ms": 0, "position": {"mm": 1.2}}     time_ms:0,position_mm:1.2     time_ms = 0  position_mm = 1.2

The names are those of the first lines.  A line with another name, or that is no such line, becomes a row with
too many fields, and is counted with the broken ones.
"""

from __future__ import annotations

import csv
import json
import re
from contextlib import AbstractContextManager
from io import StringIO
from typing import Any

_PAIR = re.compile(r"([^\W\d][^:=,;\t|]*)[:=]\s*([^\s:=,;|]+)(?:[,;|\s]+|$)")
_NUMBER = re.compile(r"[+-]?\.?\d")
_JSON = json.JSONDecoder(parse_float=str, parse_int=str, parse_constant=str)
_LOOKED_AT = 100
"""Lines at the start, by which it is judged."""


def record_of(line: str) -> dict[str, str] | None:
    """What a line says by name; None where it is another line."""
    bare = line.strip().lstrip("\ufeff[").rstrip(",]")  # an array may be written an object a line
    if bare.startswith("{"):
        said: dict[str, str] = {}
        try:
            _flatten("", _JSON.decode(bare), said)
        except (ValueError, RecursionError):
            return None
        return said
    parts = _PAIR.split(bare)
    if any(parts[::3]) or not any(map(_NUMBER.match, parts[2::3])):
        return None
    return dict(zip(map(str.strip, parts[1::3]), parts[2::3], strict=True))


def _flatten(name: str, value: Any, said: dict[str, str]) -> None:
    """Every number and text of an object of JSON, by its path."""
    if isinstance(value, dict):
        for key, inner in value.items():
            _flatten(f"{name}.{key}" if name else key, inner, said)
    elif isinstance(value, list):
        for k, inner in enumerate(value):
            _flatten(f"{name}[{k}]", inner, said)
    else:
        said[name] = "" if value is None else str(value)


def names_of_records(start: str) -> list[str]:
    """The names in lines of records; none where the lines at the start of a file are others."""
    if ":" not in start and "=" not in start:  # as in most tables
        return []
    lines = [line for line in start.splitlines()[:-1] if line.strip()]
    first = [said for line in lines[:_LOOKED_AT] if (said := record_of(line))]
    alike = len({tuple(said) for said in first})
    if len(first) < 2 or len(first) < 0.8 * len(lines[:_LOOKED_AT]) or 2 * alike > len(first):
        return []
    return list(dict.fromkeys(name for line in lines for name in record_of(line) or ()))


class Records(AbstractContextManager["Records"]):
    """A file of records, read as a table under their names with commas between the fields."""

    def __init__(self, file: Any, names: list[str]) -> None:
        self._file, self._names, self._head, self._rest = file, names, [names], b""

    def __exit__(self, *_: object) -> None:
        self._file.close()

    def read(self, size: int) -> bytes:
        """Some whole lines, whatever the size; none at the end."""
        while piece := self._file.read(max(size, 2**16)):
            lines, end, self._rest = (self._rest + piece).rpartition(b"\n")
            if end:
                return self._rows(lines) + b"\n"
            if len(self._rest) > 2**24:
                return self._rest  # no line of a table, which the reader says
        lines, self._rest = self._rest, b""
        return self._rows(lines) if lines else b""

    def _rows(self, lines: bytes) -> bytes:
        rows, self._head = self._head, []
        for line in filter(str.strip, lines.decode("utf-8", "replace").splitlines()):
            said = record_of(line) or {line: ""}
            row = [said.pop(name, "") for name in self._names]
            rows.append([*row, *said])  # what is left of it breaks the row
        text = StringIO()
        csv.writer(text, lineterminator="\n").writerows(rows)
        return text.getvalue().rstrip("\n").encode()
