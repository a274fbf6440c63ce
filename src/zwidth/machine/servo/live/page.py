"""Something that is served on this machine while a loop runs, in a thread of its own, and ends."""

from __future__ import annotations

import asyncio
import re
from collections.abc import Callable, Collection
from ipaddress import ip_address
from threading import Event, Thread
from types import SimpleNamespace
from typing import Any

from zwidth import installing
from zwidth.errors import InputError
from zwidth.machine.servo.connection import Closing

HOST = "127.0.0.1"
"""Nobody on another machine is answered."""

OWN = (HOST, "localhost", "::1")
"""What this machine calls itself."""

_FOREIGN = b"This server does not answer to that name: open the address that zwidth printed.\n"


class Page(Closing):
    """What is served, until `close`; ``with`` closes it as well.

    Parameters
    ----------
    address
        Where, such as "http://localhost:5006/".
    close
        Ends it.
    """

    def __init__(self, address: str, close: Callable[[], None]) -> None:
        self.address = address
        self._close: Callable[[], None] | None = close

    def close(self) -> None:
        """End it; may be called again."""
        close, self._close = self._close, None
        if close is not None:
            close()


def checked_port(port: int) -> int:
    """A port that can be asked for, 0 for any that is free."""
    if isinstance(port, bool) or not isinstance(port, int) or not 0 <= port <= 65535:
        raise InputError(
            f"{port!r} is no port: give a whole number from 1 to 65535, or 0 for one that is free"
        )
    return port


def checked_origin(origin: str) -> str:
    """What a browser calls pages of one site, such as "https://app.foxglove.dev"."""
    if not re.fullmatch(r"[a-z][a-z0-9+.-]*://[^\s/?#@]+/?", origin, re.IGNORECASE):
        raise InputError(
            f"{origin!r} is no origin of pages: give scheme and host, such as https://app.foxglove.dev"
        )
    return origin.rstrip("/").lower()


def origins(names: Collection[str], port: int) -> list[str]:
    """As a browser writes them: ``name:port``, an address of IPv6 in brackets."""
    return [f"[{name}]:{port}" if ":" in name else f"{name}:{port}" for name in names]


def guarded(application: Any, names: Collection[str], port: int, *, addresses: bool = False) -> Any:
    """What Tornado is to serve in the place of `application`: a request to a foreign host meets no handler.

    A page of another site whose name comes to mean this machine is of the same origin for a browser, and for
    Tornado; only its Host tells.  A WebSocket begins as such a request.  Only port 80 may be left out of a
    Host. With `addresses` any address in numbers will do: it comes to mean nothing else.
    """
    routing, http = library("tornado.routing", "Tornado"), library("tornado.httputil", "Tornado")
    own = {*origins(names, port), *(names if port == 80 else ())}

    def match(request: Any) -> dict[str, Any] | None:
        host = request.headers.get("Host", "").lower()
        return {} if host in own or (addresses and _is_address(host, port)) else None

    def refused(request: Any) -> None:
        start = http.ResponseStartLine("HTTP/1.1", 421, "Misdirected Request")
        told = {"Content-Type": "text/plain", "Content-Length": str(len(_FOREIGN))}
        request.connection.write_headers(start, http.HTTPHeaders(told), _FOREIGN)
        request.connection.finish()

    rules = [
        routing.Rule(SimpleNamespace(match=match), application),
        routing.Rule(routing.AnyMatches(), refused),
    ]
    return routing.RuleRouter(rules)


def _is_address(host: str, port: int) -> bool:
    name = host.removesuffix(f":{port}").removeprefix("[").removesuffix("]")
    try:
        return host in origins([str(ip_address(name))], port)
    except ValueError:
        return False


def library(module: str, name: str) -> Any:
    """A module of the extra `serve` that may be missing; `name` as its makers write it."""
    return installing.imported(module, name, "serve", "watch in the terminal")


def bound(port: int) -> tuple[list[Any], int]:
    """Sockets that listen on this machine alone, and their port."""
    try:
        sockets = library("tornado.netutil", "Tornado").bind_sockets(port, HOST)
    except OSError as error:
        raise InputError(
            f"port {port} cannot be served here: {error.strerror}; give another one, or 0 for a free one"
        ) from None
    return sockets, sockets[0].getsockname()[1]


class Serving:
    """A thread that serves on sockets that listen, until it is closed.

    `made` makes, in the thread, the HTTP server, and what ends whatever is behind it.
    """

    def __init__(
        self, sockets: list[Any], made: Callable[[], tuple[Any, Callable[[], None]]], name: str
    ) -> None:
        self._sockets, self._made = sockets, made
        self._ready = Event()
        self._failure: BaseException | None = None
        self._thread = Thread(target=self._run, name=name, daemon=True)
        self._thread.start()
        self._ready.wait()
        if self._failure is not None:
            raise self._failure

    def _run(self) -> None:
        try:
            asyncio.run(self._serve())
        except BaseException as error:
            self._failure = error
        finally:
            self._ready.set()

    async def _serve(self) -> None:
        self._loop, self._ended = asyncio.get_running_loop(), asyncio.Event()
        http, end = self._made()
        http.add_sockets(self._sockets)
        self._ready.set()
        await self._ended.wait()
        http.stop()
        end()
        await http.close_all_connections()

    def close(self) -> None:
        """End it."""
        if self._thread.is_alive():
            self._loop.call_soon_threadsafe(self._ended.set)
        self._thread.join()
