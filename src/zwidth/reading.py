"""What a file of others may be expanded to is bounded, and everything comes from that file alone.

A small file can declare, or be expanded to, more than any memory holds, and a container can name
other files of the reader's.  Both are refused before anything is expanded or opened.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from contextlib import suppress
from importlib import import_module
from io import BytesIO
from math import prod
from pathlib import Path
from typing import TYPE_CHECKING, Any
from zlib import decompressobj

from zwidth.errors import InputError
from zwidth.installing import library, parquet
from zwidth.showing import printable

if TYPE_CHECKING:
    import h5py
    import xarray as xr

FREE = 2**31
"""[bytes] What any file may be expanded to."""

RATIO = 200
"""What a larger one may be expanded to, in multiples of its own size: recordings do not reach it."""

LARGEST_CHUNK = 2**28
"""[bytes] Largest piece that is compressed by itself."""

_DEFLATE, _MOST_DEFLATED = 1, 1032
"""The filter's number in HDF5, and the most bytes that it makes of one."""

_STEP = 2**20


_OF_PYTHON = {"bz2": "bz2", "zstd": "compression.zstd"}
"""Modules of Python that expand what is compressed so; zstd from 3.14 on."""


def unpacking(path: Path, codec: str, piece: bytes | None = None) -> Any:
    """A stream of what a file, or a piece of it, expands to: zstd, lz4, or bz2."""
    if codec in _OF_PYTHON:
        with suppress(ImportError):
            return import_module(_OF_PYTHON[codec]).open(path if piece is None else BytesIO(piece))
    pa = library("pyarrow", f"{path} is not read: {codec}, by which it is compressed,")
    return pa.CompressedInputStream(str(path) if piece is None else pa.BufferReader(piece), codec)


def shown_only(data: xr.Dataset, path: Path) -> xr.Dataset:
    """A Dataset of a file, its attributes without what a terminal or a page would obey."""
    if not all(str(name).isprintable() for name in (*data.variables, *data.dims)):
        raise InputError(f"{path} is not read: a name in it holds control characters")
    parts: list[Any] = [data, *data.variables.values()]
    for each in parts:
        told = each.attrs.items()
        each.attrs = {printable(str(k)): printable(v) if isinstance(v, str) else v for k, v in told}
    return data


def check_expansion(path: Path, expanded: int) -> None:
    """Refuse a file that is expanded to so many bytes."""
    size = path.stat().st_size
    if expanded > max(FREE, RATIO * size):
        raise InputError(
            f"{path} is not read: its {size} bytes would become {expanded} or more, and no recording "
            f"becomes {RATIO} times as many, or {FREE}; if it is one, write it without compression"
        )


def check_chunk(path: Path, size: int) -> None:
    """Refuse a piece that is compressed by itself and has so many bytes."""
    if size > LARGEST_CHUNK:
        raise InputError(
            f"{path} is not read: a piece of it would become {size} bytes, and at most {LARGEST_CHUNK} are "
            "read at once; write it in smaller pieces"
        )


def check_dataset(path: Path, data: h5py.Dataset) -> None:
    """Refuse a dataset of HDF5 whose numbers are in another place, or too many for this file."""
    if data.external or data.is_virtual:
        raise InputError(f"{path} is not read: the numbers of {data.name} are elsewhere; copy them into it")
    check_expansion(path, data.size * data.dtype.itemsize if data.shape else 0)
    if data.chunks:
        check_chunk(path, prod(data.chunks) * data.dtype.itemsize)
        _check_deflated(path, data)


def check_hdf5(path: Path) -> None:
    """Refuse a file of HDF5 that leads to other files, or declares more numbers than it can hold."""
    import h5py  # takes its time

    datasets: list[h5py.Dataset] = []

    def visit(_: str, item: Any) -> None:
        if isinstance(item, h5py.Dataset):
            datasets.append(item)

    def leads_out(name: str, link: Any) -> str | None:
        return name if isinstance(link, h5py.ExternalLink) else None

    with h5py.File(path, "r") as file:
        elsewhere = file.visititems_links(leads_out)
        if elsewhere is not None:
            raise InputError(f"{path} is not read: its {elsewhere} is in another file; copy it into this one")
        file.visititems(visit)
        for data in datasets:
            check_dataset(path, data)
        check_expansion(path, sum((data.size or 0) * data.dtype.itemsize for data in datasets))


def _check_deflated(path: Path, data: h5py.Dataset) -> None:
    """HDF5 expands a chunk to its end, whatever the chunk should be: count those that could become large."""
    filters = data.id.get_create_plist()
    deflated = [filters.get_filter(k)[0] for k in range(filters.get_nfilters())].count(_DEFLATE)
    if deflated > 1:
        raise InputError(f"{path} is not read: {data.name} is compressed {deflated} times over")
    suspects: list[Any] = []

    def visit(chunk: Any) -> None:
        if chunk.filter_mask == 0 and chunk.size * _MOST_DEFLATED > LARGEST_CHUNK:
            suspects.append(chunk.chunk_offset)

    if deflated:
        data.id.chunk_iter(visit)
    for offset in suspects:
        stored = data.id.read_direct_chunk(offset)[1]
        check_chunk(path, inflated([stored], LARGEST_CHUNK))


def inflated(pieces: Iterable[bytes], most: int) -> int:
    """[bytes] What a stream of zlib becomes; counting ends beyond `most`."""
    stream, total = decompressobj(), 0
    for piece in pieces:
        while piece and total <= most:
            total += len(stream.decompress(piece, _STEP))
            piece = stream.unconsumed_tail
    return total


_LIST = re.compile(r"\.list\.(element|item)$")
"""What Parquet puts behind the name of a column of lists."""


def check_parquet(path: Path, columns: set[str] | None = None) -> None:
    """Refuse a file of Parquet that declares more than it can hold, in these columns or in all."""
    about = parquet(f"{path} is not read").read_metadata(path)
    parts = [
        part
        for k in range(about.num_row_groups)
        for part in map(about.row_group(k).column, range(about.num_columns))
        if columns is None or _LIST.sub("", part.path_in_schema) in columns
    ]
    width = about.num_columns if columns is None else len(columns)
    check_expansion(path, max(8 * width * about.num_rows, sum(p.total_uncompressed_size for p in parts)))


class Bounded:
    """A stream that is expanded as it is read, and refused when that was too much."""

    def __init__(self, path: Path, stream: Any) -> None:
        self._path, self._stream, self._expanded = path, stream, 0

    def read(self, size: int) -> bytes:
        """At most so many bytes."""
        piece: bytes = self._stream.read(size)
        self._expanded += len(piece)
        check_expansion(self._path, self._expanded)
        return piece

    def __enter__(self) -> Bounded:
        return self

    def __exit__(self, *_: object) -> None:
        self._stream.close()
