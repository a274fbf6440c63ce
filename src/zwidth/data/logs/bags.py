"""ROS bags, sqlite or MCAP: the numbers in the messages of each topic, by path, "/joint_states.position[0]".

A sample's stamp is that of its message's header, or else when it was recorded.
A column of another topic is taken from the message nearest in time, at most
half a period away.  Messages are unpacked one by one, and their numbers held in memory.
"""

from __future__ import annotations

from array import array
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from zwidth.data.logs.block import Finding
from zwidth.data.logs.pieces import check_bag, check_messages
from zwidth.data.logs.table import MOST_COLUMNS, Table, Values, in_pieces
from zwidth.errors import InputError

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
