"""Lines that say of each number what it is, as rows under names: JSON lines, and what serial plotters take.

    {"time_ms": 0, "position": {"mm": 1.2}}     time_ms:0,position_mm:1.2     time_ms = 0  position_mm = 1.2

The names are those of the first lines.  A line with another name, or that is no such line, becomes a row with
too many fields, and is counted with the broken ones.  A monitor may have put the time before each line, named
or not, "12:34:56.789 -> 1.2 0.3"; and in JSON of one piece a list of objects is such lines.
"""

from __future__ import annotations

import csv
import json
import re
from collections.abc import Iterator
from contextlib import AbstractContextManager
from io import BytesIO, StringIO
from typing import Any

from zwidth.data.logs.table import listed
from zwidth.errors import InputError

_PAIR = re.compile(r"([^\W\d][^:=,;\t|]*)[:=]\s*([^\s:=,;|]+)(?:[,;|\s]+|$)")
_NUMBER = re.compile(r"[+-]?\.?\d")
_JSON = json.JSONDecoder(parse_float=str, parse_int=str, parse_constant=str)
_LOOKED_AT = 100
"""Lines at the start, by which it is judged."""

_MONITOR = re.compile(r"(?mi)^[ \t]*(\d+:\d+:\d+\.\d+) -?> ?(?=(?!nan|inf|ovf)([^\W\d])?)")
"""What the Arduino IDE and PlatformIO put before a line, and the letter of a name behind it."""


def record_of(line: str) -> dict[str, str] | None:
    """What a line says by name; None where it is another line."""
    stamp = _MONITOR.match(line)
    said = {"monitor": stamp[1]} if stamp else {}
    bare = _MONITOR.sub("", line).strip().lstrip("\ufeff[").rstrip(",]")  # of an array, an object a line
    if bare.startswith("{"):
        try:
            _flatten("", _JSON.decode(bare), said)
        except (ValueError, RecursionError):
            return None
        return said
    parts = _PAIR.split(bare)
    if any(parts[::3]) or not any(map(_NUMBER.match, parts[2::3])):
        return None
    return said | dict(zip(map(str.strip, parts[1::3]), parts[2::3], strict=True))


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


def sign_of_monitor(start: str) -> str:
    """What separates the fields behind the time of a monitor; "" where few lines have one."""
    lines = start.splitlines()[:_LOOKED_AT]
    rest = [line[stamp.end() :] for line in lines if (stamp := _MONITOR.match(line))]
    signs = [sign for sign in "\t;,|" if 2 * sum(sign in each for each in rest) > len(rest)]
    return (signs or [" "])[0] if 2 * len(rest) > len(lines) else ""


def _lists(name: str, value: Any) -> Iterator[tuple[str, list[Any]]]:
    """The lists of two objects or more in JSON, by their paths."""
    if isinstance(value, dict):
        for key, inner in value.items():
            yield from _lists(f"{name}.{key}".strip("."), inner)
    elif isinstance(value, list) and sum(isinstance(each, dict) for each in value) > 1:
        yield name, value


def records_in_json(text: str, source: str) -> Records | None:
    """The longest list of objects in JSON of one piece; None where there is none."""
    try:
        whole = _JSON.decode(text)
        lists = dict(_lists("", whole))
    except (ValueError, RecursionError) as error:
        raise InputError(f"{source} begins as JSON and is none: {error}; was it copied whole?") from None
    name = max(lists, key=lambda each: len(lists[each]), default="")
    lines = "\n".join(map(json.dumps, lists.get(name, ()))) + "\n\n"
    names = names_of_records(lines)
    paths = dict.fromkeys((*lists, *(whole if isinstance(whole, dict) else ())))
    left = [path for path in paths if not name.startswith(path)]
    said = f'of this JSON "{name}" is read; {listed(left)} left out' if left else ""
    return Records(BytesIO(lines.encode()), names, left_out=said) if names else None


class Records(AbstractContextManager["Records"]):
    """A file of records, read as a table under their names with commas between the fields; or, without names,
    of lines behind the time of a monitor, with a sign between it and the rest."""

    def __init__(self, file: Any, names: list[str], sign: str = "", left_out: str = "") -> None:
        self._file, self._names, self._head, self._rest = file, names, [names], b""
        self._sign, self.left_out = sign, left_out

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
        text = lines.decode("utf-8", "replace")
        if self._sign:
            return _MONITOR.sub(lambda m: ("monitor" if m[2] else m[1]) + self._sign, text).encode()
        rows, self._head = self._head, []
        for line in filter(str.strip, text.splitlines()):
            said = record_of(line) or {line: ""}
            row = [said.pop(name, "") for name in self._names]
            rows.append([*row, *said])  # what is left of it breaks the row
        table = StringIO()
        csv.writer(table, lineterminator="\n").writerows(rows)
        return table.getvalue().rstrip("\n").encode()
