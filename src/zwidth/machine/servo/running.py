"""The thread in which a loop runs, and beside it the signs of life of the program around."""

from __future__ import annotations

import threading
import time
from typing import cast

from zwidth.machine.servo.connection import (
    CompiledConnection,
    Connection,
    LibraryConnection,
    Opened,
    give_library,
)
from zwidth.machine.servo.cycle import AWAKE_MOST, HEARTBEAT, PERIOD, REASON
from zwidth.machine.servo.loop import Shared, run_compiled, run_library
from zwidth.machine.servo.pace import most_awake
from zwidth.machine.servo.posix import now
from zwidth.machine.servo.priority import Granted, RealTime
from zwidth.machine.servo.safety import FAILED

_BEAT = 0.02
"""Between two signs of life of this program to the loop [s]."""


class LoopThread:
    """One run after the other over a connection, each in a thread of its own.

    Parameters
    ----------
    connection
        That is open.
    real_time
        What the thread asks of the system.
    """

    def __init__(self, connection: Connection, real_time: RealTime) -> None:
        self.granted: Granted | None = None
        self._connection, self._real_time = connection, real_time
        self._failure: BaseException | None = None
        self._over = threading.Event()
        self._over.set()

    @property
    def running(self) -> bool:
        """True while the loop has not ended."""
        return not self._over.is_set()

    def run(self, loop: Shared, opened: Opened, last: int) -> None:
        """Begin; samples 0 to `last`, without end where that is negative."""
        over = self._over = threading.Event()
        loop.control[HEARTBEAT] = now()
        work = threading.Thread(
            target=self._loop, args=(loop, opened, last, over), name="zwidth loop", daemon=True
        )
        beat = threading.Thread(target=_beat, args=(loop, over), name="zwidth heartbeat", daemon=True)
        beat.start()
        work.start()

    def join(self) -> None:
        """Wait until the loop has ended."""
        self._over.wait()  # not Thread.join: Ctrl-C in it makes Python 3.11 take the thread for ended

    def wait(self, timeout: float | None = None) -> bool:
        """Wait until the loop has ended; False if it has not within so long [s]."""
        until = None if timeout is None else time.monotonic() + timeout
        while self.running:
            left = 0.1 if until is None else min(0.1, until - time.monotonic())
            if left <= 0:
                return False
            self._over.wait(left)  # in pieces: Ctrl-C is heard between them
        self.raise_failure()
        return True

    def raise_failure(self) -> None:
        """What was raised in the loop, once."""
        failure, self._failure = self._failure, None
        if failure is not None:
            raise failure

    def _loop(self, loop: Shared, opened: Opened, last: int, over: threading.Event) -> None:
        try:
            with self._real_time as self.granted:
                has_priority = "priority" in self.granted
                loop.numbers[AWAKE_MOST] = most_awake(1e9 * float(loop.numbers[PERIOD]), has_priority)
                if isinstance(self._connection, CompiledConnection):
                    run_compiled(self._connection, opened, last, loop)
                else:
                    run_library(cast(LibraryConnection, self._connection), opened, last, loop)
        except BaseException as error:  # a thread's exceptions are seen by nobody
            self._failure = error
            loop.control[REASON] = loop.control[REASON] or FAILED
            self._give_nothing()
        finally:
            over.set()

    def _give_nothing(self) -> None:
        """Force 0 once more, after a connection in Python raised something."""
        try:
            give_library(cast(LibraryConnection, self._connection), 0.0)
        except BaseException:
            self._connection.close()


def _beat(loop: Shared, over: threading.Event) -> None:
    """Signs of life, as long as the program around the loop has a main thread."""
    while not over.wait(_BEAT):
        if threading.main_thread().is_alive():
            loop.control[HEARTBEAT] = now()
