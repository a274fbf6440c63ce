"""A process that computes chunks for another: it reads places from its input and writes layers to its output.

It is started as a program of its own and not as a copy of the one that asks, so that a script needs no
guard around its main part; and where the one that asks is killed its input ends, and so does it.
"""

from __future__ import annotations

import os
import pickle
import signal
import subprocess
import sys
from collections.abc import Callable
from contextlib import suppress
from typing import Any

from zwidth.errors import InputError
from zwidth.study.chunks.layout import Layers, Place


class Worker:
    """The process, as it is seen from the one that asks.

    Parameters
    ----------
    compute
        A function of a module: from what was made ready, and a place, to layers.
    ready
        What was made ready.
    """

    def __init__(self, compute: Callable[[Any, Place], Layers], ready: Any) -> None:
        command = [sys.executable, "-c", "from zwidth.study.chunks.worker import serve; serve()"]
        path = os.pathsep.join(filter(None, sys.path))
        self.process = subprocess.Popen(
            command,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            env={**os.environ, "PYTHONPATH": path},
        )
        self._say((compute, ready))

    def ask(self, place: Place) -> Layers:
        """The layers of one chunk."""
        try:
            self._say(place)
            failed, answer = pickle.load(self.process.stdout)  # type: ignore[arg-type]  # it is a pipe
        except (EOFError, OSError, pickle.UnpicklingError):
            raise InputError(
                "a process that computed for this one ended before its time, for want of memory or because "
                "somebody ended it; the same command goes on, with fewer --workers if memory is short"
            ) from None
        if failed:
            raise answer
        return answer  # type: ignore[no-any-return]

    def dismiss(self) -> None:
        """End it; what it is at is lost."""
        self.process.kill()
        self.process.wait()
        for stream in (self.process.stdin, self.process.stdout):
            with suppress(OSError):  # what was still to be said to it
                stream.close()  # type: ignore[union-attr]  # both are pipes

    def _say(self, message: Any) -> None:
        stream = self.process.stdin
        assert stream is not None
        pickle.dump(message, stream)
        stream.flush()


def serve() -> None:
    """Answer until there is nobody who asks."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the one that asks, who then ends this one
    asked, answers = sys.stdin.buffer, os.fdopen(os.dup(sys.stdout.fileno()), "wb")
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())  # what is printed is no answer
    try:
        compute, ready = pickle.load(asked)
        while True:
            place = pickle.load(asked)
            try:
                answer: tuple[bool, Any] = False, compute(ready, place)
            except Exception as error:
                answer = True, error
            pickle.dump(answer, answers)
            answers.flush()
    except (EOFError, BrokenPipeError):
        return
