"""What a workbook is inside, a zip archive, and what it would become: looked at before a library does.

The library holds styles and texts in memory as objects, many times as large as they are in the file, and a
row at a time; so each of these is bounded by itself.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Literal
from zipfile import BadZipFile, ZipFile, ZipInfo

from zwidth.errors import InputError
from zwidth.reading import check_chunk, check_expansion

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

Kind = Literal["workbook", "binary", "open document", "other"]


def kind_of_archive(path: Path) -> Kind:
    """What a zip archive holds, by the names in it."""
    with _opened(path) as archive:
        names = set(archive.namelist())
        if "xl/workbook.bin" in names:
            return "binary"
        if "content.xml" in names and "mimetype" in names:
            with archive.open("mimetype") as file:
                spreadsheet = file.read(60).startswith(b"application/vnd.oasis.opendocument.spreadsheet")
            return "open document" if spreadsheet else "other"
        return "workbook" if any(_SHEET.fullmatch(name) for name in names) else "other"


def check_workbook(path: Path) -> None:
    """Refuse a workbook of which a part would become too large."""
    with _opened(path) as archive:
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


def _opened(path: Path) -> ZipFile:
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
