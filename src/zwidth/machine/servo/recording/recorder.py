"""A thread beside the loop that writes its rows to a file, five times a second.

It never holds the loop up: it copies rows out of the ring, and what the ring has written over before it came
is lost, counted and said.  A disk that refuses ends the recording, not the loop.
"""

from __future__ import annotations

import os
import threading
import time
from collections.abc import Callable, Iterable
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from os import PathLike
from pathlib import Path
from struct import pack
from typing import TYPE_CHECKING, Any, Protocol
from zlib import crc32

import numpy as np

from zwidth import __version__
from zwidth.data.logs import served as layout
from zwidth.data.logs.contents import ROWS_LOST, Head, as_json, from_json
from zwidth.errors import InputError
from zwidth.machine.servo.connection import Closing
from zwidth.machine.servo.live.rows import Rows, ros2_schema
from zwidth.native.compiled import Array
from zwidth.quantity.answered import answered
from zwidth.quantity.documented import Documented
from zwidth.writing import check_target, first_line

if TYPE_CHECKING:
    from numpy.typing import NDArray


EVERY = 0.2
"""[s] between two looks at the ring, so that what was done a second ago is in the file."""

SUFFIX = ".mcap"


@dataclass(frozen=True, kw_only=True, repr=False)
class Recorded(Documented):
    """What became of a recording."""

    path: Path = answered("the file")
    rows: int = answered("in the file")
    rows_lost: int = answered("written over in the ring before they could be")
    size: int = answered("of the file", unit="bytes")
    failure: str | None = answered("why it ended before the loop did; null if it did not")

    def report(self) -> Iterable[str]:
        """In a line."""
        yield self.describe()

    def describe(self) -> str:
        """In a line."""
        lost = f"{self.rows_lost:,} rows were lost" if self.rows_lost else "none lost"
        line = f"{self.path}: {self.rows:,} rows, {lost}, {self.size / 1e6:.1f} MB"
        return line if self.failure is None else f"{line}; the recording ended early: {self.failure}"


class Recorder(Closing):
    """Write the rows of a loop to a file while it runs.

    Parameters
    ----------
    rows
        Of the loop; from its first row on.
    path
        Ends in .mcap.
    force
        Replace what is there.

    Raises
    ------
    InputError
        If the suffix is another, something is there already, or it cannot be written.
    """

    def __init__(self, rows: LoopRows, path: str | PathLike[str], *, force: bool = False) -> None:
        self._rows, self.path = rows, Path(path)
        check_recording(self.path, force)
        try:
            self._file = McapFile(self.path, _head(rows), force)
        except OSError as error:
            raise InputError(f"{path} cannot be written: {error.strerror or first_line(error)}") from None
        self._count = self._lost = self._told = 0
        self._sample: float | None = None
        self._origin: int | None = None
        self._failure: str | None = None
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._run, name="zwidth-recorder", daemon=True)
        self._thread.start()

    def close(self) -> Recorded:
        """Write what is left, and the end; what became of it all.  May be called again."""
        if not self._over.is_set():
            self._over.set()
            self._thread.join()
            self._attempt(self._drain)
            self._attempt(self._file.close)
        return self.so_far()

    def so_far(self) -> Recorded:
        """What has been written up to now."""
        return Recorded(
            path=self.path,
            rows=self._file.rows,
            rows_lost=self._lost,
            size=self._file.size,
            failure=self._failure,
        )

    def _run(self) -> None:
        while not self._over.wait(EVERY) and self._failure is None:
            self._attempt(self._drain)

    def _attempt(self, step: Any) -> None:
        """A step of writing; whatever goes wrong ends the recording alone, never the loop."""
        if self._failure is not None:
            return
        try:
            step()
        except Exception as error:  # nobody else would hear of it: it is in the report
            self._failure = (error.strerror if isinstance(error, OSError) else None) or first_line(error)
            self._file.abandon()

    def _drain(self) -> None:
        told = self._rows.events[self._told :]
        count, found = self._rows.after(self._count)
        now = time.time_ns()
        lost = count - self._count - len(found)
        events = ([self._loss(lost, found)] if lost else []) + told
        self._file.write(found, self._taken(found, now), events, now)
        self._count, self._told = count, self._told + len(told)
        self._lost += lost
        if len(found):
            self._sample = float(found[-1, self._rows.COLUMNS.index("sample")])

    def _loss(self, lost: int, found: Array) -> dict[str, Any]:
        sample = self._rows.COLUMNS.index("sample")
        before = float(found[0, sample]) if len(found) else None
        return {"event": ROWS_LOST, "rows": lost, "after_sample": self._sample, "before_sample": before}

    def _taken(self, found: Array, now: int) -> NDArray[np.int64]:
        """When the samples were taken [ns since 1970]: the newest row of the first look is of just now."""
        if not len(found):
            return np.empty(0, np.int64)
        since = np.rint(1e9 * found[:, self._rows.COLUMNS.index("time_s")]).astype(np.int64)
        if self._origin is None:
            self._origin = now - int(since[-1])
        return since + self._origin


