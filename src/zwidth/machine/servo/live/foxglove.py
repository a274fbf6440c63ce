"""A running loop for Foxglove, Lichtblick and PlotJuggler: its rows over Foxglove's WebSocket protocol.

Two topics have the same rows: JSON, which a script reads easily and where units are written as they are, and
ROS 2, the only one that PlotJuggler reads.
"""

from __future__ import annotations

import socket
from functools import partial

from zwidth.machine.servo.live.page import HOST, Page, Serving, bound, checked_origin, checked_port
from zwidth.machine.servo.live.rows import Rows

PORT = 8765
"""Where Foxglove, Lichtblick and PlotJuggler look first."""

_UNDER_WAY = 1 << 16
"""What the system keeps for a slow reader [bytes]: there, newer rows cannot take the place of older ones."""


def serve_foxglove(rows: Rows, port: int = PORT, origin: str | None = None) -> Page:
    """Serve the rows of a running loop to programs on this machine that read Foxglove's WebSocket.

    Programs and pages of this machine are let in; a page that came from elsewhere is told nothing.

    Parameters
    ----------
    rows
        Of the loop.
    port
        1 to 65535, or 0 for one that is free.
    origin
        Pages that are let in besides, as a browser names them: "https://app.foxglove.dev".

    Raises
    ------
    InputError
        If Tornado is not installed, the port is none or in use, or the origin is none.
    """
    named = None if origin is None else checked_origin(origin)
    sockets, port = bound(checked_port(port))
    sockets[0].setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, _UNDER_WAY)  # each connection inherits it
    from zwidth.machine.servo.live.stream import made_stream  # which needs Tornado: `bound` has found it

    serving = Serving(sockets, partial(made_stream, rows, port, named), "zwidth live stream")
    return Page(f"ws://{HOST}:{port}", serving.close)
