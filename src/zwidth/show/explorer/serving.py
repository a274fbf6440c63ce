"""The explorer page, served by this machine: to itself, or over the network to who has the token.

Every browser has a session of its own; there are so many at most, and what is sent to them is bounded.
"""

from __future__ import annotations

import logging
import secrets
import socket
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from hmac import compare_digest
from ipaddress import ip_address
from pathlib import Path
from typing import Any

import panel as pn
from bokeh.document import Document
from bokeh.server.auth_provider import AuthProvider, NullAuth
from bokeh.server.server import BaseServer
from bokeh.server.tornado import BokehTornado
from bokeh.server.util import bind_sockets
from panel import Template
from panel import state as panel_state
from panel.io.application import build_applications
from panel.io.resources import LOCAL_DIST
from tornado.httpserver import HTTPServer
from tornado.ioloop import IOLoop
from tornado.web import RequestHandler

from zwidth.errors import InputError
from zwidth.machine.servo.live.page import HOST, OWN, Page, Serving, checked_port, guarded, origins
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
            return self._state, f"What the address asks for cannot be used: {error}. Another loop is shown."

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


# Who may look: on this machine everybody, over the network who has the token.


SHORTEST = 16
"""Characters of a token."""

ANY = ("0.0.0.0", "::")
"""Addresses that stand for every one of this machine."""

TOKEN = "token"
_LOGIN = "/enter"


def is_loopback(address: str) -> bool:
    """True where only this machine is answered."""
    if address == "localhost":
        return True
    try:
        return ip_address(address).is_loopback
    except ValueError:
        return False


def token_for(address: str, given: str | None) -> str | None:
    """The token that is asked for, made where none was given; None where only this machine is answered."""
    if given is None:
        return None if is_loopback(address) else secrets.token_urlsafe(24)
    if len(given) < SHORTEST or not all(c.isascii() and (c.isalnum() or c in "-_") for c in given):
        raise InputError(
            f"the token has {SHORTEST} characters or more, of letters, digits, - and _: anybody who "
            "guesses it may look; leave it out, and one is made"
        )
    return given


def hosts(address: str) -> list[str]:
    """The names under which this server is asked, in small letters."""
    names = {address, *OWN}
    if not is_loopback(address):
        names |= {socket.gethostname(), socket.getfqdn()}
    if address in ANY:
        with suppress(OSError):
            names.update(socket.gethostbyname_ex(socket.gethostname())[2])
    return sorted({name.lower() for name in names} - set(ANY))


class TokenAccess(AuthProvider):  # type: ignore[misc]  # Bokeh's has no types
    """Asks for a token.

    `cookie`: the name of what stands for it.
    """

    def __init__(self, token: str, cookie: str) -> None:
        self._token, self._cookie = token, cookie
        super().__init__()

    @property
    def get_user(self) -> Callable[[RequestHandler], str | None]:
        """Who asks: somebody with the token, or nobody."""

        def user(handler: RequestHandler) -> str | None:
            given = handler.get_query_argument(TOKEN, None)
            if given is not None and self._is_token(given):
                self._remember(handler)
                return "somebody"
            kept = handler.get_cookie(self._cookie)
            return "somebody" if kept is not None and self._is_token(kept) else None

        return user

    get_user_async = None
    logout_url = None
    get_login_url = None
    logout_handler = None

    @property
    def login_url(self) -> str:
        return _LOGIN

    @property
    def login_handler(self) -> type[RequestHandler]:
        """The form, and what reads it."""
        access = self

        class Enter(RequestHandler):
            def get(self) -> None:
                self.set_status(401)
                self.finish(_FORM.format(message=""))

            def post(self) -> None:
                if not access._is_token(self.get_body_argument(TOKEN, "")):
                    self.set_status(401)
                    self.finish(_FORM.format(message='<p role="alert">That is not the token.</p>'))
                    return
                access._remember(self)
                self.redirect("/")

        return Enter

    def _is_token(self, given: Any) -> bool:
        return compare_digest(str(given).encode(), self._token.encode())

    def _remember(self, handler: RequestHandler) -> None:
        handler.set_cookie(self._cookie, self._token, httponly=True, samesite="Strict")


_FORM = """<!DOCTYPE html><html lang="en"><head><meta charset="utf-8"><title>zwidth: token</title>
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
</head><body><main><h1>zwidth</h1>{message}<form method="post"><p><label>Token, as the terminal shows it:
<input name="token" type="password" autocomplete="off" required></label> <button>Enter</button></p></form>
</main></body></html>"""


_HERE = Path(__file__).parent


class _Template(pn.Template):  # type: ignore[misc]  # Panel has no types
    """One whose models are counted once and not once for each root, which took a third of the time."""

    def _init_doc(self, doc: Document | None = None, *given: Any, **named: Any) -> Document:
        with (doc or panel_state.curdoc or Document()).models.freeze():
            return super()._init_doc(doc, *given, **named)


def page_of(session: Session) -> pn.Template:
    """The page as a template that can be served; the verdict is read before any script runs."""
    template = _Template(_read("page.html"))
    template.add_variable("first", session.head.html)
    template.add_variable("words_css", _read("words.css"))
    template.add_variable("views", [(key, name) for key, name, *_ in session.views])
    for name in ("page.css", "page.js"):
        template.add_variable(name.replace(".", "_"), _read(name))
    template.add_panel("form", session.form)
    template.add_panel("head", session.head)
    template.add_panel("details", session.details)
    template.add_panel("badge", session.badge)
    for view in session.views:
        template.add_panel(view.key, pn.Column(*view.parts, sizing_mode="stretch_width"))
    return template


def _read(name: str) -> str:
    return (_HERE / name).read_text(encoding="utf-8")


def full_page(most: int) -> pn.Template:
    """Of a server that has as many pages open as it may."""
    template = pn.Template(_read("full.html"))
    template.add_variable("most", most)
    template.add_variable("page_css", _read("page.css"))
    return template
