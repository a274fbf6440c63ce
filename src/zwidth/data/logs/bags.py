"""ROS bags, sqlite or MCAP: the numbers in the messages of each topic, by path, "/joint_states.position[0]".

A sample's stamp is that of its message's header, or else when it was recorded.  A column of another topic is
taken from the message nearest in time, at most half a period away.  Messages are unpacked one by one, and
their numbers held in memory.
"""

from __future__ import annotations

from array import array
from collections.abc import Iterator
from io import BytesIO
from os import fstat
from pathlib import Path
from struct import unpack
from typing import IO, TYPE_CHECKING, Any, NamedTuple

import numpy as np
import pyarrow as pa

from zwidth.data.logs.table import MOST_COLUMNS, Finding, Table, Values, in_pieces
from zwidth.errors import InputError
from zwidth.reading import LARGEST_CHUNK, Bounded, check_chunk, check_expansion

if TYPE_CHECKING:
    from numpy.typing import NDArray


TIME = "time"
"""The column of stamps: of the topic that holds the position."""

_UNITS = {"geometry_msgs/msg/Vector3.force": "N", "geometry_msgs/msg/Vector3.torque": "N*m"}
_INSTALL = "reading ROS bags and MCAP takes a library that is not installed: pip install 'zwidth[logs]'"


def bag_table(path: Path) -> Table:
    """The numbers in a bag."""
    paths: dict[str, str] = {}
    units: dict[str, str | None] = {TIME: "ns"}
    check_bag(path)
    with _opened(path) as reader:
        check_messages(path, reader)
        for connection in reader.connections:
            message = _first(reader, connection)
            for field, unit in _fields(message):
                paths[f"{connection.topic}.{field}"] = connection.topic
                units[f"{connection.topic}.{field}"] = unit
    notes: dict[str, Finding] = {}
    return Table(
        source=str(path), units=units, read=lambda names: _read(path, names, paths, notes), notes=notes
    )


def _opened(path: Path) -> Any:
    try:
        from rosbags.highlevel import AnyReader
        from rosbags.typesys import Stores, get_typestore
    except ImportError:
        raise InputError(f"{path} cannot be read: {_INSTALL}") from None
    return AnyReader([path], default_typestore=get_typestore(Stores.LATEST))


def _first(reader: Any, connection: Any) -> Any:
    for _, _, data in reader.messages(connections=[connection]):
        return reader.deserialize(data, connection.msgtype)
    return None


def _fields(message: Any) -> Iterator[tuple[str, str | None]]:
    """Paths of the numbers in a message, and the unit where its type has one."""
    for name in getattr(message, "__dataclass_fields__", {}):
        value = getattr(message, name)
        if name in ("header", "__msgtype__"):
            continue
        if isinstance(value, (int, float)) and not isinstance(value, bool):
            yield name, None
        elif isinstance(value, np.ndarray) and value.dtype.kind in "fiu" and value.size <= MOST_COLUMNS:
            for k in range(value.size):
                yield f"{name}[{k}]", None
        elif hasattr(value, "__dataclass_fields__"):
            unit = _UNITS.get(f"{value.__msgtype__}.{name}")
            for inner, inner_unit in _fields(value):
                yield f"{name}.{inner}", inner_unit or unit


def _read(
    path: Path, names: tuple[str, ...], topics: dict[str, str], notes: dict[str, Finding]
) -> Iterator[tuple[Values, ...]]:
    wanted = [name for name in names if name != TIME]
    main = topics[wanted[0]]
    with _opened(path) as reader:
        stamps, values = _unpacked(reader, {name: topics[name] for name in wanted})
    columns: dict[str, NDArray[Any]] = {TIME: stamps[main]}
    for name in wanted:
        columns[name] = values[name]
        if topics[name] != main:
            columns[name] = _nearest(stamps[main], stamps[topics[name]], values[name])
            text = (
                f'"{name}" is of another topic than the position; each sample has the value nearest in time'
            )
            notes[name] = Finding(kind="two topics", text=text)
    yield from in_pieces(str(path), columns, names)


