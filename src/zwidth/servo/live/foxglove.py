"""A running loop for Foxglove, Lichtblick and PlotJuggler: its rows over the WebSocket of Foxglove's SDK.

Two topics have the same rows: JSON, which a script reads easily and where units are written as they are, and
ROS 2, the only one that PlotJuggler reads.  Nothing is made for a topic that nobody reads; for a reader that
is too slow the SDK drops the oldest messages.
"""

from __future__ import annotations

import logging
import time
from typing import Any

from zwidth.errors import InputError
from zwidth.servo.live.library import library
from zwidth.servo.live.messages import json_messages, json_schema, ros2_messages, ros2_schema
from zwidth.servo.live.page import HOST, Page, checked_port
from zwidth.servo.live.reader import Reader
from zwidth.servo.live.rows import News, Rows
from zwidth.showing import printable

PORT = 8765
"""Where Foxglove, Lichtblick and PlotJuggler look first."""

JSON_TOPIC, ROS2_TOPIC = "/zwidth/rows", "/zwidth/rows_ros2"

_EVERY = 0.02
"""Between two looks [s]: the SDK keeps 1024 messages for a reader, and the loop has written fewer by then."""


def serve_foxglove(rows: Rows, port: int = PORT) -> Page:
    """Serve the rows of a running loop to programs on this machine that read Foxglove's WebSocket.

    Parameters
    ----------
    rows
        Of the loop.
    port
        1 to 65535, or 0 for one that is free.

    Raises
    ------
    InputError
        If Foxglove's SDK is not installed, or the port is none or in use.
    """
    server = _Server(rows, checked_port(port))
    return Page(server.address, server.close)


class _Server:
    """The server of the SDK, and the thread that reads."""

    def __init__(self, rows: Rows, port: int) -> None:
        sdk = library("foxglove", "Foxglove's SDK")
        # a reader that leaves is no fault: not worth a line for each message over whatever the terminal shows
        logging.getLogger("foxglove.websocket").setLevel(logging.CRITICAL)
        self._context = context = sdk.Context()  # kept: with it the server would forget its channels
        self._columns = rows.COLUMNS
        try:
            self._server: Any = sdk.start_server(
                name=printable(rows.title), host=HOST, port=port, context=context
            )
        except RuntimeError as error:
            raise InputError(
                f"port {port} cannot be served here: {error}; give another one, or 0 for a free one"
            ) from None

        def channel(topic: str, encoding: str, name: str, schema_encoding: str, schema: bytes) -> Any:
            told = sdk.Schema(name=name, encoding=schema_encoding, data=schema)
            return sdk.Channel(topic, message_encoding=encoding, schema=told, context=context)

        self._json = channel(JSON_TOPIC, "json", "zwidth row", "jsonschema", json_schema(rows.COLUMNS))
        self._ros2 = channel(ROS2_TOPIC, "cdr", "zwidth/msg/Row", "ros2msg", ros2_schema(rows.COLUMNS))
        self.address = f"ws://{HOST}:{self._server.port}"
        self._began: int | None = None
        self._reader = Reader(rows, self._take, _EVERY)

    def _take(self, news: News) -> None:
        if not len(news.rows):
            return
        if self._began is None:
            self._began = time.time_ns() - int(1e9 * float(news.times[-1]))
        stamps = [self._began + int(1e9 * t) for t in news.times.tolist()]
        if self._json.has_sinks():
            for stamp, message in zip(stamps, json_messages(self._columns, news.rows), strict=True):
                self._json.log(message, log_time=stamp)
        if self._ros2.has_sinks():
            for stamp, message in zip(stamps, ros2_messages(news.rows), strict=True):
                self._ros2.log(message, log_time=stamp)

    def close(self) -> None:
        """End the thread, then the server."""
        self._reader.close()
        for channel in (self._json, self._ros2):
            channel.close()
        self._server.stop()
