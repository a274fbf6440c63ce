"""Rows of a running loop in Foxglove's WebSocket protocol, to as many readers as there are.

Of the protocol there is what a reader needs: serverInfo, advertise, subscribe, unsubscribe and message data,
the same in `foxglove.websocket.v1` (docs/spec.md of https://github.com/foxglove/ws-protocol, until July 2025)
and in `foxglove.sdk.v1` (https://github.com/foxglove/foxglove-sdk).

Each reader has a task, which asks the loop for rows when it has sent those before: one that is slow is sent
the newest, fills no memory, and holds up nobody.  Nothing is made for a topic that nobody reads.
"""

from __future__ import annotations

import asyncio
import json
import logging
import math
import struct
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from functools import partial
from typing import Any
from urllib.parse import urlsplit

import numpy as np
from tornado.httpserver import HTTPServer
from tornado.web import Application, HTTPError
from tornado.websocket import WebSocketClosedError, WebSocketHandler

from zwidth.machine.servo.live.page import OWN, guarded
from zwidth.machine.servo.live.rows import Rows, ros2_schema
from zwidth.native.compiled import Array
from zwidth.showing import printable

JSON_TOPIC, ROS2_TOPIC = "/zwidth/rows", "/zwidth/rows_ros2"

_PROTOCOLS = ("foxglove.sdk.v1", "foxglove.websocket.v1")

_EVERY = 0.02
"""Between two looks [s]."""

_MOST = 1024
"""Rows that a reader is sent at a look: the newest, if the loop has written more meanwhile."""

_MESSAGE = struct.Struct("<BIQ")
"""Before the data of a message: 1, whose subscription it is, and its time."""


def made_stream(rows: Rows, port: int, origin: str | None) -> tuple[HTTPServer, Callable[[], None]]:
    """The server, for programs and pages of this machine and pages of `origin`; and what ends its readers."""
    stream = _Stream(rows, origin)
    application = Application(
        [("/.*", _Reader, {"stream": stream})],
        log_function=lambda _: None,  # who is refused is not worth a line over whatever the terminal shows
        websocket_max_message_size=1 << 16,
    )
    return HTTPServer(guarded(application, OWN, port)), stream.end


class _Stream:
    """What all readers share."""

    def __init__(self, rows: Rows, origin: str | None) -> None:
        self.rows, self._origin, names = rows, origin, rows.COLUMNS
        self.readers: set[_Reader] = set()
        json_ones = partial(json_messages, names)
        self.messages: dict[int, Callable[[Array], Iterator[bytes]]] = {1: json_ones, 2: ros2_messages}
        told = (
            (1, JSON_TOPIC, "json", "zwidth row", "jsonschema", json_schema(names).decode()),
            (2, ROS2_TOPIC, "cdr", "zwidth/msg/Row", "ros2msg", ros2_schema(names).decode()),
        )
        keys = ("id", "topic", "encoding", "schemaName", "schemaEncoding", "schema")
        self.greeting: tuple[dict[str, Any], ...] = (
            {"op": "serverInfo", "name": printable(rows.title), "capabilities": []},
            {"op": "advertise", "channels": [dict(zip(keys, about, strict=True)) for about in told]},
        )
        self._time = names.index("time_s")
        self._began: int | None = None

    def lets_in(self, origin: str | None) -> bool:
        """True of a program, which names none, of pages of this machine, and of those of the origin named."""
        # file:// is what Electron says; a browser calls pages of files null, as it does what is in a frame
        if origin in (None, "file://", self._origin):
            return True
        with suppress(ValueError):
            page = urlsplit(origin)
            return page.scheme in ("http", "https") and page.hostname in OWN
        return False

    def stamps(self, rows: Array) -> list[int]:
        """When each row was taken [ns since 1970]."""
        times = rows[:, self._time].tolist()
        if times and self._began is None:
            self._began = time.time_ns() - int(1e9 * times[-1])
        return [(self._began or 0) + int(1e9 * t) for t in times]

    def end(self) -> None:
        """Tell the readers, and wait for none of them."""
        for reader in list(self.readers):
            reader.close(1001)
            reader.stream.close()