def _unpacked(reader: Any, topics: dict[str, str]) -> tuple[dict[str, NDArray[Any]], dict[str, NDArray[Any]]]:
    """Stamps [ns] of each topic, and the numbers of each column."""
    stamps = {topic: array("q") for topic in topics.values()}
    numbers = {name: array("d") for name in topics}
    steps = {name: _steps(name.removeprefix(topic + ".")) for name, topic in topics.items()}
    connections = [c for c in reader.connections if c.topic in stamps]
    for connection, recorded, data in reader.messages(connections=connections):
        message = reader.deserialize(data, connection.msgtype)
        stamp = getattr(getattr(message, "header", None), "stamp", None)
        taken = 0 if stamp is None else stamp.sec * 10**9 + stamp.nanosec
        stamps[connection.topic].append(taken or recorded)
        for name, topic in topics.items():
            if topic == connection.topic:
                numbers[name].append(_value(message, steps[name]))
    return (
        {topic: np.frombuffer(values, dtype=np.int64) for topic, values in stamps.items()},
        {name: np.frombuffer(values, dtype=np.float64) for name, values in numbers.items()},
    )


def _steps(path: str) -> list[str | int]:
    """ "wrench.force.z" and "position[0]" as names and indices."""
    steps: list[str | int] = []
    for part in path.split("."):
        name, bracket, index = part.partition("[")
        steps.append(name)
        if bracket:
            steps.append(int(index[:-1]))
    return steps


def _value(message: Any, steps: list[str | int]) -> float:
    for step in steps:
        if isinstance(step, int):
            if step >= len(message):
                return float("nan")
            message = message[step]
        else:
            message = getattr(message, step)
    return float(message)


def _nearest(wanted: NDArray[Any], stamps: NDArray[Any], values: NDArray[Any]) -> NDArray[Any]:
    """The value nearest in time to each wanted stamp; NaN where none is within half a period."""
    if stamps.size == 0 or wanted.size < 2:
        return np.full(wanted.size, np.nan)
    order = np.argsort(stamps, kind="stable")
    stamps, values = stamps[order], values[order]
    right = np.clip(np.searchsorted(stamps, wanted), 0, stamps.size - 1)
    left = np.maximum(right - 1, 0)
    near = np.where(np.abs(stamps[left] - wanted) <= np.abs(stamps[right] - wanted), left, right)
    reach = 0.5 * float(np.median(np.diff(np.sort(wanted))))
    return np.where(np.abs(stamps[near] - wanted) <= 1.02 * reach, values[near], np.nan)


# The pieces of a bag that are compressed, each looked at before the library expands it whole.
#
# A bag says of each chunk what it becomes, and an index says where the chunks are; the library believes
# both, and holds neither against what is in the file before it is expanded.


_CHUNK, _CHUNK_INDEX = 0x06, 0x08
_MCAP = b"\x89MCAP"
_MCAP_END = b"\x89MCAP0\r\n"
_CODECS = ("lz4", "zstd", "bz2")
_ROS1_START, _ROS1_CHUNK, _ROS1_INDEX = 13, b"\x05", b"\x06"
_STEP = 2**20


class _Piece(NamedTuple):
    """Where it is in the file, how it is compressed, and what it says that it becomes."""

    start: int
    size: int
    codec: str
    declared: int


def check_bag(path: Path) -> None:
    """Refuse a bag of which a piece would become too large."""
    files = [file for file in sorted(path.iterdir()) if file.is_file()] if path.is_dir() else [path]
    for file in files:
        with open(file, "rb") as opened:
            start = opened.read(8)
        if start.startswith(_MCAP):
            _check_mcap(file)
        elif start.startswith(b"#ROSBAG"):
            _check_rosbag1(file)
        elif start[:4] == b"\x28\xb5\x2f\xfd" or start[1:4] == b"\x2a\x4d\x18":  # of zstd
            _check_packed(file)


