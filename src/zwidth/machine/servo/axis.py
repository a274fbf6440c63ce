"""One axis of a device asked from Python, sample by sample: positions and forces along the x of a placement.

A compiled connection and one of a library are asked in the same way.  The interpreter's lock is held between
the questions: what else runs in Python makes the loop later.
"""

from __future__ import annotations

from types import TracebackType

from zwidth.machine.servo.connection import (
    FORCE,
    INDEX,
    READING,
    TIME,
    UNTIL,
    CompiledConnection,
    LibraryConnection,
    Opened,
    Placement,
    ask_library,
    give_library,
)
from zwidth.machine.servo.safety import ZEROS


class Axis:
    """A device that is reached, at a period T [s], until it is closed."""

    def __init__(
        self, connection: CompiledConnection | LibraryConnection, placement: Placement, sample_period: float
    ) -> None:
        self.connection, self.placement, self.period = connection, placement, sample_period
        self._opened: Opened | None = None
        if isinstance(connection, CompiledConnection):
            self._opened = connection.open(sample_period)
            self._at_first = self._opened.memory.copy()
        else:
            connection.open(sample_period)

    def __enter__(self) -> Axis:
        """Itself."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, raised: BaseException | None, where: TracebackType | None
    ) -> None:
        """As `close`."""
        self.close()

    def begin(self) -> None:
        """The next sample is number 0: of a simulated device the script begins anew."""
        if self._opened is not None and self.connection.samples is not None:
            self._opened.memory[:] = self._at_first

    def measure(self, k: int, until: int, late: float = 0.0) -> tuple[int, float]:
        """(what became of sample k, x [m; rad]), where the loop is `late` [s], less than T.

        Waits until the clock `posix.now` reads `until` at most.
        """
        if self._opened is None:
            assert isinstance(self.connection, LibraryConnection)
            status, reading = ask_library(self.connection, until)
        else:
            assert isinstance(self.connection, CompiledConnection)
            memory = self._opened.memory
            memory[TIME], memory[INDEX], memory[UNTIL] = k * self.period + late, k, until
            status = type(self.connection).measure(*self._opened)
            reading = float(memory[READING])
        return status, self.placement.sense * (reading - self.placement.origin)

    def give(self, force: float) -> int:
        """Give a force, positive along x [N; N·m]; what became of it."""
        along = self.placement.sense * force
        if self._opened is None:
            assert isinstance(self.connection, LibraryConnection)
            return give_library(self.connection, along)
        assert isinstance(self.connection, CompiledConnection)
        self._opened.memory[FORCE] = along
        return type(self.connection).apply(*self._opened)

    def let_go(self) -> None:
        """Force 0, said more than once."""
        for _ in range(ZEROS):
            self.give(0.0)

    def close(self) -> None:
        """Force 0, then the device is let go; may be called again."""
        self.connection.close()
