"""The pieces of a bag that are compressed, each looked at before the library expands it whole.

A bag says of each chunk what it becomes, and an index says where the chunks are; the library believes
both, and holds neither against what is in the file before it is expanded.
"""

from __future__ import annotations

from collections.abc import Iterator
from io import BytesIO
from os import fstat
from pathlib import Path
from struct import unpack
from typing import IO, Any, NamedTuple

import pyarrow as pa

from zwidth.errors import InputError
from zwidth.reading import LARGEST_CHUNK, Bounded, check_chunk, check_expansion

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
