"""A device that reads what a script says, and keeps the forces it was given."""

from typing import Any, ClassVar

import numpy as np

from zwidth.machine.servo.connection import (
    FORCE,
    GOOD,
    INDEX,
    OWN,
    READING,
    CompiledConnection,
    LibraryConnection,
    Opened,
    blank,
    exchanged,
)
from zwidth.machine.servo.posix import pause

LENGTH, PAUSED, PAUSE = OWN, OWN + 1, OWN + 2
SCRIPT = OWN + 3
"""Behind it: readings, what becomes of each question, forces as they were given."""


@exchanged
def _measure(s: Any, inbox: Any, outbox: Any) -> int:
    n = int(s[LENGTH])
    k = min(int(s[INDEX]), n - 1)
    if k == s[PAUSED]:
        pause(int(s[PAUSE]))
    s[READING] = s[SCRIPT + k]
    return int(s[SCRIPT + n + k])


@exchanged
def _apply(s: Any, inbox: Any, outbox: Any) -> int:
    n = int(s[LENGTH])
    k = int(s[INDEX])
    if k < n:
        s[SCRIPT + 2 * n + k] = s[FORCE]
    return GOOD


class Played(CompiledConnection):
    """Readings of a list; `bad` has the statuses of samples that are not good."""

    motion = "linear"
    on_silence = "nothing: it is a list"
    measure: ClassVar[Any] = _measure
    apply: ClassVar[Any] = _apply

    def __init__(
        self, readings: Any, bad: dict[int, int] | None = None, paused: tuple[int, float] | None = None
    ) -> None:
        self.readings, self.bad, self.paused = np.asarray(readings, float), bad or {}, paused
        self.closed = 0

    @property
    def samples(self) -> int:
        return self.readings.size - 1

    def open(self, sample_period: float) -> Opened:
        n = self.readings.size
        opened = blank(3 + 3 * n, 1, 1)
        s = opened.memory
        s[LENGTH] = n
        s[PAUSED], s[PAUSE] = (-1, 0) if self.paused is None else (self.paused[0], 1e9 * self.paused[1])
        s[SCRIPT : SCRIPT + n] = self.readings
        for k, status in self.bad.items():
            s[SCRIPT + n + k] = status
        self.opened = opened
        return opened

    @property
    def forces(self) -> np.ndarray:
        n = self.readings.size
        return self.opened.memory[SCRIPT + 2 * n :]

    def close(self) -> None:
        self.closed += 1

    def describe(self) -> str:
        return "a list"


class Library(LibraryConnection):
    """The same as a library in Python; at sample `fails` it raises."""

    motion = "linear"
    on_silence = "nothing: it is a list"

    def __init__(self, readings: Any, fails: int = -1) -> None:
        self.readings, self.fails = list(readings), fails
        self.forces: list[float] = []
        self.asked = 0

    def open(self, sample_period: float) -> None:
        pass

    def measure(self, until: int) -> tuple[int, float]:
        k, self.asked = self.asked, self.asked + 1
        if k == self.fails:
            raise OSError("the cable is out")
        return GOOD, self.readings[min(k, len(self.readings) - 1)]

    def apply(self, force: float) -> int:
        self.forces.append(force)
        return GOOD

    def close(self) -> None:
        pass

    def describe(self) -> str:
        return "a list"
