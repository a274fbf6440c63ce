"""ROS bags, sqlite or MCAP: the numbers in the messages of each topic, by path, "/hand.wrench.force.z".

Where a message names what its lists hold, as a JointState does, a number is known by that name and never by
its place: "/joint_states.position[shoulder]" is the shoulder's in every message, wherever it stands there,
and messages without it are no samples.

A sample's stamp is that of its message's header, or else when it was recorded.  A column of another topic is
taken from the message nearest in time, at most half a period away.  Messages are unpacked one by one, and
their numbers held in memory.
"""

from __future__ import annotations

import re
from array import array
from collections.abc import Iterator, Sequence
from contextlib import suppress
from io import BytesIO
from itertools import islice
from os import fstat
from pathlib import Path
from struct import unpack
from typing import IO, TYPE_CHECKING, Any, NamedTuple

import numpy as np

from zwidth.data.logs.served import MAGIC, ZSTD, Mcap
from zwidth.data.logs.table import MOST_COLUMNS, Finding, Table, Values, in_pieces, listed, nearest, readable
from zwidth.errors import InputError
from zwidth.installing import library
from zwidth.reading import LARGEST_CHUNK, Bounded, check_chunk, check_expansion, unpacking

if TYPE_CHECKING:
    from numpy.typing import NDArray

TIME = "time"
"""The column of stamps: of the topic that holds the position."""

LOOKED_AT = 1000
"""Messages of a topic in which names are looked for: several may write to one topic in turn."""

_UNITS = {"geometry_msgs/msg/Vector3.force": "N", "geometry_msgs/msg/Vector3.torque": "N*m"}

_NAMING = ("name", "names")
"""How a list of names is called at the end."""

_Steps = tuple[Any, ...]
"""To a number in a message: members by name, places of a list by number, or by (name, steps to the names)."""


class _Column(NamedTuple):
    topic: str
    steps: _Steps

    @property
    def name(self) -> str | None:
        """What the message itself calls it; None where it goes by its place."""
        return next((step[0] for step in self.steps if isinstance(step, tuple)), None)


def bag_table(path: Path) -> Table:
    columns: dict[str, _Column] = {}
    units: dict[str, str | None] = {TIME: "ns"}
    bag = _opened(path)
    with bag as reader:
        check_messages(path, reader)
        notes = {finding.kind: finding for finding in _left_out(path, reader)}
        for connection in reader.connections:
            topic = connection.topic
            try:
                with readable(f"{path}: the topic {topic}"):
                    found = list(_first(reader, connection))
            except InputError as error:
                if len(reader.connections) == 1:
                    raise
                notes[topic] = Finding(kind="topics left out", text=f"left out: {error}")
                continue
            for field, unit, steps in found:
                columns[f"{topic}.{field}"] = _Column(topic, steps)
                units[f"{topic}.{field}"] = unit
    return Table(
        source=str(path), units=units, read=lambda names: _read(path, bag, names, columns, notes), notes=notes
    )


def _opened(path: Path) -> Any:
    files = _mcap_files(path)
    if files:
        return Mcap(path, files)
    check_bag(path)
    highlevel = library("rosbags.highlevel", f"{path} is not read: a bag of ROS")
    typesys = library("rosbags.typesys", f"{path} is not read: a bag of ROS")
    return highlevel.AnyReader([path], default_typestore=typesys.get_typestore(typesys.Stores.LATEST))


def _mcap_files(path: Path) -> list[Path]:
    """The files of MCAP in a bag, by their numbers; none where it is another kind of bag."""
    if not path.is_dir():
        with open(path, "rb") as file:
            return [path] if file.read(5) == MAGIC[:5] else []
    about = (path / "metadata.yaml").read_text(encoding="utf-8")
    if not re.search(r"storage_identifier:\s*[\"']?mcap", about):
        return []
    files = sorted(path.glob("*.mcap"), key=lambda file: (len(file.name), file.name))
    for name in re.findall(r"[^\s/\"']+\.mcap(?![\w.])", about):
        if not any(file.name.endswith(name) for file in files):
            raise InputError(f"{path} is not whole: its {name} is missing; copy it there, or name one file")
    return files


