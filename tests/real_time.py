"""Tests in real time on a machine that stands still for a moment, or has much else to do.

A loop that is served then misses samples, or ends its force, as it should; what the test asks of one that was
not held up is not asked of it, and the test is made again.  On a machine that did not stand still a test that
fails has failed.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from time import monotonic
from types import TracebackType
from typing import Self

import pytest

ATTEMPTS = 20
STALL = 3e-3
"""Late by so much [s], a thread that sleeps was held up, and so may a loop of 1 kHz have been."""

_SLEEP = 1e-3


class Stalls:
    """How late a thread beside the test awoke at worst, `longest` [s]."""

    def __enter__(self) -> Self:
        self.longest = 0.0
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._watch, daemon=True)
        self._thread.start()
        return self

    def _watch(self) -> None:
        before = monotonic()
        while not self._over.wait(_SLEEP):
            before, due = monotonic(), before + _SLEEP
            self.longest = max(self.longest, before - due)

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._over.set()
        self._thread.join()


def undisturbed(attempt: Callable[[], object], again: Callable[[], object] = lambda: None) -> None:
    """Make the attempt; where it fails and the machine stood still meanwhile, `again` and once more."""
    for _ in range(ATTEMPTS - 1):
        with Stalls() as stalls:
            try:
                attempt()
                return
            except (Exception, pytest.fail.Exception):
                if stalls.longest < STALL:
                    raise
        again()
    attempt()
