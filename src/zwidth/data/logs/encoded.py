"""A text file as UTF-8 with lines that end in a line feed, whatever its bytes were."""

from __future__ import annotations

import re
from io import BytesIO
from pathlib import Path
from typing import IO

import pyarrow as pa

from zwidth.errors import InputError
from zwidth.reading import LARGEST_CHUNK, Bounded

SNIFFED = 2**16
"""[bytes] at the start of a file by which it is judged."""

_CONTROL = re.compile(r"[\x00-\x08\x0e-\x1a\x1c-\x1f]")
_SIGNS = (("\u2212", "-"), ("\u00a0", " "), ("\u202f", " "), ("\ufeff", ""))
"""Signs that mean the same as those of ASCII: a minus, spaces, a mark at the start of a file."""


def opened_text(path: Path) -> IO[bytes] | Bounded:
    """The bytes of a file; UTF-16, and lines that end in a carriage return alone, are turned over whole."""
    with _opened(path) as file:
        start = file.read(SNIFFED)
    encoding = _wide(start)
    bare_returns = b"\r" in start and b"\n" not in start
    if encoding is None and not bare_returns:
        return _opened(path)
    with _opened(path) as file:
        whole = file.read(LARGEST_CHUNK + 1)
    if len(whole) > LARGEST_CHUNK:
        raise InputError(f"{path} is text of an old kind and large; save it as UTF-8 with ordinary line ends")
    try:
        text = whole.decode(encoding) if encoding else _decoded(whole)
    except UnicodeDecodeError:
        text = whole.decode(encoding or "latin-1", "ignore")  # cut off in the middle of a letter
    return BytesIO(text.replace("\r\n", "\n").replace("\r", "\n").encode())


def text_of(start: bytes, source: str) -> str:
    """The text that bytes at the start of a file are."""
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
    if path.suffix.lower() in (".gz", ".bz2", ".zst"):
        return Bounded(path, pa.input_stream(str(path), compression="detect"))
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
