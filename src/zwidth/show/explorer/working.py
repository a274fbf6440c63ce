"""What takes longer than a moment is computed beside the pages, in processes of its own, for so long at most.

A process can be ended, a thread cannot: a computation that takes too long, or that nobody waits for any more,
ends with its process, and a new one takes its place.  Of one asker and one kind the newest job alone is done.
"""

from __future__ import annotations

import multiprocessing
from collections.abc import Callable
from multiprocessing.connection import Connection
from threading import Condition, Thread
from time import monotonic
from typing import Any, NamedTuple

from zwidth.errors import InputError
from zwidth.quantity.text import shown

LONGEST = 60.0
"""A job may take [s]: it is seconds."""

LONGEST_WAIT = 1.0
"""For a job that nobody waits for any more [s]: a new process takes about as long."""

_STEP = 0.05

_NO_PROCESS = (
    "what takes longer could not be computed: no process could be started beside this one; a script starts "
    'it under `if __name__ == "__main__":`'
)


class Answer(NamedTuple):
    """What came of a job: a value, or a message why there is none."""

    value: Any
    message: str = ""


class _Job(NamedTuple):
    key: tuple[int, str]
    number: int
    compute: Callable[..., Any]
    arguments: tuple[Any, ...]
    then: Callable[[Answer], None]


class Workers:
    """So many processes, started when there is something to do.

    `longest`: a job may take [s].
    """

    def __init__(self, count: int = 2, longest: float = LONGEST) -> None:
        self._longest = longest
        self._changed = Condition()
        self._waiting: dict[tuple[int, str], _Job] = {}
        self._newest: dict[tuple[int, str], int] = {}
        self._number = 0
        self._closed = False
        self._threads = [
            Thread(target=self._work, name=f"zwidth work {n}", daemon=True) for n in range(count)
        ]
        for thread in self._threads:
            thread.start()

    def submit(
        self,
        asker: int,
        kind: str,
        compute: Callable[..., Any],
        arguments: tuple[Any, ...],
        then: Callable[[Answer], None],
    ) -> None:
        """Have something computed; an older job of the same asker and kind is forgotten.

        `asker`, `kind`: whose job it is, and which of theirs.
        `compute`: a function of a module, which the process imports.
        `arguments`: that can be sent to it.
        `then`: is told the answer, in a thread of these.
        """
        with self._changed:
            self._number += 1
            key = (asker, kind)
            self._newest[key] = self._number
            self._waiting[key] = _Job(key, self._number, compute, arguments, then)
            self._changed.notify()

    def forget(self, asker: int) -> None:
        """Nobody waits for the jobs of an asker any more."""
        with self._changed:
            for key in [key for key in self._newest if key[0] == asker]:
                del self._newest[key]
                self._waiting.pop(key, None)

    def close(self) -> None:
        """End all of it."""
        with self._changed:
            self._closed = True
            self._newest.clear()
            self._waiting.clear()
            self._changed.notify_all()
        for thread in self._threads:
            thread.join()

    def _work(self) -> None:
        process: _Process | None = None
        while (job := self._next()) is not None:
            try:
                process = process or _Process(lambda: self._closed)
            except (EOFError, OSError, RuntimeError):
                if self._is_wanted(job):
                    job.then(Answer(None, _NO_PROCESS))
                continue
            answer = self._answer(process, job)
            if answer is None or not process.alive:
                process.end()
                process = None
            if answer is not None and self._is_wanted(job):
                job.then(answer)
        if process is not None:
            process.end()

    def _next(self) -> _Job | None:
        with self._changed:
            while not self._waiting and not self._closed:
                self._changed.wait()
            return None if self._closed else self._waiting.pop(next(iter(self._waiting)))

    def _is_wanted(self, job: _Job) -> bool:
        return self._newest.get(job.key) == job.number

    def _answer(self, process: _Process, job: _Job) -> Answer | None:
        """The answer; None where the process must be ended because nobody waits."""
        process.send(job.compute, job.arguments)
        began = monotonic()
        while not process.answers(_STEP):
            since = monotonic() - began
            if not self._is_wanted(job) and (since > LONGEST_WAIT or self._closed):
                return None
            if since > self._longest:
                process.end()
                return Answer(
                    None,
                    f"this took more than {shown(self._longest, 's', 6)}, the most that the page spends; the "
                    "command line has no such limit",
                )
        return process.answer()


class _Process:
    """One process, which does one job after the other.

    EOFError where it ends, or is given up, before it is ready.
    """

    def __init__(self, is_given_up: Callable[[], bool]) -> None:
        context = multiprocessing.get_context("spawn")
        self._here, there = context.Pipe()
        self._process = context.Process(target=_serve, args=(there,), daemon=True)
        self._process.start()
        there.close()
        while not self._here.poll(_STEP):
            if is_given_up():
                self.end()
                raise EOFError
        self.alive = self._here.recv()  # it is ready: its time counts from now

    def send(self, compute: Callable[..., Any], arguments: tuple[Any, ...]) -> None:
        self._here.send((compute, arguments))

    def answers(self, within: float) -> bool:
        """True where there is an answer, or never will be."""
        return self._here.poll(within)

    def answer(self) -> Answer:
        try:
            found: Answer = self._here.recv()
        except (EOFError, OSError):
            self.alive = False
            return Answer(None, "the computation ended without an answer; it may have been too large")
        return found

    def end(self) -> None:
        self.alive = False
        self._process.kill()
        self._process.join()
        self._here.close()


def _serve(there: Connection) -> None:
    """Of the process: do what comes, until nothing comes any more."""
    import signal

    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the page, which then ends this
    there.send(True)
    while True:
        try:
            compute, arguments = there.recv()
        except EOFError:
            return
        there.send(_computed(compute, arguments))


def _computed(compute: Callable[..., Any], arguments: tuple[Any, ...]) -> Answer:
    try:
        return Answer(compute(*arguments))
    except InputError as error:
        return Answer(None, str(error))
    except Exception as error:  # a page says that it failed, and goes on
        return Answer(None, f"this could not be computed: {type(error).__name__}")