def _head(rows: LoopRows) -> Head:
    return Head(
        columns=tuple(rows.COLUMNS),
        motion=rows.motion,
        period=rows.period,
        title=rows.title,
        about=from_json(as_json(rows.about)),  # as it is now: what is said of a file does not change in it
    )


def check_recording(path: Path, force: bool) -> None:
    """Refuse a place that is none for a recording, before anything is served."""
    if path.suffix.lower() != SUFFIX:
        raise InputError(
            f"a recording is a file that ends in {SUFFIX}, got {str(path)!r}; of one zwidth replay "
            "run.mcap -o run.nc makes a table, and in Python read_recording(path).dataset().to_dataframe()"
        )
    check_target(path, force)


class LoopRows(Rows, Protocol):
    """The rows of a loop, such as `servo.ring.Rows`, with what is known of it."""

    @property
    def about(self) -> dict[str, Any]:
        """What a file says of it, as JSON has it."""

    @property
    def events(self) -> list[dict[str, Any]]:
        """What happened so far."""


# MCAP:  magic  header  metadata  schemas  channels  {chunk  index}  …  metadata  end  summary  footer  magic
#
# A chunk holds the rows of a fifth of a second, each a message of its own with its time, and goes to the
# system in one piece: after the process is killed it is there, since the system has it.  Layout:
# https://mcap.dev/spec.  The bytes of a chunk are made of arrays, not message by message: a row costs less
# than a microsecond.


_OF_ROWS, _OF_EVENTS = 1, 2
"""Numbers of the schemas and channels."""

_NEW = os.O_WRONLY | os.O_CREAT | getattr(os, "O_BINARY", 0)

_NUMBERED = np.dtype([("kind", "u1"), ("size", "<u8"), ("channel", "<u2"), ("number", "<u4")])
_TIMED = np.dtype([("written", "<u8"), ("taken", "<u8"), ("cdr", "V4")])
"""What stands in a message before its numbers."""


def record(kind: int, content: bytes) -> bytes:
    """A record of MCAP."""
    return layout.RECORD.pack(kind, len(content)) + content


def text(value: str) -> bytes:
    """A string of MCAP."""
    raw = value.encode()
    return pack("<I", len(raw)) + raw


def _table(values: dict[str, str]) -> bytes:
    inside = b"".join(text(key) + text(value) for key, value in values.items())
    return pack("<I", len(inside)) + inside


def _packer() -> tuple[str, Callable[[bytes], bytes]]:
    """What compresses a chunk, where it is installed: the standard library has nothing that MCAP knows."""
    try:
        from pyarrow import compress
    except ImportError:
        return "", bytes
    return "zstd", partial(compress, codec="zstd", asbytes=True)


