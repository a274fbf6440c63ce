"""One seed: its document is written, checked, judged if it was accepted, and made smaller if it is false."""

from __future__ import annotations

import copy
import json
import resource
import signal
import sys
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from fractions import Fraction
from typing import Any, NamedTuple

import numpy as np

from .checked import ask
from .grammar import Document, Valid, Written, is_number, leaves, write
from .judges import judge
from .opinion import AGREES, FALSE, OPEN, Opinion

REFUSED, ILL_FORMED, ERROR = "refused", "ill-formed accepted", "error"
WORDS = (REFUSED, AGREES, OPEN, FALSE, ILL_FORMED, ERROR)
FINDINGS = (FALSE, ILL_FORMED, ERROR)

PATIENCE = 60
"""Seconds of the processor after which a document is given up: an error of the checker, open for a judge."""

TICK = 5

SHRINK_S = 3.0

QUICK_S = 0.02
"""What is checked in less is not measured closer: to ask the system takes as long as to check a document."""


class Examined(NamedTuple):
    """One of `WORDS`, why, the check's time [s of processor], the process's room where it grew [MB]."""

    written: Written
    word: str
    why: str
    seconds: float
    room: float


class _TooLong(Exception):
    """Longer than anybody would wait."""


class _Watch:
    """Stops what takes too long.

    A clock of the processor ticks all the time, and nothing has to be asked of the system for a document.
    """

    def __init__(self) -> None:
        self.left: int | None = None

    def begin(self) -> None:
        """Let the clock of this process tick."""
        signal.signal(signal.SIGPROF, self._tick)
        signal.setitimer(signal.ITIMER_PROF, TICK, TICK)

    def _tick(self, *_: object) -> None:
        if self.left is not None:
            self.left -= 1
            if self.left < 0:
                raise _TooLong

    def __enter__(self) -> None:
        self.left = PATIENCE // TICK

    def __exit__(self, *_: object) -> None:
        self.left = None


watch = _Watch()
"""To be begun in each process; without, nothing is stopped."""


def examine(seed: int, seeds: Mapping[str, Valid], only: str | None = None) -> Examined:
    """The document of a seed, judged."""
    written = write(seed, seeds, only)
    start = time.perf_counter()
    valid, reason = _asked(written.document)
    seconds, room = time.perf_counter() - start, 0.0
    if seconds > QUICK_S:
        seconds = _of_processor(written.document)
        room = _most.grown()
    opinion = Opinion(REFUSED, reason) if valid is False else Opinion(ERROR, reason)
    if valid:
        opinion = (
            Opinion(ILL_FORMED, reason) if written.ill_formed else judged(written.document, seed, reason)
        )
    return Examined(written, *opinion, seconds, room)


def _of_processor(document: Any) -> float:
    """Seconds of the processor that the check takes if nothing has to be compiled for it."""
    start = time.process_time()
    _asked(document)
    return time.process_time() - start


class _Most:
    """The most room that the process has taken so far [MB]."""

    def __init__(self) -> None:
        self.room = 0.0

    def grown(self) -> float:
        """What it is now, 0 if it has not grown since it was asked for last."""
        before, self.room = self.room, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1000
        return self.room if self.room > before else 0.0


_most = _Most()


def _asked(document: Any) -> tuple[bool | None, str]:
    """Whether it is accepted, None where the checker failed, and why."""
    try:
        with watch:
            answer = ask(document)
    except _TooLong:
        return None, f"not checked in {PATIENCE} s"
    except Exception as error:  # what a user would see as a traceback
        return None, f"{type(error).__name__}: {error}"[:200]
    return answer.valid, answer.reason


def judged(document: Document, seed: int, reason: str = "") -> Opinion:
    """The judge's opinion of what the checker proved.

    It cannot say of numbers that no double holds, nor after too long.
    """
    try:
        with np.errstate(all="ignore"), numbers_of_any_length(), watch:
            return judge(document, np.random.default_rng(seed), reason)
    except _TooLong:
        return Opinion(OPEN, f"not judged in {PATIENCE} s")
    except (OverflowError, FloatingPointError, np.linalg.LinAlgError) as error:
        return Opinion(OPEN, f"numbers that no double holds: {error}")
    except Exception as error:  # a judge that fails says nothing, and must be mended
        return Opinion(ERROR, f"the judge failed: {type(error).__name__}: {error}"[:200])


@contextmanager
def numbers_of_any_length() -> Iterator[None]:
    """Judges may read and write more than 4300 digits at a time; the checker must do without."""
    before = sys.get_int_max_str_digits()
    sys.set_int_max_str_digits(0)
    try:
        yield
    finally:
        sys.set_int_max_str_digits(before)


def shrunken(found: Examined, seed: int) -> Any:
    """A smaller document of which the same is said, as far as a few seconds reach."""
    best, until = found.written.document, time.perf_counter() + SHRINK_S
    if found.word != FALSE:
        return best
    again = True
    while again:
        again = False
        for smaller in _smaller(best):
            if time.perf_counter() > until:
                return best
            if len(json.dumps(smaller)) < len(json.dumps(best)) and _still_false(smaller, seed):
                best, again = smaller, True
                break
    return best


def _still_false(document: Any, seed: int) -> bool:
    valid, reason = _asked(document)
    return bool(valid) and judged(document, seed, reason).word == FALSE


def _smaller(document: Any) -> Iterator[Any]:
    """Without an entry, or with a shorter number."""
    for path, inner in list(_places(document)):
        if isinstance(inner, list):
            for at in range(len(inner)):
                yield _with(document, path, [*inner[:at], *inner[at + 1 :]])
        elif isinstance(inner, dict):
            for key in inner:
                yield _with(document, path, {k: v for k, v in inner.items() if k != key})
    for path, value in leaves(document):
        if is_number(value) and isinstance(value, str):
            exact = Fraction(value)
            for text in ("0", "1", *(f"{float(exact):.{n}g}" for n in (1, 2, 4) if abs(exact) < 10**300)):
                if len(text) < len(value):
                    yield _with(document, path, text)


def _places(value: Any, path: tuple[Any, ...] = ()) -> Iterator[tuple[tuple[Any, ...], Any]]:
    yield path, value
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, inner in items:
        if isinstance(inner, (dict, list)):
            yield from _places(inner, (*path, key))


def _with(document: Any, path: tuple[Any, ...], value: Any) -> Any:
    if not path:
        return value
    changed = copy.deepcopy(document)
    inner = changed
    for key in path[:-1]:
        inner = inner[key]
    inner[path[-1]] = value
    return changed


def told(found: Examined, seed: int) -> str:
    """A finding as text: its smallest form, what it was made of, and the reason."""
    words = {"seed": seed, "word": found.word, "why": found.why, "how": found.written.how}
    try:
        with numbers_of_any_length():
            return json.dumps({**words, "document": shrunken(found, seed)}, indent=1, default=str)
    except RecursionError:  # lists too deep for any text
        return json.dumps(words, indent=1)
