"""A thread that asks a loop for its rows, again and again, and hands them on.

It is one for each page: one that waits, fails or ends leaves the others and the loop as they are.
"""

from __future__ import annotations

import logging
from collections.abc import Callable
from threading import Event, Thread

from zwidth.machine.servo.live.rows import News, Rows, Watched


class Reader:
    """Rows, handed on as they come.

    Parameters
    ----------
    rows
        Of the loop.
    take
        Is called with what is new; what it raises ends the thread, and is logged.
    every
        Between two looks [s].
    """

    def __init__(self, rows: Rows, take: Callable[[News], None], every: float) -> None:
        self._watched, self._take, self._every = Watched(rows), take, every
        self._ended = Event()
        self._thread = Thread(target=self._run, name="zwidth live reader", daemon=True)
        self._thread.start()

    def _run(self) -> None:
        try:
            while not self._ended.wait(self._every):
                self._take(self._watched.news())
        except Exception:
            logging.getLogger(__name__).exception("a live graph has ended; the loop runs on")

    def close(self) -> None:
        """End it; may be called again."""
        self._ended.set()
        self._thread.join()
