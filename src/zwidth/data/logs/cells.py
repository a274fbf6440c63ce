"""The bytes of a text as UTF-8; and what a cell says: a number, a time of day, a date, or nothing.

A point or comma between digits is the decimal sign or groups thousands.  A cell says which where it has
both (the last is the decimal sign), the same one twice (it groups), or other than three digits after it, or
a leading zero (it is the decimal sign).  A column is written in one way; where none of its cells says which,
the others of the file do.
"""

from __future__ import annotations

import gzip
import re
from collections.abc import Iterable
from datetime import date
from io import BytesIO
from pathlib import Path
from typing import IO

import numpy as np

from zwidth.data.logs.records import Records, names_of_records, records_in_json, sign_of_monitor
from zwidth.errors import InputError
from zwidth.reading import LARGEST_CHUNK, Bounded, unpacking

_NOTHING = """
nan -nan null none na n/a #n/a n.a. n.a k.a. k.a #nv - -- --- — – . ? ?? * ** *** **** ***** ol
overload ovld overflow missing fehlt #div/0! #value! #wert! #ref! #bezug! #num! #zahl! 1.#ind
-1.#ind 1.#qnan
"""
NOTHING = frozenset(["", *_NOTHING.split()])
"""What stands where a number is missing, in small letters."""

_INFINITE = {"inf": np.inf, "+inf": np.inf, "-inf": -np.inf, "infinity": np.inf, "-infinity": -np.inf}
_TRUTH = {"true": 1.0, "false": 0.0}

_PLAIN = re.compile(r"[+-]?(?:\d+[.,]?\d*|[.,]\d+)(?:[eEdD][+-]?\d+)?\Z")
_GROUPED = re.compile(r"[+-]?\d{1,3}(?:(?P<sign>[.,'’ \u202f])\d{3})(?:(?P=sign)\d{3})*(?:[.,]\d*)?\Z")
_MAY_GROUP = re.compile(r"[+-]?[1-9]\d{0,2}[.,]\d{3}\Z")

_CLOCK = re.compile(r"(?:(\d{1,4}):)?(\d{1,3}):(\d{1,2})(?:[.,:](\d+))?\s*([AaPp][Mm])?\Z")
_DATE = re.compile(r"(\d{1,4})([-/.])(\d{1,2})\2(\d{2,4})[T ,;]\s*(\d{1,2}:\d{1,2}.*)\Z")
_ZONE = re.compile(r"\s*(?:Z|[+-]\d\d:?\d\d)\Z")
_DAY = 86400.0


def is_nothing(field: str) -> bool:
    return field.lower() in NOTHING


def is_number(field: str) -> bool:
    return bool(_PLAIN.match(field) or _GROUPED.match(field)) or field.lower() in _INFINITE | _TRUTH


def are_plain(fields: Iterable[str]) -> bool:
    """True where every cell is a number that no reader takes for anything else."""
    return all(map(_PLAIN.match, fields))


def is_clock(field: str) -> bool:
    """True where a cell is a time of day, or of a stop watch."""
    return clock(field) is not None


def is_date(field: str) -> bool:
    """True where a cell is a day with a time."""
    found = _DATE.match(field)
    return found is not None and clock(_ZONE.sub("", found[5]), of_day=True) is not None


def decimal_of(fields: Iterable[str]) -> str | None:
    """The decimal sign, where a cell says which it is."""
    for field in fields:
        marks = re.findall(r"[.,]", field)
        if not marks or _MAY_GROUP.match(field) or not is_number(field):
            continue
        if len(marks) > 1 and len(set(marks)) == 1:
            return "," if marks[0] == "." else "."
        return str(marks[-1])
    return None


def number(field: str, decimal: str) -> float | None:
    """The number in a cell, NaN where it says that there is none; None where it is something else."""
    if is_nothing(field):
        return float("nan")
    special = _INFINITE.get(field.lower(), _TRUTH.get(field.lower()))
    if special is not None:
        return special
    whole, sign, rest = field.partition(decimal)
    if _GROUPED.match(whole):
        whole = re.sub(r"[.,'’ \u202f]", "", whole)
    bare = whole + ("." if sign else "") + rest
    other = "," if decimal == "." else "."
    if other in whole + rest or not _PLAIN.match(bare):
        return None
    return float(re.sub("[dD]", "e", bare))


def clock(field: str, of_day: bool = False) -> float | None:
    """Seconds since midnight, or since a watch was started: 10:15:03.25, 10:15:03 PM, 15:03.25; None if it is
    none.  Of a day, 10:15 too; else it may be minutes and seconds, and is refused."""
    found = _CLOCK.match(field)
    if found is None:
        return None
    hours, minutes, seconds, fraction, half = found.groups()
    if hours is None and (of_day or half):
        hours, minutes, seconds = minutes, seconds, "0"
    elif hours is None and (fraction is None or field.count(":") > 1):
        return None
    if int(seconds) >= 60 or (hours is not None and int(minutes) >= 60):
        return None
    hour = int(hours or 0)
    if half:
        hour = hour % 12 + 12 * (half.lower() == "pm")
    return 3600.0 * hour + 60.0 * int(minutes) + int(seconds) + float(f"0.{fraction or 0}")


