"""A running loop in the browser: a page that this machine serves to itself, out of what is installed on it.

A thread reads the rows, another one serves.  Each viewer has a document of its own, which can pause; what
all of them draw is kept once.  A viewer that does not say that it has its last pictures is sent no more until
it does.
"""

from __future__ import annotations

import logging
import webbrowser
from collections.abc import Callable
from typing import Any

from zwidth.machine.servo.live.document import SPANS, Shown, make_document
from zwidth.machine.servo.live.envelope import Envelope
from zwidth.machine.servo.live.library import library
from zwidth.machine.servo.live.page import HOST, OWN, Page, checked_port, guarded, origins
from zwidth.machine.servo.live.reader import Reader
from zwidth.machine.servo.live.rows import CURVES, News, Rows
from zwidth.machine.servo.live.serving import Serving, bound
from zwidth.machine.servo.live.tally import Tally

FRAME = 0.05
"""Between two pictures [s]."""


def open_page(
    rows: Rows,
    port: int = 0,
    open_browser: bool = True,
    *,
    surface: float | None = 0.0,
    frame: float = FRAME,
) -> Page:
    """Serve a page with four graphs of a running loop: position, force, energy and lateness.

    Only browsers on this machine are answered, and only pages that come from this server get rows.

    Parameters
    ----------
    rows
        Of the loop.
    port
        1 to 65535, or 0 for one that is free.
    open_browser
        Open the page in the person's browser.
    surface
        Where the wall begins [m; rad], to shade it; None where there is no wall.
    frame
        Between two pictures, > 0 [s].

    Raises
    ------
    InputError
        If Bokeh is not installed, or the port is none or in use.
    """
    server = _Server(rows, checked_port(port), surface, frame)
    if open_browser:
        webbrowser.open(server.address)
    return Page(server.address, server.close)


class _Server:
    """The thread that serves, and the one that reads."""

    def __init__(self, rows: Rows, port: int, surface: float | None, frame: float) -> None:
        sockets, self._port = bound(port)
        self.address = f"http://{HOST}:{self._port}/"
        self._envelope, self._tally = Envelope(len(CURVES), SPANS), Tally(rows)
        self._shown = Shown(rows, self._envelope, self._tally, surface, frame)
        self._serving = Serving(sockets, self._made, "zwidth live page")
        self._reader = Reader(rows, self._take, frame)

    def _take(self, news: News) -> None:
        self._tally.add(news)
        self._envelope.add(news.times, news.curves)

    def _made(self) -> tuple[Any, Callable[[], None]]:
        """A server of Bokeh for pages of its own alone, and what ends it."""
        # a viewer that leaves is no fault: not worth a line over whatever the terminal shows
        logging.getLogger("bokeh.server.views.ws").setLevel(logging.ERROR)
        application = library("bokeh.application", "Bokeh").Application
        handler = library("bokeh.application.handlers", "Bokeh").FunctionHandler
        tornado = library("bokeh.server.tornado", "Bokeh").BokehTornado(
            {"/": application(handler(lambda doc: make_document(doc, self._shown)))},
            extra_websocket_origins=origins(OWN, self._port),
        )
        http = library("tornado.httpserver", "Tornado").HTTPServer(guarded(tornado, OWN, self._port))
        loop = library("tornado.ioloop", "Tornado").IOLoop.current()
        server = library("bokeh.server.server", "Bokeh").BaseServer(loop, tornado, http)
        server.start()
        return http, server.stop

    def close(self) -> None:
        """End both threads."""
        self._reader.close()
        self._serving.close()
