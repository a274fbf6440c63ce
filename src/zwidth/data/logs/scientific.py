"""Files of scientific programs: HDF5 (NetCDF 4, MATLAB 7.3) by path and slice; older MATLAB files whole, and
those of NumPy, of which nothing is read that is pickled."""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Mapping
from io import BytesIO
from math import prod
from pathlib import Path
from struct import unpack
from typing import IO, TYPE_CHECKING, Any, NamedTuple
from zipfile import ZipFile, is_zipfile

import numpy as np
from numpy.lib import format as npy

from zwidth.data.logs.columns import is_unit, name_and_unit
from zwidth.data.logs.table import MOST_COLUMNS, PIECE, Finding, Table, Values, check_lengths, in_pieces
from zwidth.errors import InputError
from zwidth.reading import FREE, RATIO, check_dataset, check_expansion, inflated

if TYPE_CHECKING:
    import h5py


class _Column(NamedTuple):
    """A column: its dataset, rows and unit; its field, or whether it is upright in a matrix and which."""

    dataset: str
    rows: int
    unit: str | None
    where: str | tuple[bool, int] | None
    packing: tuple[float, float, float | None]


def hdf5_table(path: Path) -> Table:
    """The datasets of numbers in a file, nested groups included."""
    import h5py

    columns: dict[str, _Column] = {}
    with h5py.File(path, "r") as file:
        attributes = {key: _plain(value) for key, value in file.attrs.items()}

        def visit(name: str, item: Any) -> None:
            if not isinstance(item, h5py.Dataset) or name.startswith("#"):
                return
            if h5py.check_ref_dtype(item.dtype) is h5py.Reference and item.size <= MOST_COLUMNS:
                for k, leads in enumerate(np.ravel(item[()])):  # structures in a list, as MATLAB 7.3 has them
                    if leads and isinstance(file[leads], h5py.Dataset):
                        columns.update(_columns(f"{name}[{k}]", file[leads]))
            else:
                columns.update(_columns(name, item))

        file.visititems(visit)
    return Table(
        source=str(path),
        units={name: column.unit for name, column in columns.items()},
        read=lambda names: _read(path, [columns[name] for name in names], names),
        attributes=attributes,
    )


def _columns(name: str, data: h5py.Dataset) -> dict[str, _Column]:
    """The columns in a dataset: itself, its fields, or the columns of a matrix."""
    unit = next((_plain(data.attrs[k]) for k in ("units", "unit", "Units", "Unit") if k in data.attrs), None)
    unit = unit if isinstance(unit, str) else None
    where = str(data.name)
    packing = tuple(_number(data, k) for k in ("scale_factor", "add_offset", "_FillValue"))
    about = (1.0 if packing[0] is None else packing[0], packing[1] or 0.0, packing[2])
    if data.dtype.names and len(data.shape) == 1:
        fields = [f for f in data.dtype.names if data.dtype[f].kind in "fiu"]
        return {f"{name}.{f}": _Column(where, data.shape[0], None, f, about) for f in fields}
    text = data.attrs.get("MATLAB_class") == b"char"
    if text or data.dtype.kind not in "fiu" or len(data.shape) not in (1, 2) or 0 in data.shape:
        return {}
    if len(data.shape) == 1:
        return {name: _Column(where, data.shape[0], unit, None, about)}
    rows, width = data.shape
    upright = width <= min(rows, MOST_COLUMNS)
    count, length = (width, rows) if upright else (rows, width)
    if count > MOST_COLUMNS:
        return {}
    return {
        name if count == 1 else f"{name}[{k}]": _Column(where, length, unit, (upright, k), about)
        for k in range(count)
    }


def _part(data: Any, column: _Column, start: int, end: int) -> Values:
    if column.where is None:
        return np.asarray(data[start:end])
    if isinstance(column.where, str):
        return np.asarray(data.fields(column.where)[start:end])
    upright, k = column.where
    return np.asarray(data[start:end, k] if upright else data[k, start:end])


def _read(path: Path, columns: list[_Column], names: tuple[str, ...]) -> Iterator[tuple[Values, ...]]:
    import h5py

    sizes = {name: column.rows for name, column in zip(names, columns, strict=True)}
    rows = check_lengths(str(path), sizes)
    with h5py.File(path, "r") as file:
        data = [file[column.dataset] for column in columns]
        for one in data:
            check_dataset(path, one)
        step = max(PIECE, *((d.chunks or (1,))[0] if len(d.shape) == 1 else 1 for d in data))
        for k in range(0, rows, step):
            yield tuple(
                _unpacked(_part(d, c, k, min(rows, k + step)), c) for c, d in zip(columns, data, strict=True)
            )


def _unpacked(values: Values, column: _Column) -> Values:
    factor, offset, fill = column.packing
    if fill is not None and not np.isnan(fill):
        missing = values == values.dtype.type(fill)
        if missing.any():
            values = np.where(missing, np.nan, values.astype(np.float64))
    if factor != 1.0 or offset != 0.0:
        values = values * factor + offset
    return values


def _number(data: h5py.Dataset, key: str) -> float | None:
    if key not in data.attrs:
        return None
    value = np.asarray(data.attrs[key]).ravel()
    return float(value[0]) if value.size == 1 and value.dtype.kind in "fiu" else None


def _plain(value: Any) -> Any:
    if isinstance(value, np.ndarray):
        value = value.ravel()[0] if value.size == 1 else value.tolist()
    if isinstance(value, bytes):
        return value.decode("utf-8", "replace")
    return value.item() if isinstance(value, np.generic) else value


