"""A running loop for programs that read Foxglove's WebSocket."""

from __future__ import annotations

import json
import struct
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np
import pytest
from live_rows import WrittenRows
from rosbags.typesys import Stores, get_types_from_msg, get_typestore
from websockets.exceptions import WebSocketException
from websockets.sync.client import ClientConnection, connect

from zwidth.errors import InputError
from zwidth.servo.live.foxglove import JSON_TOPIC, ROS2_TOPIC, serve_foxglove
from zwidth.servo.live.messages import ros2_schema

HANGS = 60.0
"""Nothing comes any more [s]."""


@contextmanager
def reading(address: str, topic: str) -> Iterator[tuple[ClientConnection, dict[str, Any]]]:
    """A client of the protocol `foxglove.sdk.v1` that reads one topic, and what it was told of it."""
    with connect(address, subprotocols=["foxglove.sdk.v1"]) as socket:  # type: ignore[list-item]
        channels: dict[str, dict[str, Any]] = {}
        while topic not in channels:
            said = json.loads(socket.recv(timeout=HANGS))
            channels |= {channel["topic"]: channel for channel in said.get("channels", [])}
        number = channels[topic]["id"]
        socket.send(json.dumps({"op": "subscribe", "subscriptions": [{"id": 7, "channelId": number}]}))
        yield socket, channels[topic]


def messages(socket: ClientConnection, wanted: int) -> list[tuple[int, bytes]]:
    """The first rows that come after the subscription: their time stamps [ns], and what is in them."""
    found: list[tuple[int, bytes]] = []
    while len(found) < wanted:
        got = socket.recv(timeout=HANGS)
        if isinstance(got, bytes) and got[0] == 1:
            subscription, stamp = struct.unpack_from("<IQ", got, 1)
            assert subscription == 7
            found.append((stamp, got[13:]))
    return found


class Growing(WrittenRows):
    """Rows of which some more are there at each look."""

    def after(self, count: int) -> tuple[int, Any]:
        """Ten more."""
        self.count = min(self.count + 10, len(self.table))
        return super().after(count)


def growing() -> Growing:
    """Every third reading is no number."""
    rows = Growing(np.arange(20000.0))
    rows.table[::3, rows.COLUMNS.index("position_m")] = np.nan
    return rows


def by_time(rows: WrittenRows) -> dict[float, np.ndarray]:
    """Each row by its time."""
    return {row[rows.COLUMNS.index("time_s")]: row for row in rows.table}


def test_json_has_the_numbers_of_the_rows() -> None:
    """Bit by bit, under the names of the columns; what is no number is left out."""
    rows = growing()
    with serve_foxglove(rows, 0) as page, reading(page.address, JSON_TOPIC) as (socket, channel):
        assert (channel["encoding"], channel["schemaEncoding"]) == ("json", "jsonschema")
        assert tuple(json.loads(channel["schema"])["properties"]) == rows.COLUMNS
        got = messages(socket, 60)
    written, without = by_time(rows), 0
    for _, data in got:
        row = json.loads(data)
        expected = dict(zip(rows.COLUMNS, written[row["time_s"]], strict=True))
        known = {name: value for name, value in expected.items() if value == value}
        without += len(expected) - len(known)
        assert row == known
    assert without == 20


def test_ros_2_has_the_numbers_of_the_rows() -> None:
    """As a reader of ROS 2 messages finds them that has nothing but the definition that comes with them."""
    rows = growing()
    with serve_foxglove(rows, 0) as page, reading(page.address, ROS2_TOPIC) as (socket, channel):
        assert (channel["encoding"], channel["schemaEncoding"]) == ("cdr", "ros2msg")
        got = messages(socket, 60)
    store = get_typestore(Stores.EMPTY)
    store.register(get_types_from_msg(channel["schema"], channel["schemaName"]))
    written = by_time(rows)
    for _, data in got:
        row = store.deserialize_cdr(data, channel["schemaName"])
        found = [getattr(row, name.lower()) for name in rows.COLUMNS]
        np.testing.assert_array_equal(found, written[row.time_s])


def test_time_stamps_are_as_far_apart_as_the_samples() -> None:
    """To a nanosecond, of which stamps are made; in the time of the day."""
    rows = growing()
    with serve_foxglove(rows, 0) as page, reading(page.address, JSON_TOPIC) as (socket, _):
        got = messages(socket, 30)
    stamps = np.array([stamp for stamp, _ in got], np.int64)
    times = np.array([json.loads(data)["time_s"] for _, data in got])
    assert (np.diff(stamps) > 0).all()
    np.testing.assert_allclose((stamps - stamps[0]) * 1e-9, times - times[0], rtol=0, atol=2e-9)
    assert abs(stamps[0] * 1e-9 - time.time()) < 3600


def test_names_of_ros_2_are_its_own() -> None:
    """Small letters, digits, single underscores; the column as it is in a comment, with its unit."""
    definition = ros2_schema(["force_N", "wished_force_N_m", "current__A", "x0_m"]).decode()
    fields = ["force_n", "wished_force_n_m", "current_a", "x0_m"]
    assert [line.split()[1] for line in definition.splitlines()] == fields
    assert definition.splitlines()[1] == "float64 wished_force_n_m  # wished_force_N_m"


def test_nobody_on_another_machine_is_answered() -> None:
    """The address is that of the machine itself."""
    with serve_foxglove(growing(), 0) as page:
        assert page.address.startswith("ws://127.0.0.1:")


def test_a_port_in_use_is_refused() -> None:
    """With what to do about it."""
    with serve_foxglove(growing(), 0) as page:
        port = int(page.address.rpartition(":")[2])
        with pytest.raises(InputError, match="give another one, or 0"):
            serve_foxglove(growing(), port)


@pytest.mark.parametrize("port", [-1, 65536, 1.5, True, "8765"])
def test_what_is_no_port_is_refused(port: Any) -> None:
    """Before anything is opened."""
    with pytest.raises(InputError, match="is no port"):
        serve_foxglove(growing(), port)


def test_without_the_sdk_it_says_how_to_get_it(monkeypatch: pytest.MonkeyPatch) -> None:
    """And what needs none."""
    monkeypatch.setitem(sys.modules, "foxglove", None)
    with pytest.raises(InputError, match=r"pip install 'zwidth\[serve\]'"):
        serve_foxglove(growing(), 0)


def test_close_ends_it_once() -> None:
    """Again is no fault; nobody asks the loop any more."""
    rows = growing()
    page = serve_foxglove(rows, 0)
    page.close()
    page.close()
    asked = rows.asked
    # The server's own thread may take the line for a moment more, and then drop it.
    with pytest.raises((OSError, WebSocketException)):
        connect(page.address)
    assert rows.asked == asked