def _first(reader: Any, connection: Any) -> Iterator[tuple[str, str | None, _Steps]]:
    """The numbers in the first message; in the first thousand where messages may differ."""
    found: dict[_Steps, tuple[str, str | None]] = {}
    for _, _, data in islice(reader.messages(connections=[connection]), LOOKED_AT):
        message = reader.deserialize(data, connection.msgtype)
        found |= {steps: (path, unit) for path, unit, steps in _fields(message)}
        if not _may_differ(message):
            break
    named = {steps[:-1] for steps in found if isinstance(steps[-1], tuple)}
    for steps, (path, unit) in found.items():
        if not isinstance(steps[-1], int) or steps[:-1] not in named:  # what has names has no places
            yield path, unit, steps


def _may_differ(message: Any) -> bool:
    """Whether another message may name other things: lists of names, empty ones too; JSON has no type."""
    return isinstance(message, dict) or any(
        _may_differ(value) or (name.endswith(_NAMING) and isinstance(value, list))
        for name, value in _members(message).items()
    )


def _left_out(path: Path, reader: Any) -> Iterator[Finding]:
    """What a file of MCAP lost, and what in it is not read; refused where nothing is left."""
    if not isinstance(reader, Mcap):
        return
    size = sum(file.stat().st_size for file in reader.files)
    if reader.cut and not reader.connections:
        raise InputError(
            f"{path} ends in the middle, after {size} bytes: was it copied whole, its recorder ended? "
            "No whole piece of it is there"
        )
    unread = ", ".join(f"{topic} ({how})" for topic, how in reader.unread.items())[:300]
    if not reader.connections:
        said = f"its messages are of no known type: {unread}" if unread else "it holds no whole message"
        raise InputError(f"{path} is not read: {said}; cdr, ros1 and json are read")
    if reader.cut or reader.lost:
        text = "the file ends in the middle" if reader.cut else "the file is damaged"
        yield Finding(kind="cut", text=f"{text}: {reader.lost} of its {size} bytes are in no whole piece")
    if unread:
        yield Finding(kind="topics left out", text=f"topics of no known type are left out: {unread}")


def _members(message: Any) -> dict[str, Any]:
    """What a message holds, by name; nothing where it is none."""
    if isinstance(message, dict):
        return message
    fields = getattr(message, "__dataclass_fields__", ())
    return {name: getattr(message, name) for name in fields if name != "__msgtype__"}


def _fields(
    message: Any, where: _Steps = (), names: _Steps = (), labels: Sequence[str] = ()
) -> Iterator[tuple[str, str | None, _Steps]]:
    """Paths of the numbers in a message, the unit where its type has one, and the steps to them; `names` are
    the steps to the `labels` of the lists in it, if it has none of its own."""
    members = _members(message)
    for name, value in members.items():
        if name.endswith(_NAMING) and _are_names(value):
            names, labels = (*where, name), value
            break
    for name, value in members.items():
        here = (*where, name)
        if name == "header" or _instant(value) is not None:
            continue
        if _is_number(value):
            yield name, None, here
        elif isinstance(value, np.ndarray | list) and 0 < len(value) <= MOST_COLUMNS:
            named = len(value) == len(labels)
            for k, one in enumerate(value):
                place = (labels[k], names) if named else k
                path, steps = f"{name}[{labels[k] if named else k}]", (*here, place)
                if _is_number(one):
                    yield path, None, steps
                elif named:
                    for inner, unit, further in _fields(one, steps):
                        yield f"{path}.{inner}", unit, further
        elif _members(value):
            unit = _UNITS.get(f"{getattr(value, '__msgtype__', '')}.{name}")
            for inner, inner_unit, steps in _fields(value, here, names, labels):
                yield f"{name}.{inner}", inner_unit or unit, steps


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float | np.integer | np.floating) and not isinstance(value, bool)


def _are_names(value: Any) -> bool:
    texts = isinstance(value, list) and bool(value) and all(isinstance(v, str) and v for v in value)
    return texts and len(set(value)) == len(value)


def _instant(value: Any) -> int | None:
    """[ns] of a time in two numbers; None where it is none."""
    members = _members(value)
    parts = [members[k] for k in ("sec", "secs", "nanosec", "nsec", "nsecs") if k in members]
    whole = len(parts) == len(members) == 2 and all(map(_is_number, parts))
    return int(parts[0]) * 10**9 + int(parts[1]) if whole else None


