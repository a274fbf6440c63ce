"""What an adapter of a motor says to each fault of the other side: at the first bad exchange and the next."""

from __future__ import annotations

from collections.abc import Callable
from itertools import count

from servo.emulators.faults import Fault

from zwidth.machine.servo.connection import CLOSED, GARBLED, SILENT, STALE

ANSWERS: dict[Fault, list[int]] = {
    Fault.CLOSED: [CLOSED],
    Fault.HALF_FRAME: [GARBLED, GARBLED],
    Fault.GARBAGE: [GARBLED, GARBLED],
    Fault.SILENCE: [SILENT, SILENT],
    Fault.LATE_ANSWERS: [SILENT, STALE],
    Fault.WRONG_CHECKSUM: [GARBLED, GARBLED],
}

NO_FAULTS = [Fault.DUPLICATE, Fault.SLOW]


def changing(sample: int, change: Callable[[], object], force: float = 0.2) -> Callable[[float], float]:
    """A law of a constant force that, at its sample of this number, changes the other side."""
    samples = count(1)

    def law(reading: float) -> float:
        if next(samples) == sample:
            change()
        return force

    return law
