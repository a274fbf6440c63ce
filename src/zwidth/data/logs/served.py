"""Files of MCAP, of a served loop or of others, from their first byte on as far as they are whole.

The index at the end of a file is not used: a file that was cut off has none.  Chunks stand one after the
other, each with its checksum; the first that is not there as a whole ends what is read.  Layout:
https://mcap.dev/spec; a row is a message in CDR whose numbers are all float64.
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Collection, Iterator
from pathlib import Path
from struct import Struct, error, unpack, unpack_from
from typing import IO, Any, NamedTuple
from zlib import crc32

import numpy as np

from zwidth.data.logs.contents import COLUMNS, Head, Part, from_json, head_in, rows_lost
from zwidth.data.logs.table import PIECE, Finding, Table, Values
from zwidth.errors import InputError
from zwidth.installing import library
from zwidth.reading import LARGEST_CHUNK, check_chunk, check_expansion, unpacking

MAGIC = b"\x89MCAP0\r\n"
HEADER, FOOTER, SCHEMA, CHANNEL, MESSAGE, CHUNK, MESSAGE_INDEX, CHUNK_INDEX = range(1, 9)
STATISTICS, METADATA, METADATA_INDEX, SUMMARY_OFFSET, DATA_END = 11, 12, 13, 14, 15

RECORD = Struct("<BQ")
"""What every record begins with: its kind, and the bytes that follow."""

MESSAGE_HEAD = Struct("<HIQQ")
"""Channel, number in a row, times of writing and of the sample [ns since 1970]."""

CHUNK_HEAD = Struct("<QQQI")
"""Times of the first and of the last message, bytes when expanded, their checksum."""

ZSTD = b"\x28\xb5\x2f\xfd"
"""What begins so is compressed."""

CDR = b"\x00\x01\x00\x00"
"""Before each message: little-endian."""

ROWS, EVENTS = "/zwidth/model/samples", "/zwidth/events"

HEAD, END = "zwidth recording", "zwidth end"
"""Names of the metadata at the beginning, and behind the last row."""


class _Record(NamedTuple):
    kind: int
    content: bytes


def mcap_head(path: Path) -> Head | None:
    """What a recording says of itself; None for an MCAP of others."""
    with open(path, "rb") as file:
        for record in records(file, path):
            if record.kind == METADATA:
                name, said = _metadata(record.content)
                if name == HEAD:
                    text = said.get("json", "")
                    if said.get("crc32") != str(crc32(text.encode())):
                        raise InputError(f"{path} cannot be read: what it says of itself was changed")
                    return head_in(text, path)[0]
            if record.kind in (CHUNK, DATA_END):
                return None
    return None


def mcap_parts(path: Path, head: Head) -> Iterator[Part]:
    """Chunk by chunk, up to the first that is not whole."""
    topics: dict[int, str] = {}
    expanded = rows = events = 0
    following: int | None = None
    promised: dict[str, str] = {}
    with open(path, "rb") as file:
        for record in records(file, path):
            if record.kind == CHANNEL:
                _note_channel(record.content, topics)
            elif record.kind == METADATA:
                name, said = _metadata(record.content)
                if name == END:
                    promised = said
            elif record.kind == CHUNK:
                data = unpacked(record.content, path)
                if data is None:
                    return
                expanded += len(data)
                check_expansion(path, expanded)
                found = _messages(data, topics, len(head.columns), following)
                if found is None:
                    return
                part, following = found
                rows, events = rows + len(part.rows), events + len(part.events)
                yield part
            elif record.kind == DATA_END:
                break
    # who writes a file anew may put the end before the last chunk
    if (promised.get("rows"), promised.get("events")) == (str(rows), str(events)):
        yield Part(np.empty((0, len(head.columns))), [], last=True)


def records(file: IO[bytes], path: Path) -> Iterator[_Record]:
    """Whole records, one after the other."""
    if file.read(len(MAGIC)) != MAGIC:
        return
    while len(start := file.read(RECORD.size)) == RECORD.size:
        kind, size = RECORD.unpack(start)
        if size > path.stat().st_size:
            return
        check_chunk(path, size)
        content = file.read(size)
        if len(content) < size:
            return
        yield _Record(kind, content)


def _metadata(content: bytes) -> tuple[str, dict[str, str]]:
    """Name and texts of a metadata record; no texts where it is none."""
    try:
        name, place = text_at(content, 0)
        (size,) = unpack_from("<I", content, place)
        place, end = place + 4, place + 4 + size
        said = {}
        while place < end:
            key, place = text_at(content, place)
            said[key], place = text_at(content, place)
    except (error, UnicodeDecodeError):
        return "", {}
    return name, said


def text_at(content: bytes, place: int) -> tuple[str, int]:
    (size,) = unpack_from("<I", content, place)
    end = place + 4 + size
    return content[place + 4 : end].decode(), end


def _note_channel(content: bytes, topics: dict[int, str]) -> None:
    try:
        number, _ = unpack_from("<HH", content)
        topics[number] = text_at(content, 4)[0]
    except (error, UnicodeDecodeError):
        return


def unpacked(content: bytes, path: Path) -> bytes | None:
    """What a chunk expands to; None where its bytes are not those that were written."""
    try:
        _, _, size, checksum = CHUNK_HEAD.unpack_from(content)
        codec, place = text_at(content, CHUNK_HEAD.size)
        (packed,) = unpack_from("<Q", content, place)
    except (error, UnicodeDecodeError):
        return None
    check_chunk(path, size)
    stored = content[place + 8 : place + 8 + packed]
    if codec not in ("", "zstd", "lz4"):
        raise InputError(f"{path} is not read: it is compressed by {codec!r}; zstd, lz4 and none are read")
    data = _expanded(path, stored, codec, size)
    if data is None or len(data) != size or (checksum and crc32(data) != checksum):
        return None
    return data


def _expanded(path: Path, stored: bytes, codec: str, size: int) -> bytes | None:
    if codec == "":
        return stored
    stream = unpacking(path, codec, stored)
    try:
        with stream:
            return bytes(stream.read(size + 1))
    except Exception:  # each library has its own for what is damaged
        return None


def _messages(
    data: bytes, topics: dict[int, str], width: int, following: int | None
) -> tuple[Part, int | None] | None:
    """The rows and events in a chunk, and the number of the row that follows. None if it holds what no
    recorder writes, or does not begin with the row that is to follow: then a chunk before it was passed over,
    since it is no more known as one."""
    rows: list[Any] = []
    events: list[dict[str, Any]] = []
    place = 0
    try:
        while place < len(data):
            kind, size = RECORD.unpack_from(data, place)
            inside = place + RECORD.size
            if kind == CHANNEL:
                _note_channel(data[inside : inside + size], topics)
            elif kind == MESSAGE:
                topic = topics.get(unpack_from("<H", data, inside)[0])
                if topic == ROWS:
                    found, first = _run_of_rows(data, place, width)
                    if following not in (None, first):
                        return None
                    rows.append(found)
                    following = (first + len(found)) % 2**32
                    place += len(found) * _row_size(width)
                    continue
                if topic == EVENTS:
                    events.append(_event(data[inside + MESSAGE_HEAD.size : inside + size]))
            place = inside + size
    except (error, ValueError):
        return None
    return Part(np.concatenate([np.empty((0, width)), *rows]), events), following


def _row_size(width: int) -> int:
    return RECORD.size + MESSAGE_HEAD.size + len(CDR) + 8 * width


def _run_of_rows(data: bytes, place: int, width: int) -> tuple[Any, int]:
    """The rows whose messages follow each other here, alike and counted up; the number of the first."""
    step, before = _row_size(width), RECORD.size + 2
    count = (len(data) - place) // step
    table = np.frombuffer(data, np.uint8, count * step, place).reshape(count, step)
    same = (table[:, :before] == table[:1, :before]).all(axis=1)
    numbers = np.ascontiguousarray(table[:, before : before + 4]).view("<u4").ravel()
    same &= numbers == (int(numbers[0] if count else 0) + np.arange(count)) % 2**32
    run = count if same.all() else int(np.argmin(same))
    own = step - 8 * width
    headed = unpack("<Q", data[place + 1 : place + 9])[0] == step - RECORD.size
    if run == 0 or not headed or (table[:run, own - 4 : own] != np.frombuffer(CDR, np.uint8)).any():
        raise ValueError("a row is not as long as its columns say")
    rows = np.ascontiguousarray(table[:run, own:]).view("<f8").astype(np.float64, copy=False)
    return rows, int(numbers[0])


def _event(message: bytes) -> dict[str, Any]:
    (size,) = unpack_from("<I", message, len(CDR))
    return from_json(message[8 : 8 + size - 1])


# A recording as the table of a log: when a sample was taken, the position as read, the force given.
#
# A row whose sample had no good answer has no position: nothing was read.

GOOD = 0.0
"""The status of a sample that was read."""


def served_table(path: Path, head: Head) -> Table:
    """The table of a recording; its columns are known by what they are called."""
    position, force = COLUMNS[head.motion]
    hand = force.replace("force", "hand_force")  # only a simulated device tells it
    known: dict[str, Any] = {
        key: head.about[key] for key in ("resolution_m", "resolution_rad") if key in head.about
    }
    table = Table(
        source=str(path),
        units=dict.fromkeys(head.columns),
        read=lambda names: _read(path, head, names, table.notes),
        attributes={"motion": head.motion, **known},
        means={
            "time": "time_s",
            "position": position,
            "hand_force": hand if hand in head.columns else None,
            "actuator_force": force,
        },
    )
    return table


def _read(
    path: Path, head: Head, names: tuple[str, ...], notes: dict[str, Finding]
) -> Iterator[tuple[Values, ...]]:
    chosen = [head.columns.index(name) for name in names]
    waiting: list[Any] = []
    last, lost = False, 0
    for part in mcap_parts(path, head):
        waiting.append(_with_gaps(part.rows, head)[:, chosen])
        lost += rows_lost(part.events)
        last = part.last
        if sum(map(len, waiting)) >= PIECE // 4:
            yield tuple(np.concatenate(waiting).T)
            waiting = []
    if waiting:
        yield tuple(np.concatenate(waiting).T)
    if not last:
        notes["cut"] = Finding(kind="cut off", text="the recording has no end: it was cut off there")
    if lost:
        text = f"{lost} rows were lost while recording, because the disk or the processor was too slow"
        notes["lost"] = Finding(kind="rows lost", text=text, samples=lost)


def _with_gaps(rows: Any, head: Head) -> Any:
    """Nothing was read where there was no good answer."""
    silent = rows[:, head.columns.index("status")] != GOOD
    if silent.any():
        rows = rows.copy()
        rows[silent, head.columns.index(COLUMNS[head.motion][0])] = np.nan
    return rows


# MCAP, from its first byte on: the index at the end is not needed, which a file that was cut off has not.


class Topic(NamedTuple):
    """A topic, and what its messages are: their encoding, their type, how it is defined, the definition."""

    topic: str
    msgtype: tuple[str, str, str, bytes]


class Mcap:
    """Files of MCAP that follow each other, read as rosbags' reader is."""

    readers = ()

    def __init__(self, path: Path, files: list[Path]) -> None:
        self.path, self.files = path, files
        self.connections: list[Topic] = []
        self.unread: dict[str, str] = {}
        self.lost, self.cut = 0, False
        self._decoders: dict[Any, Callable[[bytes], Any] | None] = {}

    def __enter__(self) -> Mcap:
        if not self.connections:
            for _ in self.messages():
                pass
        return self

    def __exit__(self, *_: object) -> None:
        return None

    def deserialize(self, data: bytes, msgtype: Any) -> Any:
        decoder = self._decoders[msgtype]
        assert decoder is not None
        return decoder(data)

    def messages(self, connections: Collection[Topic] = ()) -> Iterator[tuple[Topic, int, bytes]]:
        """Every message of some topics, or of all that can be read: [ns] when it was recorded, its bytes."""
        self.lost, self.cut = 0, False
        for file in self.files:
            schemas: dict[int, tuple[str, str, bytes]] = {}
            channels: dict[int, Topic | None] = {}
            for kind, content in self._records(file):
                if kind == MESSAGE:
                    number, _, recorded, _ = MESSAGE_HEAD.unpack_from(content)
                    channel = channels.get(number)
                    if channel is not None and (not connections or channel in connections):
                        yield channel, recorded, self._plain(bytes(content[MESSAGE_HEAD.size :]))
                elif kind == SCHEMA:
                    name, place = text_at(bytes(content), 2)
                    form, place = text_at(bytes(content), place)
                    schemas[unpack_from("<H", content)[0]] = (name, form, bytes(content[place + 4 :]))
                elif kind == CHANNEL:
                    number, schema = unpack_from("<HH", content)
                    topic, place = text_at(bytes(content), 4)
                    encoding, _ = text_at(bytes(content), place)
                    about = (encoding, *schemas.get(schema, ("", "", b"")))
                    channels[number] = self._known(Topic(topic, about))

    def _records(self, file: Path) -> Iterator[tuple[int, Any]]:
        """Those in the whole chunks and beside them, up to the end of what was recorded."""
        expanded, end = 0, len(MAGIC)
        with open(file, "rb") as opened:
            for record in records(opened, file):
                end = opened.tell()
                if record.kind in (DATA_END, FOOTER):
                    return
                if record.kind != CHUNK:
                    yield record
                    continue
                data = unpacked(record.content, file)
                if data is None:
                    self.lost += len(record.content)
                    continue
                expanded += len(data)
                check_expansion(file, expanded)
                yield from _in_order(data)
        self.cut = True
        self.lost += max(0, file.stat().st_size - end)

    def _known(self, channel: Topic) -> Topic | None:
        encoding = channel.msgtype[0]
        if channel.msgtype not in self._decoders:
            self._decoders[channel.msgtype] = (
                json.loads if encoding == "json" else self._of_ros(*channel.msgtype)
            )
        if self._decoders[channel.msgtype] is None:
            self.unread[channel.topic] = encoding or "none"
            return None
        if channel not in self.connections:
            self.connections.append(channel)
        return channel

    def _of_ros(self, encoding: str, name: str, form: str, text: bytes) -> Callable[[bytes], Any] | None:
        if encoding not in ("cdr", "ros1"):
            return None
        typesys = library("rosbags.typesys", f"{self.path} is not read: a message of ROS")
        store = typesys.get_typestore(typesys.Stores.EMPTY if text else typesys.Stores.LATEST)
        try:
            if form.endswith("idl"):
                parts = re.split(r"^=+\n(?:IDL: .*\n)?", text.decode(), flags=re.MULTILINE)
                for part in filter(str.strip, parts):
                    store.register(typesys.get_types_from_idl(part))
            elif text:
                store.register(typesys.get_types_from_msg(text.decode(), name))
        except typesys.TypesysError:  # one topic of many
            return None
        full = name if "/msg/" in name else name.replace("/", "/msg/")
        read = store.deserialize_cdr if encoding == "cdr" else store.deserialize_ros1
        return lambda data: read(data, full)

    def _plain(self, data: bytes) -> bytes:
        """A message that is compressed by itself, expanded: none begins so otherwise."""
        if not data.startswith(ZSTD):
            return data
        with unpacking(self.path, "zstd", data) as stream:
            whole = bytes(stream.read(LARGEST_CHUNK + 1))
        check_chunk(self.path, len(whole))
        return whole


def _in_order(data: bytes) -> list[tuple[int, memoryview]]:
    """The records in a chunk, messages by when they were recorded."""
    found, place, view = [], 0, memoryview(data)
    while place < len(data):
        kind, size = RECORD.unpack_from(data, place)
        place += RECORD.size + size
        found.append((kind, view[place - size : place]))
    return sorted(found, key=lambda each: unpack_from("<Q", each[1], 6)[0] if each[0] == MESSAGE else 0)