def stamps_of(fields: list[str]) -> list[np.datetime64 | None] | None:
    """The instants in a column of dates; None where day and month may be either and it matters."""
    found = [_DATE.match(field) for field in fields]
    days = {tuple(int(g) for g in f.group(1, 3, 4)) for f in found if f}
    either = any(f and f[2] != "." and len(f[1]) < 4 for f in found)
    month_first = _month_first(days) if either else False
    if month_first is None:
        return None
    return [_instant(f, month_first) if f else None for f in found]


def _month_first(days: set[tuple[int, ...]]) -> bool | None:
    """Of dates with slashes: by a number that is no month, or because all are one day."""
    if any(second > 12 for _, second, _ in days):
        return True
    if any(first > 12 for first, _, _ in days) or len(days) == 1:
        return False
    return None


def _instant(found: re.Match[str], month_first: bool) -> np.datetime64 | None:
    first, second, third = (int(found[k]) for k in (1, 3, 4))
    if len(found[1]) == 4:
        year, month, day = first, second, third
    else:
        day, month, year = (second, first, third) if month_first else (first, second, third)
    seconds = clock(_ZONE.sub("", found[5]), of_day=True)
    try:
        begin = date(year + 2000 * (year < 100), month, day)
    except ValueError:
        return None
    if seconds is None:
        return None
    return np.datetime64(begin, "ns") + np.timedelta64(round(seconds * 1e9), "ns")


def past_midnight(seconds: np.ndarray, last: float) -> np.ndarray:
    """Times of day that go on after midnight; `last` is the time before the first, NaN if there is none."""
    falls = np.diff(seconds, prepend=last) < -_DAY / 2
    return np.asarray(seconds + _DAY * np.cumsum(falls))


SNIFFED = 2**16
"""[bytes] at the start of a file by which it is judged."""

_CONTROL = re.compile(r"[\x00-\x08\x0e-\x1a\x1c-\x1f]")
_JSON = re.compile(r"\s*(\{\s*\"|\[\s*\{)")
_SIGNS = (("\u2212", "-"), ("\u00a0", " "), ("\u202f", " "), ("\ufeff", ""))
"""Signs that mean the same as those of ASCII: a minus, spaces, a mark at the start of a file."""


def opened_text(path: Path) -> IO[bytes] | Bounded | Records:
    """The bytes of a file: UTF-16, lines that end in a carriage return, and JSON are turned over whole, and
    lines that name each number, or begin with the time of a monitor, are rows of a table."""
    with _opened(path) as file:
        start = file.read(SNIFFED)
    text = _decoded(start)
    names, sign = names_of_records(text), sign_of_monitor(text)
    if names or sign:
        return Records(_opened(path), names, "" if names else sign)
    encoding = _wide(start)
    bare_returns = b"\r" in start and b"\n" not in start
    if encoding is None and not bare_returns and not _JSON.match(text):
        return _opened(path)
    with _opened(path) as file:
        whole = file.read(LARGEST_CHUNK + 1)
    if len(whole) > LARGEST_CHUNK:
        raise InputError(f"{path} is JSON, or text of an old kind, and large; save it as UTF-8 in lines")
    try:
        text = whole.decode(encoding) if encoding else _decoded(whole)
    except UnicodeDecodeError:
        text = whole.decode(encoding or "latin-1", "ignore")  # cut off in the middle of a letter
    if _JSON.match(text) and (records := records_in_json(text, str(path))):
        return records
    return BytesIO(text.replace("\r\n", "\n").replace("\r", "\n").encode())


def text_of(start: bytes, source: str) -> str:
    text = _decoded(start)
    if _CONTROL.search(text[:4096]):
        raise InputError(f"{source} is no text: its first bytes hold control characters; which format is it?")
    return plain_signs(text)


def plain_lines(lines: bytes) -> bytes:
    """UTF-8 with the signs of ASCII, of whole lines."""
    return lines if lines.isascii() else plain_signs(_decoded(lines)).encode()


def plain_signs(text: str) -> str:
    """The text with the signs of ASCII where another means the same."""
    for sign, plain in _SIGNS:
        text = text.replace(sign, plain)
    return text


def _opened(path: Path) -> IO[bytes] | Bounded:
    suffix = path.suffix.lower()
    if suffix == ".gz":
        return Bounded(path, gzip.open(path))
    if codec := {".bz2": "bz2", ".zst": "zstd"}.get(suffix):
        return Bounded(path, unpacking(path, codec))
    return open(path, "rb")


def _wide(start: bytes) -> str | None:
    """Which UTF-16 it is: by its mark, or because every other byte of a table in Latin letters is zero."""
    if start[:2] in (b"\xff\xfe", b"\xfe\xff"):
        return "utf-16"
    some = start[:4096]
    half = len(some) // 2
    zeros = [some[k::2].count(0) for k in (0, 1)]
    if half > 8 and max(zeros) > 0.8 * half and min(zeros) < 0.05 * half:
        return "utf-16-be" if zeros[0] > zeros[1] else "utf-16-le"
    return None


def _decoded(data: bytes) -> str:
    """UTF-8, or where it is none what Windows writes in the west of Europe."""
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        if error.start >= len(data) - 4 and error.reason == "unexpected end of data":
            return data[: error.start].decode("utf-8-sig")
        return data.decode("cp1252", "replace")
