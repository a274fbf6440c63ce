"""A running loop for programs that read Foxglove's WebSocket."""

import json
import struct
import sys
import time
from contextlib import closing, contextmanager
from socket import SO_RCVBUF, SOL_SOCKET, create_connection
from socket import socket as Socket

import numpy as np
import pytest
from live_rows import WrittenRows
from rosbags.typesys import Stores, get_types_from_msg, get_typestore
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import connect

from zwidth.errors import InputError
from zwidth.machine.servo.live.foxglove import serve_foxglove
from zwidth.machine.servo.live.stream import JSON_TOPIC, ROS2_TOPIC, ros2_schema

HANGS = 60.0
"""Nothing comes any more [s]."""

PAGE = "https://app.example"
"""Of a web application that is named, or not."""


@contextmanager
def reading(address, topic, **more):
    """A client of the protocol `foxglove.sdk.v1` that reads one topic, and what it was told of it.

    One whose queue is full does not read that the other side ends it, and waits for that.
    """
    more = {"subprotocols": ["foxglove.sdk.v1"], "max_queue": None, **more}
    with connect(address, **more) as socket:
        channels = {}
        while topic not in channels:
            said = json.loads(socket.recv(timeout=HANGS))
            channels |= {channel["topic"]: channel for channel in said.get("channels", [])}
        number = channels[topic]["id"]
        socket.send(json.dumps({"op": "subscribe", "subscriptions": [{"id": 7, "channelId": number}]}))
        yield socket, channels[topic]


def messages(socket, wanted):
    """The first rows that come after the subscription: their time stamps [ns], and what is in them."""
    found = []
    while len(found) < wanted:
        got = socket.recv(timeout=HANGS)
        if isinstance(got, bytes) and got[0] == 1:
            subscription, stamp = struct.unpack_from("<IQ", got, 1)
            assert subscription == 7
            found.append((stamp, got[13:]))
    return found


class Growing(WrittenRows):
    more = 10

    def after(self, count):
        self.count = min(self.count + self.more, len(self.table))
        return super().after(count)


def growing(count=20000):
    """Every third reading is no number."""
    rows = Growing(np.arange(float(count)))
    rows.table[::3, rows.COLUMNS.index("position_m")] = np.nan
    return rows


def by_time(rows):
    return {row[rows.COLUMNS.index("time_s")]: row for row in rows.table}


def test_json_has_the_numbers_of_the_rows():
    """Stamps are as far apart as the samples, to the nanosecond that they are made of, in the time of day."""
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
    stamps = np.array([stamp for stamp, _ in got], np.int64)
    times = np.array([json.loads(data)["time_s"] for _, data in got])
    assert (np.diff(stamps) > 0).all()
    np.testing.assert_allclose((stamps - stamps[0]) * 1e-9, times - times[0], rtol=0, atol=2e-9)
    assert abs(stamps[0] * 1e-9 - time.time()) < 3600


def test_ros_2_has_the_numbers_of_the_rows():
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


@pytest.mark.parametrize("topic", [JSON_TOPIC, ROS2_TOPIC])
def test_foxglove_s_own_server_says_it_in_the_same_bytes(topic):
    """The same reader at theirs: what is told of the topic, and every frame of a row."""
    import foxglove

    with serve_foxglove(growing(), 0) as page, reading(page.address, topic) as (socket, ours):
        rows = messages(socket, 30)
    context = foxglove.Context()
    schema = foxglove.Schema(
        name=ours["schemaName"], encoding=ours["schemaEncoding"], data=ours["schema"].encode()
    )
    channel = foxglove.Channel(topic, schema=schema, message_encoding=ours["encoding"], context=context)
    server = foxglove.start_server(port=0, context=context)
    try:
        with reading(f"ws://127.0.0.1:{server.port}", topic) as (socket, theirs):
            until = time.monotonic() + HANGS
            while not channel.has_sinks() and time.monotonic() < until:  # until it has heard the subscription
                time.sleep(1e-3)
            for stamp, data in rows:
                channel.log(data, log_time=stamp)
            assert messages(socket, 30) == rows
    finally:
        server.stop()
    assert {**theirs, "id": ours["id"]} == ours


