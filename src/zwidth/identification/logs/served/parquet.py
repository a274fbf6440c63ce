"""A recording in a folder of Parquet files, read part by part up to the first that is missing or broken.

Each part was written under another name and put in its place when it was whole.  What a part says of itself
is JSON in the metadata of its schema: the head, which part it is, the events since the part before, and
whether it is the last.  Beside it stands the checksum of that text and of the numbers.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple
from zlib import crc32

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from zwidth.errors import InputError
from zwidth.identification.logs.served.contents import Head, Part, head_in
from zwidth.reading import check_chunk, check_parquet

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

FIRST = "part-000000.parquet"

SAID, CHECKSUM = b"zwidth", b"zwidth crc32"
"""Keys of the metadata."""


class _File(NamedTuple):
    head: Head
    said: dict[str, Any]
    rows: Array


def part_name(number: int) -> str:
    """The name of a part: sorted by name they are in order."""
    return f"part-{number:06d}.parquet"


def checksum(said: bytes, rows: Array) -> bytes:
    """Of the text and then of the numbers, row by row, little-endian."""
    return str(crc32(np.ascontiguousarray(rows, dtype="<f8").tobytes(), crc32(said))).encode()


def parquet_head(folder: Path) -> Head:
    """What a recording says of itself.

    Raises
    ------
    InputError
        If its first part is not there, or is broken.
    """
    found = _read(folder / FIRST)
    if found is None:
        raise InputError(
            f"{folder} is no recording that can be read: its first part, {FIRST}, is missing or broken"
        )
    return found.head


def parquet_parts(folder: Path, head: Head) -> Iterator[Part]:
    """Part by part."""
    number = 0
    while (found := _read(folder / part_name(number))) is not None:
        if found.head != head or found.said.get("part") != number:
            return  # of another recording
        yield Part(found.rows, list(found.said.get("events", [])), bool(found.said.get("last")))
        number += 1


def _read(path: Path) -> _File | None:
    """A part; None where it is not there, or not as it was written."""
    try:
        about = pq.read_metadata(path)
        check_parquet(path)
        check_chunk(path, 8 * about.num_columns * about.num_rows)
        table = pq.read_table(path, partitioning=None)
        metadata, names = table.schema.metadata or {}, tuple(table.column_names)
        rows = _stacked(table)
    except InputError:
        raise
    except Exception:  # what the library raises on foreign bytes is not documented
        return None
    text = metadata.get(SAID, b"")
    if metadata.get(CHECKSUM) != checksum(text, rows):
        return None
    head, said = head_in(text, path)
    whole = head.columns == names and rows.shape[1] == len(names)
    return _File(head, said, rows) if whole else None


def _stacked(table: pa.Table) -> Array:
    """Rows × columns; whatever is no float64 is none of ours."""
    columns = [table[name] for name in table.column_names]
    if not columns or any(column.type != pa.float64() for column in columns):
        return np.empty((0, 0))
    return np.column_stack([np.asarray(column.to_numpy()) for column in columns])
