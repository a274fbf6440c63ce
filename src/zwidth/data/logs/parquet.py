"""Parquet, a group of rows at a time; units from the names, or from a field's metadata.

A file of a LeRobot dataset is one: what a number of a list is called stands in the dataset's own
meta/info.json, and its unit nowhere.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping
from functools import partial
from itertools import chain
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.parquet as pq

from zwidth.data.logs.table import LEFT_OUT, MOST_COLUMNS, PIECE, Finding, Table, Values, listed, readable
from zwidth.errors import InputError
from zwidth.quantity.text import shown
from zwidth.reading import check_parquet

_EPISODES = {"episode_index", "frame_index"}
"""Beside these a timestamp is that of a LeRobot dataset, in seconds of its episode."""

_UNNAMED = re.compile(r"__index_level_\d+__")
"""What pandas calls an index without a name."""

_DAY = 86400 * 10**9
"""[ns]"""

_TEXTS = (pa.float64(), pa.timestamp("ns"), pa.timestamp("ns", "UTC"))
"""What a text may spell; sixteen digits and more are no double."""

_Part = tuple[str, int | None, pa.DataType]
"""The field that a column is in, its place in the field's list, and the type that it is read as."""


def parquet_table(path: Path, files: list[Path], episode: str | None = None) -> Table:
    """Of a file, or of those of a LeRobot dataset; of that the episode of this number, or all."""
    with readable(str(files[0])):
        schema = pq.read_schema(files[0])
    again = next((name for name in schema.names if schema.names.count(name) > 1), None)
    if again is not None:
        raise InputError(f'{path} has more than one column "{again}"; give each a name of its own')
    dataset = _dataset(files[0])
    parts: dict[str, _Part] = {}
    units: dict[str, str | None] = {}
    for field in schema:
        for name, part in _parts(files[0], field, dataset):
            parts[name] = part
            units[name] = "ns" if _is_time(part[2]) else _unit(field)
    notes: dict[str, Finding] = {}
    likely: dict[str, str] = {}
    if units.get("timestamp", "") is None and set(units) >= _EPISODES:
        units["timestamp"] = "s"
        notes = {finding.kind: finding for finding in _of_episodes(path, files, episode)}
        likely = {name: _likely(dataset, name) for name, (_, place, _) in parts.items() if place is not None}
    elif episode is not None or len(files) > 1:
        told = (
            f"name one of its files, such as {files[0]}" if path.is_dir() else f'leave sheet="{episode}" out'
        )
        raise InputError(f"{path} is no workbook and no LeRobot dataset: {told}")
    return Table(
        source=str(path),
        units=units,
        read=lambda names: (
            piece for file in files for piece in _read(file, [parts[name] for name in names], episode)
        ),
        attributes=json.loads((schema.metadata or {}).get(b"zwidth", b"{}")),
        notes=notes,
        likely=likely,
    )


def _parts(path: Path, field: pa.Field, dataset: Mapping[str, Any]) -> Iterator[tuple[str, _Part]]:
    types, kind = pa.types, field.type
    if _is_number(kind) or _is_time(kind):
        unnamed = _UNNAMED.fullmatch(field.name) and _is_time(kind)
        yield "time (index)" if unnamed else field.name, (field.name, None, kind)
    elif types.is_string(kind) or types.is_large_string(kind):
        if (spelled := _spelled(_first(path, field.name))) is not None:
            yield field.name, (field.name, None, spelled)
    elif types.is_list(kind) or types.is_large_list(kind) or types.is_fixed_size_list(kind):
        first = _first(path, field.name) if _is_number(kind.value_type) else None
        if first is not None and len(first) <= MOST_COLUMNS:
            for k, name in enumerate(_names(dataset, field.name, len(first))):
                yield f"{field.name}[{name}]", (field.name, k, kind.value_type)


def _is_number(kind: pa.DataType) -> bool:
    types = pa.types
    return any(
        is_one(kind) for is_one in (types.is_integer, types.is_floating, types.is_boolean, types.is_decimal)
    )


def _is_time(kind: pa.DataType) -> bool:
    types = pa.types
    return bool(types.is_timestamp(kind) or types.is_duration(kind) or types.is_time(kind))


def _unit(field: pa.Field) -> str | None:
    metadata = field.metadata or {}
    stated = metadata.get(b"units", metadata.get(b"unit"))
    return stated.decode("utf-8", "replace") if stated else None


def _first(path: Path, name: str) -> Any:
    check_parquet(path, {name})
    with pq.ParquetFile(path, pre_buffer=False) as file:
        batch = next(file.iter_batches(batch_size=1, columns=[name]), None)
    return None if batch is None or not batch.num_rows else batch.column(0)[0].as_py()


def _spelled(text: str | None) -> pa.DataType | None:
    """What a text is: a number or a date; None where it is neither."""
    if text and text.isdecimal() and len(text) > 15:
        return pa.int64()
    for kind in _TEXTS if text else ():
        try:
            pa.scalar(text).cast(kind)
        except pa.ArrowInvalid:
            continue
        return kind
    return None


def _read(path: Path, parts: list[_Part], episode: str | None) -> Iterator[tuple[Values, ...]]:
    fields = list(dict.fromkeys([field for field, *_ in parts] + ["episode_index"] * (episode is not None)))
    check_parquet(path, set(fields))
    days = [partial(_days, []) if pa.types.is_time(kind) else np.asarray for *_, kind in parts]
    with pq.ParquetFile(path, pre_buffer=False) as file:
        if missing := [field for field in fields if field not in file.schema_arrow.names]:
            raise InputError(f"{path} has no column {listed(missing)}, as the first file of its folder has")
        for batch in file.iter_batches(batch_size=PIECE, columns=fields):
            if episode is not None:
                batch = batch.filter(pc.equal(batch["episode_index"], int(episode)))
            columns = {field: batch.column(batch.schema.get_field_index(field)) for field in fields}
            yield tuple(
                of_days(_values(_element(columns[field], k), kind))
                for (field, k, kind), of_days in zip(parts, days, strict=True)
            )