LARGEST = 2**30
"""[bytes] Largest file that is read whole; MATLAB's own limit for a variable in it is 2 GiB."""

_HEADER, _COMPRESSED = 128, 15
"""Bytes before the first variable, and the type of one that is compressed."""

_ORDERS = {b"MI": ">", b"IM": "<"}
_PIECE = 2**20


def matlab_table(path: Path) -> Table:
    """The vectors in a file of MATLAB 4 to 7.2, structures included."""
    from scipy.io import loadmat
    from scipy.io.matlab import MatlabOpaque

    size = path.stat().st_size
    if size > LARGEST:
        raise InputError(
            f"{path} has {size >> 20} MiB; MATLAB files before 7.3 are read whole, up to {LARGEST >> 20}; "
            'save it with "-v7.3"'
        )
    check_expansion(path, _expanded(path))
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        variables = loadmat(path, squeeze_me=True, struct_as_record=False)
    own = [(name, value) for name, value in variables.items() if not name.startswith("__")]
    columns = dict(vector for each in own for vector in _vectors(*each))
    if not columns and any(isinstance(v, MatlabOpaque) for v in variables.values()):
        raise InputError(
            f"{path} holds objects, such as a timeseries or a Dataset, that MATLAB alone reads; in it: "
            "t = out.logsout{1}.Values.Time; position = out.logsout{1}.Values.Data; "
            "save('log.mat', 't', 'position', '-v7')"
        )
    table = _held(path, columns)
    for warning in said:  # without what scipy advises programmers to do
        text = str(warning.message).splitlines()[0].split(" Consider ")[0]
        table.notes[text] = Finding(kind="file", text=text)
    return table


def _held(path: Path, columns: Mapping[str, _Vector]) -> Table:
    return Table(
        source=str(path),
        units={name: unit for name, (_, unit) in columns.items()},
        read=lambda names: in_pieces(str(path), {name: columns[name][0] for name in names}, names),
    )


def numpy_table(path: Path) -> Table:
    """The vectors in a file of NumPy: one array, or an archive of named ones."""
    columns: dict[str, _Vector] = {}
    if is_zipfile(path):
        with ZipFile(path) as archive:
            members = archive.infolist()
            check_expansion(path, sum(member.file_size for member in members))
            for member in members:
                name = member.filename.removesuffix(".npy")
                columns.update(_vectors(name, _array(path, archive.read(member))))
    else:
        columns.update(_vectors("data", _array(path, path.read_bytes())))
    return _held(path, columns)


def _array(path: Path, data: bytes) -> Values:
    """What the bytes of a .npy file are, which may be fewer than its head says."""
    stream = BytesIO(data)
    version = npy.read_magic(stream)
    head = npy.read_array_header_1_0 if version == (1, 0) else npy.read_array_header_2_0
    shape, by_columns, kind = head(stream)
    if kind.hasobject:
        raise InputError(
            f"{path} holds pickled objects of Python, which are not read; save arrays of numbers"
        )
    values = np.frombuffer(data, kind, prod(shape), stream.tell())
    return values.reshape(shape, order="F" if by_columns else "C")


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


_Vector = tuple[Values, str | None]
"""Numbers, and their unit if it is stated."""


def _vectors(name: str, value: Any) -> Iterator[tuple[str, _Vector]]:
    """The vectors in a variable: itself, columns of a matrix, what fields hold; of a list each one's."""
    if hasattr(value, "_fieldnames"):  # a structure of scipy's
        found = dict(v for f in value._fieldnames for v in _vectors(f"{name}.{f}", getattr(value, f)))
        if hasattr(value, "signals") and f"{name}.time" in found:  # of Simulink, whose clock counts seconds
            found[f"{name}.time"] = (found[f"{name}.time"][0], "s")
        yield from (found | _labelled(name, value, found)).items()
        return
    array = np.asarray(value)
    if array.dtype.names and array.size > 1:
        for field in array.dtype.names:
            yield from _vectors(f"{name}.{field}", array[field])
    elif array.dtype.kind == "O" and array.ndim == 1 and array.size <= MOST_COLUMNS:
        for k, each in enumerate(array):
            yield from _vectors(f"{name}[{k}]", each)
    if array.dtype.kind not in "fiuMm" or array.ndim not in (1, 2) or array.size < 2:
        return
    unit = None
    if array.dtype.kind in "Mm":  # dates, durations
        unit, array = "ns", array.astype(f"{array.dtype.kind}8[ns]")
        array = array.astype(np.int64) if array.dtype.kind == "m" else array
    if array.ndim == 1:
        yield name, (array, unit)
        return
    if array.shape[1] > min(array.shape[0], MOST_COLUMNS):
        array = array.T
    if array.shape[1] <= MOST_COLUMNS:
        yield from ((f"{name}[{k}]", (array[:, k], unit)) for k in range(array.shape[1]))


def _labelled(name: str, signal: Any, found: Mapping[str, _Vector]) -> dict[str, _Vector]:
    """The values of a signal of Simulink by its label too, "scope.signals[0].handle position (m)"."""
    label = getattr(signal, "label", None)
    if not isinstance(label, str) or not label.strip() or f"{name}.values" not in found:
        return {}
    values, unit = found[f"{name}.values"][0], name_and_unit(label, "position")[1]
    stated = unit if unit is not None and is_unit(unit) else None
    return {f"{name}.values": (values, stated), f"{name}.{label.strip()}": (values, stated)}