class _Reader(WebSocketHandler):
    """One who reads: the subscriptions by their channel, and the task that sends."""

    def initialize(self, stream: _Stream) -> None:
        self._stream = stream
        self._asked: dict[int, int] = {}

    def prepare(self) -> None:
        if not self._stream.lets_in(self.request.headers.get("Origin")):
            raise HTTPError(403)

    def check_origin(self, origin: str) -> bool:
        return True  # `prepare` has looked; when Tornado asks here depends on its version

    def select_subprotocol(self, subprotocols: list[str]) -> str | None:
        return next((one for one in _PROTOCOLS if one in subprotocols), None)

    def open(self, *args: str, **kwargs: str) -> None:
        self.stream: Any = self.ws_connection.stream if self.ws_connection else None
        self._stream.readers.add(self)
        for message in self._stream.greeting:
            self.write_message(message)
        self._task = asyncio.ensure_future(self._send())

    def on_message(self, message: str | bytes) -> None:
        try:
            said = json.loads(message)
            if said["op"] == "subscribe":
                for one in said["subscriptions"]:
                    _MESSAGE.pack(1, one["id"], 0)
                    if one["channelId"] in self._stream.messages:
                        self._asked.setdefault(one["channelId"], one["id"])
            elif said["op"] == "unsubscribe":
                ended = set(said["subscriptionIds"])
                self._asked = {channel: one for channel, one in self._asked.items() if one not in ended}
        except (ValueError, TypeError, KeyError, struct.error, RecursionError):
            self.close(1007, "not of Foxglove's WebSocket protocol")

    async def _send(self) -> None:
        seen = 0
        try:
            while self.ws_connection:
                await asyncio.sleep(_EVERY)
                if self._asked:
                    seen, rows = self._stream.rows.after(seen)
                    await self._tell(rows[-_MOST:])
        except WebSocketClosedError:
            pass
        except Exception:
            logging.getLogger(__name__).exception("a live stream has ended; the loop runs on")
            self.close(1011)

    async def _tell(self, rows: Array) -> None:
        stamps = self._stream.stamps(rows)
        for channel, one in list(self._asked.items()):
            for stamp, message in zip(stamps, self._stream.messages[channel](rows), strict=True):
                await self.write_message(_MESSAGE.pack(1, one, stamp) + message, binary=True)

    def on_close(self) -> None:
        self._stream.readers.discard(self)


# A row as a message: JSON keeps the names of the columns, units in them; what is no number is left out.  In a
# message of ROS 2 names have small letters alone: ``force_N`` is ``force_n`` there, and stands as it is in a
# comment.  Numbers of 8 bytes follow each other without a gap, after four bytes that say so, 00 01 00 00:
# little-endian CDR (OMG, DDS Interoperability Wire Protocol 2.2, 10.2).


_ENCAPSULATION = (0, 1, 0, 0)


def json_schema(columns: Sequence[str]) -> bytes:
    """The JSON schema of a row."""
    schema: dict[str, Any] = {
        "title": "zwidth row",
        "type": "object",
        "properties": {name: {"type": "number"} for name in columns},
    }
    return json.dumps(schema).encode()


def json_messages(columns: Sequence[str], rows: Array) -> Iterator[bytes]:
    """Each row as JSON."""
    for row in rows.tolist():
        known = {name: value for name, value in zip(columns, row, strict=True) if math.isfinite(value)}
        yield json.dumps(known).encode()


def ros2_messages(rows: Array) -> Iterator[bytes]:
    """Each row as ROS 2 serializes it."""
    count, width = rows.shape
    octets = np.empty((count, len(_ENCAPSULATION) + 8 * width), np.uint8)
    octets[:, : len(_ENCAPSULATION)] = _ENCAPSULATION
    octets[:, len(_ENCAPSULATION) :] = np.ascontiguousarray(rows, "<f8").view(np.uint8).reshape(count, -1)
    return (row.tobytes() for row in octets)