def test_names_of_ros_2_are_its_own():
    """Small letters, digits, single underscores; the column as it is in a comment, with its unit."""
    definition = ros2_schema(["force_N", "wished_force_N_m", "motor__Current_A_", "x0_m"]).decode()
    fields = ["force_n", "wished_force_n_m", "motor_current_a", "x0_m"]
    assert [line.split()[1] for line in definition.splitlines()] == fields
    assert definition.splitlines()[1] == "float64 wished_force_n_m  # wished_force_N_m"


def test_a_reader_takes_either_name_of_the_protocol():
    told = []
    with serve_foxglove(growing(), 0) as page:
        for offered in (["other", "foxglove.websocket.v1"], ["foxglove.websocket.v1", "foxglove.sdk.v1"]):
            with connect(page.address, subprotocols=offered) as socket:
                assert socket.subprotocol == offered[1]
                told.append([json.loads(socket.recv(timeout=HANGS)) for _ in range(2)])
    assert told[0] == told[1]
    info, advertised = told[0]
    assert (info["op"], info["name"]) == ("serverInfo", "a paddle <b>in a wall</b>")
    assert info["capabilities"] == []
    assert (advertised["op"], len(advertised["channels"])) == ("advertise", 2)


@pytest.mark.parametrize(
    "origin", [None, "http://localhost:8080", "http://127.0.0.1", "https://[::1]:3000", "file://", PAGE]
)
def test_programs_and_pages_of_this_machine_are_let_in(origin):
    """PlotJuggler names no origin, Electron a file; a web application is let in where it is named."""
    with (
        serve_foxglove(growing(), 0, PAGE + "/") as page,
        reading(page.address, JSON_TOPIC, origin=origin) as (socket, _),
    ):
        assert len(messages(socket, 3)) == 3


@pytest.mark.parametrize(
    "origin",
    [
        "http://elsewhere.example",
        "http://localhost.elsewhere.example",
        "http://localhost@elsewhere.example",
        "ftp://localhost",
        "null",
        "",
        "http://[",
        PAGE,
    ],
)
@pytest.mark.parametrize("site", ["cross-site", "none"])
def test_pages_of_others_are_refused(origin, site):
    rows = growing()
    with serve_foxglove(rows, 0) as page, pytest.raises(InvalidStatus, match="403"):
        connect(page.address, origin=origin, additional_headers={"Sec-Fetch-Site": site})
    assert rows.asked == 0


@pytest.mark.parametrize("origin", [None, "http://elsewhere.example:PORT", "http://127.0.0.1:PORT", PAGE])
def test_a_name_that_comes_to_mean_this_machine_is_refused(origin):
    """Whatever page asks: of the same origin as that name, of this machine, of one that may, or of none."""
    rows = growing()
    with serve_foxglove(rows, 0, PAGE) as page:
        port = int(page.address.rpartition(":")[2])
        origin = origin and origin.replace("PORT", str(port))
        with create_connection(("127.0.0.1", port)) as stream, pytest.raises(InvalidStatus, match="421"):
            connect(f"ws://elsewhere.example:{port}", sock=stream, origin=origin)
    assert rows.asked == 0


@pytest.mark.parametrize("origin", ["null", "*", "app.example", "https://app.example/page", "https://", ""])
def test_what_is_no_origin_is_not_let_in(origin):
    """Any site can have pages that a browser calls null."""
    with pytest.raises(InputError, match="is no origin of pages"):
        serve_foxglove(growing(), 0, origin)


def test_a_reader_that_is_slow_holds_up_nobody():
    """Who keeps up gets every row meanwhile; who does not gets the newest when he reads on, and not all."""
    rows = growing(40000)
    rows.more = 100
    with serve_foxglove(rows, 0) as page, closing(Socket()) as stream:
        stream.setsockopt(SOL_SOCKET, SO_RCVBUF, 4096)
        stream.connect(("127.0.0.1", int(page.address.rpartition(":")[2])))
        slowly = reading(page.address, JSON_TOPIC, sock=stream, max_queue=1, close_timeout=0.1)
        with slowly as (slow, _), reading(page.address, ROS2_TOPIC) as (fast, _):
            kept_up = [struct.unpack_from("<d", data, 4)[0] for _, data in messages(fast, 12000)]
            got = [-1.0]
            while got[-1] < kept_up[-1]:
                got += [json.loads(data)["sample"] for _, data in messages(slow, 1)]
    assert set(np.diff(kept_up)) == {1.0}
    assert (np.diff(got) > 0).all()
    assert len(got) < 9000


