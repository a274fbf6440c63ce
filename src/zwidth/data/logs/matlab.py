"""MATLAB files: 7.3 is HDF5; older ones are read whole, so there is a limit to their size."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from struct import unpack
from typing import IO, Any

import numpy as np
from scipy.io import loadmat
from scipy.io.matlab import mat_struct

from zwidth.data.logs.table import MOST_COLUMNS, Table, Values, in_pieces
from zwidth.errors import InputError
from zwidth.reading import FREE, RATIO, check_expansion, inflated

LARGEST = 2**30
"""[bytes] Largest file that is read whole; MATLAB's own limit for a variable in it is 2 GiB."""

_HEADER, _COMPRESSED = 128, 15
"""Bytes before the first variable, and the type of one that is compressed."""

_ORDERS = {b"MI": ">", b"IM": "<"}
_PIECE = 2**20


def matlab_table(path: Path) -> Table:
    """The vectors in a file of MATLAB 4 to 7.2, structures included."""
    size = path.stat().st_size
    if size > LARGEST:
        raise InputError(
            f"{path} has {size >> 20} MiB; MATLAB files before 7.3 are read whole, up to {LARGEST >> 20}; "
            'save it with "-v7.3"'
        )
    check_expansion(path, _expanded(path))
    columns: dict[str, Values] = {}
    for name, value in loadmat(path, squeeze_me=True, struct_as_record=False).items():
        if not name.startswith("__"):
            columns.update(_vectors(name, value))

    return Table(
        source=str(path),
        units=dict.fromkeys(columns),
        read=lambda names: in_pieces(str(path), columns, names),
    )


def _expanded(path: Path) -> int:
    """[bytes] What the compressed variables of a file of MATLAB 5 to 7.2 are, up to what is read of them."""
    most = max(FREE, RATIO * path.stat().st_size)
    total = 0
    with open(path, "rb") as file:
        order = _ORDERS.get(file.read(_HEADER)[-2:])
        if order is None:
            return 0  # of MATLAB 4, which compresses nothing
        while total <= most and len(tag := file.read(8)) == 8:
            kind, size = unpack(f"{order}II", tag)
            if kind == 0:  # zeros that were never written
                break
            place = file.tell() + size
            if kind == _COMPRESSED:
                total += inflated(_pieces(file, size), most - total)
            file.seek(place)
    return total


def _pieces(file: IO[bytes], size: int) -> Iterator[bytes]:
    """The next so many bytes, a megabyte at a time."""
    while size > 0 and (piece := file.read(min(size, _PIECE))):
        size -= len(piece)
        yield piece


def _vectors(name: str, value: Any) -> dict[str, Values]:
    """Vectors in a variable: itself, the columns of a matrix, or what its fields hold."""
    if isinstance(value, mat_struct):
        parts = [_vectors(f"{name}.{field}", getattr(value, field)) for field in value._fieldnames]
        return {key: vector for part in parts for key, vector in part.items()}
    array = np.asarray(value)
    if array.dtype.kind not in "fiu" or array.ndim not in (1, 2) or array.size < 2:
        return {}
    if array.ndim == 1:
        return {name: array}
    if array.shape[1] > min(array.shape[0], MOST_COLUMNS):
        array = array.T
    if array.shape[1] > MOST_COLUMNS:
        return {}
    return {f"{name}[{k}]": array[:, k] for k in range(array.shape[1])}
