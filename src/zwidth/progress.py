"""A progress bar on standard error, for a person who has waited over a second."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import wraps
from typing import TYPE_CHECKING, ParamSpec, TypeVar

if TYPE_CHECKING:
    from rich.progress import Progress

P = ParamSpec("P")
R = TypeVar("R")

SHOWN_AFTER = 1.0
"""Seconds before the bar appears."""


@contextmanager
def progress_bar(what: str) -> Iterator[Callable[[int, int], None]]:
    """A function to be told (done, in all); it draws nothing where nobody watches.

    Parameters
    ----------
    what
        What is counted, such as "samples".
    """
    if not sys.stderr.isatty():
        yield lambda done, total: None
        return
    bar = _Bar(what)
    try:
        yield bar.report
    finally:
        bar.close()


def falling(progress: Callable[[int, int], None]) -> Callable[[int], None]:
    """Progress for a number that falls to 0, not always steadily: the most there were, less what is left."""
    most = 0

    def report(left: int) -> None:
        nonlocal most
        most = max(most, left)
        progress(most - left, most)

    return report


def with_bar(function: Callable[P, R], what: str, falls: bool = False) -> Callable[P, R]:
    """The same function, with a bar of what is counted where nobody else asks to be told of its progress.

    Parameters
    ----------
    function
        It takes `progress`.
    what
        What is counted.
    falls
        True where it is told a number that falls to 0.
    """

    @wraps(function)
    def run(*args: P.args, **kwargs: P.kwargs) -> R:
        if "progress" in kwargs:
            return function(*args, **kwargs)
        with progress_bar(what) as progress:
            kwargs["progress"] = falling(progress) if falls else progress
            return function(*args, **kwargs)

    return run


class _Bar:
    def __init__(self, what: str) -> None:
        self._what = what
        self._start = time.monotonic()
        self._bar: Progress | None = None

    def report(self, done: int, total: int) -> None:
        if self._bar is None:
            if time.monotonic() - self._start < SHOWN_AFTER or done >= total:
                return
            from rich.console import Console  # only for those who wait
            from rich.progress import BarColumn, MofNCompleteColumn, Progress, TimeRemainingColumn

            columns = (BarColumn(), MofNCompleteColumn(), self._what, TimeRemainingColumn())
            self._bar = Progress(*columns, console=Console(stderr=True), transient=True)
            self._bar.start()
            self._bar.add_task("", total=total)
        self._bar.update(self._bar.task_ids[0], completed=done, total=total)

    def close(self) -> None:
        if self._bar is not None:
            self._bar.stop()