def _days(before: list[Any], times: Values) -> Values:
    """Times of day [ns] that go on past midnight, from piece to piece."""
    on = np.unwrap(np.concatenate([np.asarray(before, times.dtype), times]), period=_DAY)[len(before) :]
    before[:] = on[-1:].tolist()
    return on


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


def _values(column: pa.Array, kind: pa.DataType) -> Values:
    if column.type != kind and not pa.types.is_floating(column.type):  # a text
        column = column.cast(kind)
    if pa.types.is_timestamp(kind):
        return np.asarray(column.cast(pa.timestamp("ns")).to_numpy(zero_copy_only=False))
    if _is_time(kind):
        column = column.cast(pa.duration("ns") if pa.types.is_duration(kind) else pa.time64("ns")).cast(
            pa.int64()
        )
    if pa.types.is_decimal(kind) or (pa.types.is_integer(column.type) and column.null_count):
        column = column.cast(pa.float64())
    return np.asarray(column.to_numpy(zero_copy_only=False))


# LeRobot: meta/info.json beside data/chunk-000/….parquet, one episode in each up to v2.1, many from v3.0 on.
# Which unit its numbers have depends on the robot and on the version that recorded it (huggingface/lerobot:
# datasets/utils.py; `use_degrees` of robots/*/config_*.py, v0.3.2 to v0.6.1, docs/source/backwardcomp.mdx).


def _dataset(path: Path) -> dict[str, Any]:
    """What the dataset that a file belongs to says of itself; nothing where it belongs to none."""
    about = path.resolve().parent.parent.parent / "meta" / "info.json"
    if not about.is_file():
        return {}
    try:
        said = json.loads(about.read_text(encoding="utf-8"))
    except ValueError:
        raise InputError(
            f"{about}, which says what {path} holds, is no JSON: mend it, or move the file"
        ) from None
    return said if isinstance(said, dict) else {}


def _names(dataset: Mapping[str, Any], field: str, size: int) -> list[Any]:
    """What the places of a list are called, as a list or inside a list or table; else their numbers."""
    try:
        names = dataset["features"][field]["names"]
        values = names.values() if isinstance(names, dict) else names
        if lists := [each for each in values if isinstance(each, list)]:
            names = list(chain(*lists))
        elif isinstance(names, dict):
            names = sorted(names, key=lambda name: int(names[name]))
        named = len(names) == len(set(names)) == size and all(name.isprintable() for name in names)
    except (KeyError, TypeError, ValueError, AttributeError):
        named = False
    return names if named else list(range(size))


def _of_episodes(path: Path, files: list[Path], chosen: str | None) -> Iterator[Finding]:
    """What the stamps are, and which episodes there are; `files` keeps those with the one that is chosen."""
    names = ["timestamp", "frame_index", "episode_index"]
    for file in files:
        with readable(str(file)):
            check_parquet(file, set(names))
    each = [pq.read_table(file, columns=names) for file in files]
    time, frame, episode = (column.to_numpy() for column in pa.concat_tables(each).columns)
    late = frame > 0
    periods = time[late].astype(float) / frame[late]
    if periods.size and np.ptp(periods) < 1e-4 * abs(periods[0]):
        text = (
            f'"timestamp" is frame_index / {shown(1 / np.median(periods), "Hz")} and no clock: the file does '
            "not say when a frame was taken, or whether one is missing"
        )
        yield Finding(kind="no clock", text=text)
    every = np.unique(episode)
    said = f"{every.size} episodes of a LeRobot dataset, {every[0]} to {every[-1]}"
    if chosen is not None:
        held = [chosen in map(str, pc.unique(one["episode_index"]).to_pylist()) for one in each]
        if not any(held):
            raise InputError(f'{path} has no episode "{chosen}": there are {said}')
        files[:] = [file for file, has in zip(files, held, strict=True) if has]
    if every.size > 1:
        text = (
            f"{said}, each a run of its own" if chosen is None else f"episode {chosen} of {said}: {LEFT_OUT}"
        )
        yield Finding(kind="episodes", text=text)


_ROBOTS = {
    "openarm": "",
    "so10": "0.4.4",
    "so_follower": "0.4.4",
    "lekiwi": "0.6.0",
    "koch": None,
    "omx": None,
}
"""Since which version of LeRobot a robot's joints are recorded in degrees, unless its owner says otherwise:
always, since one of those that write datasets of v3.0, or not at all."""


def _likely(dataset: Mapping[str, Any], column: str) -> str:
    """What a number in a list is likely to be, for who has to state its unit."""
    robot, version = (str(dataset.get(key, "")) for key in ("robot_type", "codebase_version"))
    known = next((name for name in _ROBOTS if name in robot), None)
    range_of = "0 … 100 of its range" if "gripper" in column else "-100 … 100 of its range"
    if known is None:
        said = f"LeRobot writes degrees or {range_of}, as use_degrees says where it was recorded"
    else:
        since = _ROBOTS[known] if version >= "v3" or known == "openarm" else None
        if since == "" or not column.endswith(".pos]"):  # of before June 2025
            said = "mostly degrees"
        elif since is None or "gripper" in column:
            said = f"mostly {range_of}"
        else:
            said = f"mostly degrees since LeRobot {since}, before {range_of}"
        said = f"a {robot} of LeRobot ({version}) has {said}"
    return (
        f'{said}; a share of a range needs scale={{"position": "0.9 deg/count"}}, what one is by calibration'
    )