def _check_packed(path: Path) -> None:
    """Count what the library would unpack to the disk, and then trust."""
    with Bounded(path, pa.input_stream(str(path), compression="zstd")) as whole:
        if whole.read(_STEP).startswith(_MCAP):
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
                check_chunk(path, _grown(data, "zstd"))


def _check_mcap(path: Path) -> None:
    with open(path, "rb") as file:
        size = path.stat().st_size
        file.seek(max(0, size - len(_MCAP_END)))
        if file.read() != _MCAP_END:
            raise InputError(
                f"{path} ends in the middle, after {size} bytes: was it copied whole, its recorder ended? "
                "mcap recover FILE -o WHOLE makes a whole file of what is there"
            )
        declared = 0
        for piece in _pieces(file, path.stat().st_size):
            declared += piece.declared
            check_chunk(path, piece.declared)
            check_chunk(path, _expanded(file, piece))
    check_expansion(path, declared // 2)  # each is in the data and in the index


def _pieces(file: IO[bytes], end: int) -> Iterator[_Piece]:
    """Those in the chunks, and those to which the index leads: the library believes it."""
    place = 8
    while place + 9 <= end:
        file.seek(place)
        kind, size = unpack("<BQ", file.read(9))
        start, place = place + 9, place + 9 + size
        if place > end:
            return  # cut off, as the library will say
        if kind == _CHUNK:
            yield _chunk(file, start)
        elif kind == _CHUNK_INDEX:
            yield _indexed(BytesIO(file.read(size)))


def _check_rosbag1(path: Path) -> None:
    with open(path, "rb") as file:
        pieces, index = _ros1_pieces(file, path.stat().st_size)
        if not index <= set(pieces):
            raise InputError(f"{path} is not read: its index leads to where no piece of it begins")
        for piece in pieces.values():
            check_chunk(path, piece.declared)
            check_chunk(path, _expanded(file, piece))
    check_expansion(path, sum(piece.declared for piece in pieces.values()))


def _ros1_pieces(file: IO[bytes], end: int) -> tuple[dict[int, _Piece], set[int]]:
    """The pieces by where their records begin, and where the index says that they do."""
    pieces: dict[int, _Piece] = {}
    index: set[int] = set()
    place = _ROS1_START
    while place + 8 <= end:
        file.seek(place)
        fields = _ros1_fields(BytesIO(_part(file)))
        (size,) = unpack("<I", file.read(4))
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


def _chunk(file: IO[bytes], start: int) -> _Piece:
    *_, declared, _ = unpack("<QQQI", file.read(28))
    codec = _word(file)
    (size,) = unpack("<Q", file.read(8))
    return _Piece(start + 40 + len(codec), size, codec, declared)


def _indexed(record: IO[bytes]) -> _Piece:
    *_, chunk, _ = unpack("<QQQQ", record.read(32))
    _word(record)  # where the messages of each topic begin
    record.read(8)
    codec = _word(record)
    size, declared = unpack("<QQ", record.read(16))
    return _Piece(chunk + 9 + 40 + len(codec), size, codec, declared)


def _word(record: IO[bytes]) -> str:
    return _part(record).decode("latin-1")


def _part(record: IO[bytes]) -> bytes:
    """Bytes after their number; none at the end."""
    return record.read(int.from_bytes(record.read(4), "little"))


def _expanded(file: IO[bytes], piece: _Piece) -> int:
    """[bytes] What it really becomes."""
    if piece.codec not in _CODECS:
        return 0
    file.seek(piece.start)
    return _grown(file.read(min(piece.size, fstat(file.fileno()).st_size)), piece.codec)


def _grown(packed: bytes, codec: str) -> int:
    """[bytes] What is packed becomes; counting ends beyond what is read at once."""
    total = 0
    with pa.CompressedInputStream(pa.BufferReader(packed), codec) as stream:
        while total <= LARGEST_CHUNK and (part := stream.read(_STEP)):
            total += len(part)
    return total