def _stamp(message: Any) -> int:
    """[ns] when a message says that it was sampled; 0 where it does not."""
    with suppress(AttributeError):  # most messages of ROS, quickly
        return int(message.header.stamp.sec * 10**9 + message.header.stamp.nanosec)
    members = _members(message)
    holders = (_members(members.get("header")), members)
    found = (_instant(holder.get(name)) for holder in holders for name in ("stamp", "timestamp"))
    return next(filter(None, found), 0)


def _read(
    path: Path, bag: Any, names: tuple[str, ...], columns: dict[str, _Column], notes: dict[str, Finding]
) -> Iterator[tuple[Values, ...]]:
    wanted = {name: columns[name] for name in names if name != TIME}
    first = next(iter(wanted))
    main = columns[first].topic
    with bag as reader:
        stamps, rows, values = _unpacked(reader, wanted)
    taken = rows[first]
    if missing := stamps[main].size - taken.size:
        text = f'{missing} of {stamps[main].size} messages of "{main}" have no {first} and are left out'
        notes["messages left out"] = Finding(kind="messages left out", text=text, samples=missing)
    used = {column.name for column in wanted.values()}
    others = {column.name for column in columns.values() if column.topic == main} - used - {None}
    if columns[first].name is not None and others:
        text = f'"{main}" also holds {listed(sorted(map(str, others)))}: not read'
        notes["names left out"] = Finding(kind="names left out", text=text)
    found: dict[str, NDArray[Any]] = {TIME: stamps[main][taken]}
    for name, (topic, _) in wanted.items():
        if topic == main:
            whole = np.full(stamps[main].size, np.nan)
            whole[rows[name]] = values[name]
            found[name] = whole[taken]
        else:
            found[name] = nearest(found[TIME], stamps[topic][rows[name]], values[name])
            text = (
                f'"{name}" is of another topic than the position; each sample has the value nearest in time'
            )
            notes[name] = Finding(kind="two topics", text=text)
    yield from in_pieces(str(path), found, names)


_Arrays = dict[str, "NDArray[Any]"]


def _unpacked(reader: Any, columns: dict[str, _Column]) -> tuple[_Arrays, _Arrays, _Arrays]:
    """Stamps [ns] of the messages of each topic; of each column which of them have it, and its numbers."""
    stamps = {column.topic: array("q") for column in columns.values()}
    rows = {name: array("q") for name in columns}
    numbers = {name: array("d") for name in columns}
    connections = [c for c in reader.connections if c.topic in stamps]
    for connection, recorded, data in reader.messages(connections=connections):
        message = reader.deserialize(data, connection.msgtype)
        of_topic = stamps[connection.topic]
        for name, (topic, steps) in columns.items():
            if topic == connection.topic and (value := _value(message, steps)) is not None:
                rows[name].append(len(of_topic))
                numbers[name].append(value)
        of_topic.append(_stamp(message) or recorded)
    return (
        {topic: np.frombuffer(values, dtype=np.int64) for topic, values in stamps.items()},
        {name: np.frombuffer(values, dtype=np.int64) for name, values in rows.items()},
        {name: np.frombuffer(values, dtype=np.float64) for name, values in numbers.items()},
    )


def _value(message: Any, steps: _Steps) -> float | None:
    """A number of a message: None where it has none of that name, NaN where there is no number."""
    value = _followed(message, steps)
    return value if value is None else float(value) if _is_number(value) else float("nan")


def _followed(message: Any, steps: _Steps) -> Any:
    value = message
    for step in steps:
        if isinstance(step, str):
            value = value.get(step) if isinstance(value, dict) else getattr(value, step)
            if value is None:
                return None
            continue
        place = step
        if isinstance(step, tuple):
            labels = _followed(message, step[1])
            if labels is None or step[0] not in labels:
                return None
            place = labels.index(step[0])
        if place >= len(value):
            return float("nan")
        value = value[place]
    return value


# The pieces of a bag that are compressed, each looked at before the library expands it whole.
#
# A bag says of each chunk what it becomes, and an index says where the chunks are; the library believes
# both, and holds neither against what is in the file before it is expanded.