def test_nothing_is_made_for_a_topic_that_nobody_reads(monkeypatch):
    def unwanted(*_):
        raise AssertionError("nobody reads this")

    monkeypatch.setattr("zwidth.machine.servo.live.stream.json_messages", unwanted)
    rows = growing()
    with serve_foxglove(rows, 0) as page, connect(page.address) as idle:
        assert json.loads(idle.recv(timeout=HANGS))["op"] == "serverInfo"
        assert rows.asked == 0
        with reading(page.address, ROS2_TOPIC) as (socket, _):
            assert len(messages(socket, 30)) == 30


def test_a_subscription_ends_when_it_is_asked_to():
    with serve_foxglove(growing(), 0) as page, reading(page.address, JSON_TOPIC) as (socket, channel):
        messages(socket, 3)
        socket.send(json.dumps({"op": "unsubscribe", "subscriptionIds": [7]}))
        other = [{"id": 7, "channelId": 3 - channel["id"]}]
        socket.send(json.dumps({"op": "subscribe", "subscriptions": other}))
        data = b"{"
        while data[:1] == b"{":  # what was on its way
            data = messages(socket, 1)[0][1]
        assert all(data[:4] == b"\0\1\0\0" for _, data in messages(socket, 50))


@pytest.mark.parametrize(
    "said",
    [
        "subscribe",
        "[]",
        "{}",
        b"\x01\x00",
        "[" * 60000,
        '{"op": "subscribe", "subscriptions": [{"id": -1, "channelId": 1}]}',
        '{"op": "subscribe", "subscriptions": [{"id": 1, "channelId": {}}]}',
        '{"op": "unsubscribe", "subscriptionIds": 7}',
    ],
)
def test_what_is_not_of_the_protocol_ends_that_reader_alone(said):
    with serve_foxglove(growing(), 0) as page, reading(page.address, JSON_TOPIC) as (socket, _):
        with connect(page.address) as other:
            other.send(said)
            with pytest.raises(ConnectionClosed, match="not of Foxglove's"):
                messages(other, 1)
        assert len(messages(socket, 30)) == 30


def test_what_is_not_offered_is_passed_over():
    with serve_foxglove(growing(), 0) as page, reading(page.address, JSON_TOPIC) as (socket, _):
        socket.send(json.dumps({"op": "subscribe", "subscriptions": [{"id": 8, "channelId": 99}]}))
        socket.send(json.dumps({"op": "getParameters", "parameterNames": []}))
        assert len(messages(socket, 30)) == 30


def test_a_loop_that_cannot_be_read_ends_the_stream_and_nothing_else(caplog, monkeypatch):
    rows = growing()

    def failing(_):
        raise RuntimeError("gone")

    with serve_foxglove(rows, 0) as page:
        with reading(page.address, JSON_TOPIC) as (socket, _):
            messages(socket, 3)
            monkeypatch.setattr(rows, "after", failing)
            with pytest.raises(ConnectionClosed, match="1011"):
                messages(socket, 10000)
        assert "a live stream has ended" in caplog.text
        with connect(page.address) as other:
            assert json.loads(other.recv(timeout=HANGS))["op"] == "serverInfo"


def test_a_port_in_use_is_refused():
    with serve_foxglove(growing(), 0) as page:
        assert page.address.startswith("ws://127.0.0.1:")  # nobody on another machine is answered
        port = int(page.address.rpartition(":")[2])
        with pytest.raises(InputError, match=rf"^port {port} .*give another one, or 0 for a free one$"):
            serve_foxglove(growing(), port)


@pytest.mark.parametrize("port", [-1, 65536, 1.5, True, "8765"])
def test_what_is_no_port_is_refused(port):
    with pytest.raises(InputError, match="is no port"):
        serve_foxglove(growing(), port)


def test_without_tornado_it_says_how_to_get_it(monkeypatch):
    monkeypatch.setitem(sys.modules, "tornado.netutil", None)
    with pytest.raises(InputError, match=r"install .*\[serve\]"):
        serve_foxglove(growing(), 0)


def test_close_ends_it_once():
    rows = growing()
    page = serve_foxglove(rows, 0)
    with reading(page.address, JSON_TOPIC) as (socket, _):
        messages(socket, 3)
        page.close()
        page.close()
        asked = rows.asked
        with pytest.raises(ConnectionClosed, match="1001"):
            messages(socket, 10000)
    with pytest.raises(ConnectionRefusedError):
        connect(page.address)
    assert rows.asked == asked
