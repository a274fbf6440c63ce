"""The loop: wait for the next sample's time, ask, compute, give, write down.

Sample k is due at t_0 + k T, whatever became of those before: deadlines are absolute.  The loop sleeps until
shortly before and then watches the clock.  Where it comes a period late or more, samples are missed: neither
asked for nor computed, the force as it was.

Of a compiled connection all of this is compiled, and runs without the interpreter's lock.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from copy import deepcopy
from typing import NamedTuple, cast

import numpy as np

from zwidth.machine.servo.connection import (
    CLOSED,
    FORCE,
    GOOD,
    INDEX,
    REFUSED,
    TIME,
    UNTIL,
    ZEROS,
    CompiledConnection,
    Connection,
    LibraryConnection,
    Opened,
    questions,
)
from zwidth.machine.servo.cycle import (
    AWAKE_MOST,
    CONTROL,
    HEARTBEAT,
    MISSED,
    NONE,
    NUMBERS,
    PERIOD,
    REASON,
    ROWS,
    SENSE,
    SERVED,
    WANTED,
    Words,
    answer,
    noted,
)
from zwidth.machine.servo.posix import ANSWERED, MARGIN, Bytes, margin, most_awake, now, until
from zwidth.machine.servo.priority import Granted, RealTime
from zwidth.machine.servo.ring import BINS
from zwidth.machine.servo.safety import BAD_ANSWER, DONE, FAILED, RUNNING
from zwidth.native.compiled import Array, compiled


class Shared(NamedTuple):
    """What the loop works on, and what the program around it sees."""

    laws: Array
    memories: Array
    rests: Array
    control: Words
    numbers: Array
    counts: Array
    ring: Array
    spread: Words


def shared(capacity: int, remembered: int, ring: Array, counts: int) -> Shared:
    """All of it, allocated once: room for two packed laws of so many numbers, which remember so many."""
    control = np.zeros(CONTROL, np.int64)
    control[WANTED] = control[SERVED] = NONE
    return Shared(
        laws=np.full((2, capacity), 0.0),  # np.zeros has no pages yet
        memories=np.full((2, remembered), 0.0),
        rests=np.full((2, 2, 2, remembered), 0.0),
        control=control,
        numbers=np.zeros(NUMBERS),
        counts=np.full(counts, 0.0),
        ring=ring,
        spread=np.zeros(BINS, np.int64),
    )


@compiled
def await_sample(k: int, start: int, period: float, awake: int, most: int) -> tuple[int, int, int, int]:
    """Wait for sample k, or the next one that can still be taken.

    Returns its number, when it was due, the time now, and the `awake` of the next one: how long before a
    deadline the clock is watched [ns], `most` at most, see `posix.margin`.
    """
    due = start + int(k * period)
    awake = margin(awake, until(due, awake), most)
    at = now()
    missed = int((at - due) / period)
    if missed > 0:
        k += missed
        due = start + int(k * period)
    return k, due, at, awake


@compiled
def lateness(at: int, due: int, period: float) -> float:
    """How late a sample is [s], less than T."""
    return min(max((at - due) * 1e-9, 0.0), period * (1.0 - 1e-9))


@compiled
def _run(
    measure: Callable[[Array, Bytes, Bytes], int],
    apply: Callable[[Array, Bytes, Bytes], int],
    last: int,
    memory: Array,
    inbox: Bytes,
    outbox: Bytes,
    laws: Array,
    memories: Array,
    rests: Array,
    control: Words,
    n: Array,
    counts: Array,
    ring: Array,
    spread: Words,
) -> None:
    """All samples from 0 to `last`, or for ever where it is negative, or until the force ends."""
    period = n[PERIOD] * 1e9
    k, zeros = 0, 0
    most = int(n[AWAKE_MOST])
    start, awake = now(), min(MARGIN, most)
    while True:
        taken, due, at, awake = await_sample(k, start, period, awake, most)
        if k == 0:
            taken, due, start = 0, at, at
        if control[REASON] == RUNNING:
            if 0 <= last < taken:
                control[REASON] = DONE
            else:
                control[MISSED] += taken - k
        k = taken
        late = lateness(at, due, n[PERIOD])
        memory[TIME], memory[INDEX] = k * n[PERIOD] + late, k
        memory[UNTIL] = at + ANSWERED * period
        status = measure(memory, inbox, outbox)
        row = ring[control[ROWS] % ring.shape[0], :]
        t = memory[TIME]
        force = answer(status, k, t, at, memory, laws, memories, rests, control, n, counts, row)
        memory[FORCE] = -n[SENSE] * force
        given = apply(memory, inbox, outbox)
        if given in (CLOSED, REFUSED) and control[REASON] == RUNNING:
            control[REASON] = BAD_ANSWER + given
        noted(row, late, (now() - at) * 1e-9, control, n, spread)
        k += 1
        if control[REASON] != RUNNING:
            zeros += 1
            if zeros == ZEROS:
                return


def _find(memory: Array, shared: Shared) -> None:
    """Have what the loop in Python calls found in the library before the clock runs; on copies."""
    loop = deepcopy(shared)
    await_sample(0, now(), float(loop.numbers[PERIOD]) * 1e9, 0, 0)
    lateness(0, 0, float(loop.numbers[PERIOD]))
    answer(GOOD, 0, 0.0, now(), memory.copy(), *loop[:-2], loop.ring[0])
    noted(loop.ring[0], 0.0, 0.0, loop.control, loop.numbers, loop.spread)


def run(connection: Connection, opened: Opened, last: int, shared: Shared) -> None:
    """Run the loop up to sample `last` or, below 0, until it ends.

    Over a library it is one in Python: whatever else runs in Python delays it.
    """
    loop = _run
    if not isinstance(connection, CompiledConnection):
        _find(opened.memory, shared)
        loop = _run.py_func  # type: ignore[attr-defined]
    loop(*questions(connection), last, *opened, *shared)  # type: ignore[arg-type]  # arrays of three kinds


_BEAT = 0.02
"""Between two signs of life of this program to the loop [s]."""


class LoopThread:
    """One run after the other over a connection that is open, each in a thread of its own."""

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
                run(self._connection, opened, last, loop)
        except BaseException as error:  # a thread's exceptions are seen by nobody
            self._failure = error
            loop.control[REASON] = loop.control[REASON] or FAILED
            self._give_nothing()
        finally:
            over.set()

    def _give_nothing(self) -> None:
        """Force 0 once more, after a connection in Python raised something."""
        try:
            cast(LibraryConnection, self._connection).apply(0.0)
        except BaseException:
            self._connection.close()


def _beat(loop: Shared, over: threading.Event) -> None:
    """Signs of life, as long as the program around the loop has a main thread."""
    while not over.wait(_BEAT):
        if threading.main_thread().is_alive():
            loop.control[HEARTBEAT] = now()
