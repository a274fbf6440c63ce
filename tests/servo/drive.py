"""Measures and gives forces as the loop does, as fast as the other side answers; keeps what became of it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

from zwidth.servo.connection import (
    CLOSED,
    FORCE,
    GOOD,
    INDEX,
    READING,
    REFUSED,
    TIME,
    UNTIL,
    CompiledConnection,
    LibraryConnection,
)
from zwidth.servo.posix import now


@dataclass
class Driven:
    """One entry a period: what became of the question, the position [m; rad], the force given [N; N·m]."""

    statuses: list[int] = field(default_factory=list)
    readings: list[float] = field(default_factory=list)
    forces: list[float] = field(default_factory=list)
    zeroed_after: int | None = None
    """Periods from the first bad exchange of the last run of them to the force 0; None if none was needed."""


def drive(
    connection: CompiledConnection | LibraryConnection,
    periods: int,
    law: Callable[[float], float] = lambda reading: 1.0,
    *,
    sample_period: float = 1e-3,
    wait: float = 2.0,
) -> Driven:
    """Open, run so many periods of the law, give 0 and close; end early as the loop does.

    A bad exchange holds the force for one period; a second one in a row, or a closed line, or a fault that
    the device itself reports, gives 0 at once and ends the run.  An answer is waited for `wait` [s]: long,
    since the emulator shares the machine with others; where none will come, a test gives less.
    """
    run = Driven()
    if isinstance(connection, CompiledConnection):
        memory, inbox, outbox = connection.open(sample_period)
        compiled = type(connection)  # of an instance they would be bound to it

        def measure() -> tuple[int, float]:
            return compiled.measure(memory, inbox, outbox), float(memory[READING])

        def apply(force: float) -> int:
            memory[FORCE] = force
            return compiled.apply(memory, inbox, outbox)

    else:
        connection.open(sample_period)
        memory = [0.0] * 8
        library = connection

        def measure() -> tuple[int, float]:
            return library.measure(int(memory[UNTIL]))

        apply = library.apply

    force, bad = 0.0, 0
    for index in range(periods):
        memory[TIME], memory[INDEX] = index * sample_period, index
        memory[UNTIL] = now() + wait * 1e9
        status, reading = measure()
        bad = 0 if status == GOOD else bad + 1
        over = bad > 1 or status in (CLOSED, REFUSED)
        if over:
            force = 0.0
        elif status == GOOD:
            force = law(reading)
        apply(force)
        run.statuses.append(status)
        run.readings.append(reading)
        run.forces.append(force)
        if over:
            run.zeroed_after = bad - 1
            break
    apply(0.0)
    connection.close()
    return run
