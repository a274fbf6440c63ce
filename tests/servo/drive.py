"""Measures and gives forces as the loop does, as fast as the other side answers; keeps what became of it."""

from collections.abc import Callable
from dataclasses import dataclass, field
from itertools import count
from typing import TypeVar

from zwidth.machine.servo.connection import (
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
from zwidth.machine.servo.posix import now

PATIENCE = 60.0
"""For an answer that comes [s]: a busy machine, or one that stands still for some seconds, is no fault."""

Other = TypeVar("Other")


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
    wait: float = PATIENCE,
) -> Driven:
    """Open, run so many periods of the law, give 0 and close; end early as the loop does.

    A bad exchange holds the force for one period; a second one in a row, or a closed line, or a fault that
    the device itself reports, gives 0 at once and ends the run.  An answer is waited for `wait` [s], see
    `drive_into` for where none will come.
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


def drive_into(expected: list[int], attempt: Callable[[float], tuple[Other, Driven]]) -> tuple[Other, Driven]:
    """Drive into a fault: `attempt` is told how long to wait for an answer; the other side, and the run.

    Where an answer does not come the wait is to be short, and of a machine that stands still meanwhile it is
    too short for those that do: a run that does not begin as `expected` is made again with more time.
    """
    for wait in (0.2, 4.0, 30.0):
        other, run = attempt(wait)
        if run.statuses[: len(expected)] == expected:
            break
    return other, run


def changing(sample: int, change: Callable[[], object], force: float = 0.2) -> Callable[[float], float]:
    """A law of a constant force that, at its sample of this number, changes the other side."""
    samples = count(1)

    def law(reading: float) -> float:
        if next(samples) == sample:
            change()
        return force

    return law