class McapFile:
    """A file that grows by chunks, made new; with `force` what is there is lost.

    Else there must be nothing, nor a link.
    """

    def __init__(self, path: Path, head: Head, force: bool = False) -> None:
        self._file = os.open(path, _NEW | (os.O_TRUNC if force else os.O_EXCL), 0o666)
        self._head, self._at = head, 0
        self._codec, self._packed = _packer()
        self._rows = self._events = self._chunks = 0
        self._index = bytearray()
        self._first = self._last = 0
        self._metadata: list[tuple[int, int, str]] = []
        described = record(layout.HEADER, text("ros2") + text(f"zwidth {__version__}"))
        self._give(layout.MAGIC + described)
        said = head.text()
        self._say(layout.HEAD, {"json": said, "crc32": str(crc32(said.encode()))})
        self._give(_schemas(head) + _channels())

    @property
    def size(self) -> int:
        """[bytes] so far."""
        return self._at

    @property
    def rows(self) -> int:
        """In the file."""
        return self._rows

    def write(self, rows: Array, taken: NDArray[np.int64], events: list[dict[str, Any]], now: int) -> None:
        """A chunk of rows, taken at these times, and of events, told now [ns since 1970]."""
        if len(rows) + len(events) == 0:
            return
        messages = _messages(rows, taken, self._head, self._rows)
        told = [_event(event, now, self._events + k) for k, event in enumerate(events)]
        data = messages.tobytes() + b"".join(told)
        times = [*map(int, taken[:1]), *map(int, taken[-1:]), *([now] * bool(events))]
        start, end = min(times), max(times)
        packed = self._packed(data)
        about = layout.CHUNK_HEAD.pack(start, end, len(data), crc32(data)) + text(self._codec)
        chunk = record(layout.CHUNK, about + pack("<Q", len(packed)) + packed)
        places = np.arange(len(rows), dtype=np.uint64) * np.uint64(messages.dtype.itemsize)
        indices = {_OF_ROWS: _index(_OF_ROWS, taken, places)} if len(rows) else {}
        if events:
            ends = np.cumsum([messages.nbytes, *map(len, told)])[:-1]
            indices[_OF_EVENTS] = _index(_OF_EVENTS, np.full(len(events), now), ends)
        about = text(self._codec) + pack("<QQ", len(packed), len(data))
        self._index += _chunk_index(start, end, self._at, len(chunk), indices, about)
        self._give(chunk + b"".join(indices.values()))
        self._first = self._first if self._chunks else start
        self._last = max(self._last, end)
        self._rows, self._events = self._rows + len(rows), self._events + len(events)
        self._chunks += 1

    def close(self) -> None:
        """The end, and the index of it all; given to the disk."""
        self._say(layout.END, {"rows": str(self._rows), "events": str(self._events)})
        self._give(record(layout.DATA_END, pack("<I", 0)))
        self._give(self._summary())
        os.fsync(self._file)
        os.close(self._file)

    def abandon(self) -> None:
        """Close the file as it is, after the disk has refused."""
        with suppress(OSError):
            os.ftruncate(self._file, self._at)  # a part of a chunk may be there
        with suppress(OSError):
            os.close(self._file)

    def _give(self, data: bytes) -> None:
        """All of it to the system: it may take it in parts."""
        rest = memoryview(data)
        while rest:
            rest = rest[os.write(self._file, rest) :]
        self._at += len(data)

    def _say(self, name: str, values: dict[str, str]) -> None:
        said = record(layout.METADATA, text(name) + _table(values))
        self._metadata.append((self._at, len(said), name))
        self._give(said)

    def _summary(self) -> bytes:
        """Copies of what describes the file, then where each kind of them begins, then the footer."""
        schemas, channels = _schemas(self._head), _channels()
        counts = pack("<IHQHQ", 20, _OF_ROWS, self._rows, _OF_EVENTS, self._events)
        messages = self._rows + self._events
        sizes = (messages, 2, 2, 0, len(self._metadata), self._chunks, self._first, self._last)
        groups = {
            layout.SCHEMA: schemas,
            layout.CHANNEL: channels,
            layout.STATISTICS: record(layout.STATISTICS, pack("<QHIIIIQQ", *sizes) + counts),
            layout.CHUNK_INDEX: bytes(self._index),
            layout.METADATA_INDEX: b"".join(
                record(layout.METADATA_INDEX, pack("<QQ", at, long) + text(name))
                for at, long, name in self._metadata
            ),
        }
        place, offsets = self._at, b""
        for kind, group in groups.items():
            if group:
                offsets += record(layout.SUMMARY_OFFSET, pack("<BQQ", kind, place, len(group)))
            place += len(group)
        footer = layout.RECORD.pack(layout.FOOTER, 20) + pack("<QQ", self._at, place)
        body = b"".join(groups.values()) + offsets + footer
        return body + pack("<I", crc32(body)) + layout.MAGIC


def _schemas(head: Head) -> bytes:
    row = ros2_schema(head.columns)
    kinds = ((_OF_ROWS, "zwidth_msgs/msg/Sample", row), (_OF_EVENTS, "std_msgs/msg/String", b"string data\n"))
    return b"".join(
        record(layout.SCHEMA, pack("<H", n) + text(name) + text("ros2msg") + pack("<I", len(data)) + data)
        for n, name, data in kinds
    )


def _channels() -> bytes:
    return b"".join(
        record(layout.CHANNEL, pack("<HH", number, number) + text(topic) + text("cdr") + _table({}))
        for number, topic in ((_OF_ROWS, layout.ROWS), (_OF_EVENTS, layout.EVENTS))
    )


def _messages(rows: Array, taken: NDArray[np.int64], head: Head, before: int) -> NDArray[Any]:
    """The rows as messages, one behind the other."""
    width = len(head.columns)
    kind = np.dtype([*_NUMBERED.descr, *_TIMED.descr, ("numbers", "<f8", (width,))])
    messages = np.empty(len(rows), kind)
    messages["kind"], messages["channel"] = layout.MESSAGE, _OF_ROWS
    messages["size"] = kind.itemsize - layout.RECORD.size
    messages["number"] = (before + np.arange(len(rows))) % 2**32
    messages["written"] = messages["taken"] = taken
    messages["cdr"] = np.void(layout.CDR)
    messages["numbers"] = rows
    return messages


def _event(event: dict[str, Any], now: int, number: int) -> bytes:
    raw = as_json(event).encode() + b"\0"
    about = layout.MESSAGE_HEAD.pack(_OF_EVENTS, number % 2**32, now, now)
    return record(layout.MESSAGE, about + layout.CDR + pack("<I", len(raw)) + raw)


def _index(channel: int, times: NDArray[Any], places: NDArray[Any]) -> bytes:
    """Where in the expanded chunk each message of a channel begins."""
    pairs = np.column_stack([times.astype("<u8"), places.astype("<u8")])
    return record(layout.MESSAGE_INDEX, pack("<HI", channel, pairs.nbytes) + pairs.tobytes())


def _chunk_index(start: int, end: int, at: int, size: int, indices: dict[int, bytes], packed: bytes) -> bytes:
    places, place = b"", at + size
    for channel, index in indices.items():
        places += pack("<HQ", channel, place)
        place += len(index)
    about = pack("<QQQQI", start, end, at, size, len(places)) + places + pack("<Q", place - at - size)
    return record(layout.CHUNK_INDEX, about + packed)
