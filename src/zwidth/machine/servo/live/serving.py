"""A server of Tornado beside a running loop: the port, and the thread in which it serves."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from threading import Event, Thread
from typing import Any

from zwidth.errors import InputError
from zwidth.machine.servo.live.library import library
from zwidth.machine.servo.live.page import HOST


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
    """A thread that serves on sockets, until it is closed.

    Parameters
    ----------
    sockets
        That listen.
    made
        Makes, in the thread, the HTTP server, and what ends whatever is behind it.
    name
        Of the thread.
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
