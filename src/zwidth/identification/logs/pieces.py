"""The pieces of a bag that are compressed, each looked at before the library expands it whole.

An MCAP file says of each chunk what it becomes, in the chunk and again in the index, and nobody
holds what is in it against that before it is expanded.
"""

from __future__ import annotations

from collections.abc import Iterator
from io import BytesIO
from os import fstat
from pathlib import Path
from struct import unpack
from typing import IO, NamedTuple

import pyarrow as pa

from zwidth.reading import LARGEST_CHUNK, Bounded, check_chunk, check_expansion

_CHUNK, _CHUNK_INDEX = 0x06, 0x08
_CODECS = {"lz4": "lz4", "zstd": "zstd"}
_STEP = 2**20


class _Piece(NamedTuple):
    """Where it is in the file, how it is compressed, and what it says that it becomes."""

    start: int
    size: int
    codec: str
    declared: int


def check_bag(path: Path) -> None:
    """Refuse a bag of which a piece would become too large.

    Raises
    ------
    InputError
        If so.
    """
    for file in sorted(path.iterdir()) if path.is_dir() else [path]:
        if file.suffix == ".mcap":
            _check_mcap(file)
        elif file.suffix == ".zstd":  # the library unpacks it to the disk
            with Bounded(file, pa.input_stream(str(file), compression="zstd")) as whole:
                while whole.read(_STEP):
                    pass


def _check_mcap(path: Path) -> None:
    with open(path, "rb") as file:
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
    return record.read(unpack("<I", record.read(4))[0]).decode("latin-1")


def _expanded(file: IO[bytes], piece: _Piece) -> int:
    """[bytes] What it really becomes; counting ends beyond what is read at once."""
    if piece.codec not in _CODECS:
        return 0
    file.seek(piece.start)
    total = 0
    packed = file.read(min(piece.size, fstat(file.fileno()).st_size))
    with pa.CompressedInputStream(pa.BufferReader(packed), _CODECS[piece.codec]) as stream:
        while total <= LARGEST_CHUNK and (part := stream.read(_STEP)):
            total += len(part)
    return total
