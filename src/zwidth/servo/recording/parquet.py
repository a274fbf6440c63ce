"""A recording in a folder of Parquet files, a part for each second.

A part is written under another name, which other readers pass over, and put in its place when it is whole.
The first part has no rows: from the beginning on the folder says what it holds.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from zwidth.identification.logs.served.contents import Head
from zwidth.identification.logs.served.parquet import CHECKSUM, SAID, checksum, part_name
from zwidth.writing import writing_whole

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

_PART = 1_000_000_000
"""[ns] of samples in a part, about."""


class ParquetFolder:
    """A folder that grows by parts.

    Parameters
    ----------
    path
        The folder, made new.
    head
        What is known before the first row.

    Raises
    ------
    InputError, OSError
        If the disk does not take it.
    """

    def __init__(self, path: Path, head: Head) -> None:
        path.mkdir()
        self._folder, self._head = path, head
        self._rows: list[Array] = []
        self._events: list[dict[str, Any]] = []
        self._since: int | None = None
        self._parts = self.size = self.rows = 0
        self._part(last=False)

    def write(self, rows: Array, taken: NDArray[np.int64], events: list[dict[str, Any]], now: int) -> None:
        """Rows and events for the part that grows; it is written when a second is over."""
        self._rows.append(rows)
        self._events += events
        self._since = now if self._since is None else self._since
        if now - self._since >= _PART:
            self._part(last=False)
            self._since = now

    def close(self) -> None:
        """The last part, even without rows."""
        self._part(last=True)

    def abandon(self) -> None:
        """Nothing more is written: what is in its place is whole."""

    def _part(self, *, last: bool) -> None:
        columns = self._head.columns
        rows = np.concatenate([np.empty((0, len(columns))), *self._rows])
        said = self._head.text(part=self._parts, events=self._events, last=last).encode()
        fields = [pa.field(name, pa.float64(), nullable=False) for name in columns]
        schema = pa.schema(fields, metadata={SAID: said, CHECKSUM: checksum(said, rows)})
        table = pa.Table.from_arrays([pa.array(column) for column in rows.T], schema=schema)
        self._put(table, self._folder / part_name(self._parts))
        self._rows, self._events = [], []
        self.rows += len(rows)
        self._parts += 1

    def _put(self, table: pa.Table, place: Path) -> None:
        with writing_whole(place) as file:
            pq.write_table(table, file, compression="zstd")
            self.size += file.tell()
