"""Parquet, a group of rows at a time; units from the names, or from a field's metadata."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.parquet as pq

from zwidth.data.logs.table import MOST_COLUMNS, PIECE, Table, Values
from zwidth.errors import InputError
from zwidth.reading import check_parquet

_EPISODES = {"episode_index", "frame_index"}
"""Beside these a timestamp is that of a LeRobot dataset, in seconds of its episode."""


def parquet_table(path: Path) -> Table:
    """The table in a Parquet file."""
    schema = pq.read_schema(path)
    again = next((name for name in schema.names if schema.names.count(name) > 1), None)
    if again is not None:
        raise InputError(f'{path} has more than one column "{again}"; give each a name of its own')
    metadata = schema.metadata or {}
    units = {field.name: _unit(field) for field in schema if _is_number(field.type)}
    for field in schema:
        if _is_list(field.type) and _is_number(field.type.value_type):
            units |= {f"{field.name}[{k}]": _unit(field) for k in range(_length(path, field))}
    if units.get("timestamp", "") is None and set(units) >= _EPISODES:
        units["timestamp"] = "s"
    return Table(
        source=str(path),
        units=units,
        read=lambda names: _read(path, names),
        attributes=json.loads(metadata.get(b"zwidth", b"{}")),
    )


def _is_number(kind: pa.DataType) -> bool:
    types = pa.types
    return bool(
        types.is_integer(kind)
        or types.is_floating(kind)
        or types.is_boolean(kind)
        or types.is_decimal(kind)
        or types.is_timestamp(kind)
    )


def _unit(field: pa.Field) -> str | None:
    if pa.types.is_timestamp(field.type):
        return "ns"
    metadata = field.metadata or {}
    stated = metadata.get(b"units", metadata.get(b"unit"))
    return stated.decode("utf-8", "replace") if stated else None


def _is_list(kind: pa.DataType) -> bool:
    types = pa.types
    return bool(types.is_list(kind) or types.is_large_list(kind) or types.is_fixed_size_list(kind))


def _length(path: Path, field: pa.Field) -> int:
    """Of the list in every row, by the first one; 0 where it is no vector of a few numbers."""
    check_parquet(path, {field.name})
    with pq.ParquetFile(path, pre_buffer=False) as file:
        batch = next(file.iter_batches(batch_size=1, columns=[field.name]), None)
    first = None if batch is None or not batch.num_rows else batch.column(0)[0].as_py()
    return len(first) if first is not None and len(first) <= MOST_COLUMNS else 0


def _read(path: Path, names: tuple[str, ...]) -> Iterator[tuple[Values, ...]]:
    schema = pq.read_schema(path)
    parts = [_part(name, schema) for name in names]
    fields = list(dict.fromkeys(field for field, _ in parts))
    check_parquet(path, set(fields))
    with pq.ParquetFile(path, pre_buffer=False) as file:
        for batch in file.iter_batches(batch_size=PIECE, columns=fields):
            columns = {field: batch.column(batch.schema.get_field_index(field)) for field in fields}
            yield tuple(_values(_element(columns[field], k)) for field, k in parts)


def _part(name: str, schema: pa.Schema) -> tuple[str, int | None]:
    """ "observation.state[3]" as the field and the place in its list; None where the field is a number."""
    if name in schema.names:
        return name, None
    field, _, index = name[:-1].rpartition("[")
    return field, int(index)


def _element(column: pa.Array, k: int | None) -> pa.Array:
    """One number of a list in every row; not a number where there is no such list."""
    if k is None:
        return column
    if pa.types.is_fixed_size_list(column.type):
        column = column.cast(pa.list_(column.type.value_type))
    lengths = pc.fill_null(pc.list_value_length(column), 0)
    if pc.all(pc.greater(lengths, k)).as_py():
        return pc.list_element(column, k)
    return pa.array(
        [row[k] if row is not None and len(row) > k else None for row in column.to_pylist()], pa.float64()
    )


def _values(column: pa.Array) -> Values:
    if pa.types.is_timestamp(column.type):
        return np.asarray(column.cast(pa.timestamp("ns")).to_numpy(zero_copy_only=False))
    if pa.types.is_decimal(column.type) or (pa.types.is_integer(column.type) and column.null_count):
        column = column.cast(pa.float64())
    return np.asarray(column.to_numpy(zero_copy_only=False))
