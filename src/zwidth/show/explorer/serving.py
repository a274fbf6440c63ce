"""The explorer page, served by this machine: to itself, or over the network to who has the token.

Every browser has a session of its own; there are so many at most, and what is sent to them is bounded.
"""

from __future__ import annotations

import logging
from collections.abc import Callable
from functools import partial
from typing import Any

from bokeh.document import Document
from bokeh.server.auth_provider import NullAuth
from bokeh.server.server import BaseServer
from bokeh.server.tornado import BokehTornado
from bokeh.server.util import bind_sockets
from panel import Template
from panel import state as panel_state
from panel.io.application import build_applications
from panel.io.resources import LOCAL_DIST
from tornado.httpserver import HTTPServer
from tornado.ioloop import IOLoop

from zwidth.errors import InputError
from zwidth.machine.servo.live.page import HOST, Page, Serving, checked_port, guarded, origins
from zwidth.show.explorer.access import ANY, TOKEN, TokenAccess, hosts, token_for
from zwidth.show.explorer.page import full_page, page_of
from zwidth.show.explorer.session import Session
from zwidth.show.explorer.starts import first
from zwidth.show.explorer.state import State, from_query
from zwidth.show.explorer.working import Workers

MOST_SESSIONS = 16
"""Pages that are open at once."""

LARGEST_MESSAGE = 256 * 1024
"""Bytes that a browser may send at once: a file and what is around it."""

_UNUSED = 15_000
"""After so long a page that nobody looks at is forgotten [ms]."""


def serve_explorer(
    state: State | None = None,
    port: int = 0,
    *,
    address: str = HOST,
    token: str | None = None,
    most: int = MOST_SESSIONS,
) -> Page:
    """Serve the page until it is closed.

    Parameters
    ----------
    state
        The loop that a page begins with whose address holds none; None: a device of the catalogue and a wall.
    port
        1 to 65535, or 0 for one that is free.
    address
        To which it listens: 127.0.0.1 answers this machine alone.
    token
        That a browser must have; None: none on this machine, and one that is made over the network.
    most
        Pages that are open at once.

    Raises
    ------
    InputError
        If the port or the address cannot be served, or the token is none.
    """
    server = _Server(state or first(), checked_port(port), address, token_for(address, token), most)
    return Page(server.address, server.close)


class _Server:
    """The thread that serves, and the processes that compute."""

    def __init__(self, state: State, port: int, address: str, token: str | None, most: int) -> None:
        try:
            sockets, self._port = bind_sockets(address, port)
        except OSError as error:
            raise InputError(
                f"{address} port {port} cannot be served here: {error.strerror}; give another one, or port 0 "
                "for a free one"
            ) from None
        self._state, self._hosts, self._token, self._most = state, hosts(address), token, most
        self._any = address in ANY
        shown = "127.0.0.1" if address == "0.0.0.0" else f"[{address}]" if ":" in address else address
        secret = "" if token is None else f"?{TOKEN}={token}"
        self.address = f"http://{shown}:{self._port}/{secret}"
        self._open = 0
        self._workers = Workers()
        self._serving = Serving(sockets, self._made, "zwidth explorer")

    def _made(self) -> tuple[Any, Callable[[], None]]:
        """A server of Bokeh, and what ends it."""
        for name in ("bokeh.server.views.ws", "tornado.access"):
            logging.getLogger(name).setLevel(logging.CRITICAL)  # what a browser does is not worth a line
        access = NullAuth() if self._token is None else TokenAccess(self._token, f"zwidth_{self._port}")
        tornado = BokehTornado(
            build_applications({"/": self._make}, title="zwidth: explore a loop", location=False),
            extra_websocket_origins=origins(self._hosts, self._port),
            auth_provider=access,
            websocket_max_message_size_bytes=LARGEST_MESSAGE,
            check_unused_sessions_milliseconds=_UNUSED // 3,
            unused_session_lifetime_milliseconds=_UNUSED,
        )
        own = guarded(tornado, self._hosts, self._port, addresses=self._any)
        http = HTTPServer(own, max_body_size=LARGEST_MESSAGE)
        server = BaseServer(IOLoop.current(), tornado, http)
        server.start()
        return http, server.stop

    def _make(self) -> Template:
        """The page of a new browser."""
        if self._open >= self._most:
            return full_page(self._most)
        document = panel_state.curdoc
        # a page that connects too late has a second document, of which Panel forgets whence its styles come
        document.template_variables["dist_url"] = LOCAL_DIST
        self._open += 1
        state, message = self._asked(document)
        session = Session(state, self._workers, partial(_soon, document), message)
        document.on_session_destroyed(lambda _: self._left(session))
        return page_of(session)

    def _asked(self, document: Document) -> tuple[State, str]:
        """The loop of the address, or that to begin with and what is wrong with the address."""
        given = document.session_context.request.arguments
        pairs = [(key, _text(one)) for key, values in given.items() for one in values if key != TOKEN]
        if not pairs:
            return self._state, ""
        try:
            return from_query(pairs), ""
        except InputError as error:
            return self._state, f"What the address asks for cannot be used: {error}"

    def _left(self, session: Session) -> None:
        self._open -= 1
        session.close()

    def close(self) -> None:
        """End the thread, then the processes."""
        self._serving.close()
        self._workers.close()


def _soon(document: Document, work: Callable[[], None]) -> None:
    """Have something done when what goes before has been sent."""
    document.add_next_tick_callback(partial(_and_sent, document, work))


def _and_sent(document: Document, work: Callable[[], None]) -> None:
    """Do it, and have what it changes sent before anything else is done.

    Held, changes are sent by Bokeh itself, which keeps the document to itself until they are out.  Panel
    would put them off while an answer to the browser is on its way, until after whatever comes next.
    """
    document.hold()
    try:
        work()
    finally:
        document.unhold()


def _text(value: bytes | str) -> str:
    return value.decode("utf-8", "replace") if isinstance(value, bytes) else value
