"""A running loop in the browser: a page that this machine serves to itself, out of what is installed on it.

A thread reads the rows, another one serves.  Each viewer has a document of its own, which can pause; what
all of them draw is kept once.  A viewer that does not say that it has its last pictures is sent no more until
it does.
"""

from __future__ import annotations

import asyncio
import logging
import webbrowser
from threading import Event, Thread
from typing import Any

from zwidth.errors import InputError
from zwidth.servo.live.document import SPANS, Shown, make_document
from zwidth.servo.live.envelope import Envelope
from zwidth.servo.live.library import library
from zwidth.servo.live.page import HOST, OWN, Page, checked_port, guarded, origins
from zwidth.servo.live.reader import Reader
from zwidth.servo.live.rows import CURVES, News, Rows
from zwidth.servo.live.tally import Tally

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
        util = library("bokeh.server.util", "Bokeh")
        try:
            self._sockets, self._port = util.bind_sockets(HOST, port)
        except OSError as error:
            raise InputError(
                f"port {port} cannot be served here: {error.strerror}; give another one, or 0 for a free one"
            ) from None
        self.address = f"http://{HOST}:{self._port}/"
        self._envelope, self._tally = Envelope(len(CURVES), SPANS), Tally(rows)
        self._shown = Shown(rows, self._envelope, self._tally, surface, frame)
        self._reader = Reader(rows, self._take, frame)
        self._ready = Event()
        self._failure: BaseException | None = None
        self._loop = asyncio.new_event_loop()
        self._ended = asyncio.Event()
        self._thread = Thread(target=self._run, name="zwidth live page", daemon=True)
        self._thread.start()
        self._ready.wait()
        if self._failure is not None:
            self._reader.close()
            raise self._failure

    def _take(self, news: News) -> None:
        self._tally.add(news)
        self._envelope.add(news.times, news.curves)

    def _run(self) -> None:
        try:
            self._loop.run_until_complete(self._serve())
        except BaseException as error:
            self._failure = error
        finally:
            self._ready.set()
            self._loop.close()

    async def _serve(self) -> None:
        """Until it is closed."""
        # a viewer that leaves is no fault: not worth a line over whatever the terminal shows
        logging.getLogger("bokeh.server.views.ws").setLevel(logging.ERROR)
        server, http = self._made()
        server.start()
        http.add_sockets(self._sockets)
        self._ready.set()
        await self._ended.wait()
        server.stop()
        await http.close_all_connections()

    def _made(self) -> tuple[Any, Any]:
        """A server of Bokeh on the sockets that are bound already, for pages of its own alone."""
        application = library("bokeh.application", "Bokeh").Application
        handler = library("bokeh.application.handlers", "Bokeh").FunctionHandler
        tornado = library("bokeh.server.tornado", "Bokeh").BokehTornado(
            {"/": application(handler(lambda doc: make_document(doc, self._shown)))},
            extra_websocket_origins=origins(OWN, self._port),
        )
        http = library("tornado.httpserver", "Tornado").HTTPServer(guarded(tornado, OWN, self._port))
        loop = library("tornado.ioloop", "Tornado").IOLoop.current()
        return library("bokeh.server.server", "Bokeh").BaseServer(loop, tornado, http), http

    def close(self) -> None:
        """End both threads."""
        self._reader.close()
        if self._thread.is_alive():
            self._loop.call_soon_threadsafe(self._ended.set)
        self._thread.join()