_CODECS = ("lz4", "bz2")
_ROS1_START, _ROS1_HEADER, _ROS1_CHUNK, _ROS1_INDEX = 13, b"\x03", b"\x05", b"\x06"
_STEP = 2**20


class _Piece(NamedTuple):
    """Where it is in the file, how it is compressed, and what it says that it becomes."""

    start: int
    size: int
    codec: str
    declared: int


def check_bag(path: Path) -> None:
    files = [file for file in sorted(path.iterdir()) if file.is_file()] if path.is_dir() else [path]
    for file in files:
        with open(file, "rb") as opened:
            start = opened.read(8)
        if start.startswith(MAGIC[:5]):
            raise InputError(
                f"{path} is not read: its metadata.yaml does not say that it is MCAP; name {file}"
            )
        if start.startswith(b"#ROSBAG"):
            _check_rosbag1(file)
        elif start[:4] == ZSTD or start[1:4] == b"\x2a\x4d\x18":
            _check_packed(file)


def _check_packed(path: Path) -> None:
    with Bounded(path, unpacking(path, "zstd")) as whole:
        if whole.read(_STEP).startswith(MAGIC[:5]):
            raise InputError(f"{path} is not read: compressed are its pieces, and it again; unpack it first")
        while whole.read(_STEP):
            pass


def check_messages(path: Path, reader: Any) -> None:
    """Refuse a bag whose messages are compressed one by one, if one would become too large."""
    for part in reader.readers:
        if getattr(part, "compression_mode", None) != "message":
            continue
        for store in part.storage.storages:
            for _, _, data in store.messages(store.connections):
                check_chunk(path, _grown(path, data, "zstd"))


def _check_rosbag1(path: Path) -> None:
    with open(path, "rb") as file:
        pieces, index = _ros1_pieces(file, path.stat().st_size)
        if not index <= set(pieces):
            raise InputError(f"{path} is not read: its index leads to where no piece of it begins")
        for piece in pieces.values():
            check_chunk(path, piece.declared)
            check_chunk(path, _expanded(path, file, piece))
    check_expansion(path, sum(piece.declared for piece in pieces.values()))


def _ros1_pieces(file: IO[bytes], end: int) -> tuple[dict[int, _Piece], set[int]]:
    """The pieces by where their records begin, and where the index says that they do."""
    pieces: dict[int, _Piece] = {}
    index: set[int] = set()
    place, tail = _ROS1_START, 0
    while place + 8 <= end:
        file.seek(place)
        fields = _ros1_fields(BytesIO(_part(file)))
        (size,) = unpack("<I", file.read(4))
        if fields.get(b"op") == _ROS1_HEADER:
            (tail,) = unpack("<Q", fields[b"index_pos"])
        if b"op" not in fields and place < tail:  # a bag gone on with may have a gap where its index was
            place = tail
            continue
        if fields.get(b"op") == _ROS1_CHUNK:
            (declared,) = unpack("<I", fields[b"size"])
            pieces[place] = _Piece(file.tell(), size, fields[b"compression"].decode("latin-1"), declared)
        elif fields.get(b"op") == _ROS1_INDEX:
            index |= set(unpack("<Q", fields[b"chunk_pos"]))
        place = file.tell() + size
    return pieces, index


def _ros1_fields(header: IO[bytes]) -> dict[bytes, bytes]:
    fields = {}
    while field := _part(header):
        name, _, value = field.partition(b"=")
        fields[name] = value
    return fields


def _part(record: IO[bytes]) -> bytes:
    """Bytes after their number; none at the end."""
    return record.read(int.from_bytes(record.read(4), "little"))


def _expanded(path: Path, file: IO[bytes], piece: _Piece) -> int:
    """[bytes] What it really becomes."""
    if piece.codec not in _CODECS:
        return 0
    file.seek(piece.start)
    return _grown(path, file.read(min(piece.size, fstat(file.fileno()).st_size)), piece.codec)


def _grown(path: Path, packed: bytes, codec: str) -> int:
    """[bytes] What is packed becomes; counting ends beyond what is read at once."""
    total = 0
    with unpacking(path, codec, packed) as stream:
        while total <= LARGEST_CHUNK and (part := stream.read(_STEP)):
            total += len(part)
    return total
