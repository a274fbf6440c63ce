"""Parquet, a group of rows at a time; units from the names, or from a field's metadata."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from zwidth.identification.logs.table import PIECE, Table, Values
from zwidth.reading import check_parquet


def parquet_table(path: Path) -> Table:
    """The table in a Parquet file."""
    schema = pq.read_schema(path)
    metadata = schema.metadata or {}
    numbers = [field for field in schema if _is_number(field.type)]
    return Table(
        source=str(path),
        units={field.name: _unit(field) for field in numbers},
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


def _read(path: Path, names: tuple[str, ...]) -> Iterator[tuple[Values, ...]]:
    check_parquet(path, set(names))
    with pq.ParquetFile(path, pre_buffer=False) as file:
        for batch in file.iter_batches(batch_size=PIECE, columns=list(dict.fromkeys(names))):
            yield tuple(_values(batch.column(batch.schema.get_field_index(name))) for name in names)


def _values(column: pa.Array) -> Values:
    if pa.types.is_timestamp(column.type):
        return np.asarray(column.cast(pa.timestamp("ns")).to_numpy(zero_copy_only=False))
    if pa.types.is_decimal(column.type) or (pa.types.is_integer(column.type) and column.null_count):
        column = column.cast(pa.float64())
    return np.asarray(column.to_numpy(zero_copy_only=False))
