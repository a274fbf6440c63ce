"""NetCDF 4, HDF5 and MATLAB 7.3: datasets by path, read a slice at a time."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import h5py
import numpy as np

from zwidth.data.logs.table import MOST_COLUMNS, PIECE, Table, Values, check_lengths
from zwidth.reading import check_dataset


class _Column(NamedTuple):
    """A column: its dataset, rows and unit; its field, or whether it is upright in a matrix and which."""

    dataset: str
    rows: int
    unit: str | None
    where: str | tuple[bool, int] | None
    packing: tuple[float, float, float | None]


def hdf5_table(path: Path) -> Table:
    """The datasets of numbers in a file, nested groups included."""
    columns: dict[str, _Column] = {}
    with h5py.File(path, "r") as file:
        attributes = {key: _plain(value) for key, value in file.attrs.items()}

        def visit(name: str, item: Any) -> None:
            if isinstance(item, h5py.Dataset) and not name.startswith("#"):
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
    packing = tuple(_number(data, k) for k in ("scale_factor", "add_offset", "_FillValue"))
    about = (1.0 if packing[0] is None else packing[0], packing[1] or 0.0, packing[2])
    if data.dtype.names and len(data.shape) == 1:
        fields = [f for f in data.dtype.names if data.dtype[f].kind in "fiu"]
        return {f"{name}.{f}": _Column(name, data.shape[0], None, f, about) for f in fields}
    if data.dtype.kind not in "fiu" or len(data.shape) not in (1, 2) or 0 in data.shape:
        return {}
    if len(data.shape) == 1:
        return {name: _Column(name, data.shape[0], unit, None, about)}
    rows, width = data.shape
    upright = width <= min(rows, MOST_COLUMNS)
    count, length = (width, rows) if upright else (rows, width)
    if count > MOST_COLUMNS:
        return {}
    return {
        name if count == 1 else f"{name}[{k}]": _Column(name, length, unit, (upright, k), about)
        for k in range(count)
    }


def _part(data: Any, column: _Column, start: int, end: int) -> Values:
    """Rows of a column from its dataset."""
    if column.where is None:
        return np.asarray(data[start:end])
    if isinstance(column.where, str):
        return np.asarray(data.fields(column.where)[start:end])
    upright, k = column.where
    return np.asarray(data[start:end, k] if upright else data[k, start:end])


def _read(path: Path, columns: list[_Column], names: tuple[str, ...]) -> Iterator[tuple[Values, ...]]:
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
