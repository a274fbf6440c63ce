"""What the loop asks of a device: a position, and to give a force.

A device is reached in one of two ways.  Where its protocol is bytes over a descriptor (a serial port, a
socket) the two questions are compiled functions, called from the loop's thread without the interpreter's
lock.  Where only a library speaks it they are methods in Python; the loop is then one in Python as well.

Both have one axis, in SI units and in the device's own zero and sense: `Placement` says where on it the
wall is.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from math import nan
from typing import ClassVar, Literal, NamedTuple, Self, cast

import numpy as np

from zwidth.errors import InputError
from zwidth.machine.servo.posix import Bytes
from zwidth.model.specification.table import Table, located
from zwidth.native.compiled import Array, compiled
from zwidth.quantity.exact import Exact, RealLike
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.parameter import Parametric, Reads, parameter, plain, read_number

# What a compiled connection and the loop say to each other, the first numbers of its memory:
# the descriptor; the force that the device is to give along its axis; the position that it read; time [s] and
# number of the sample since the loop began; until when an answer may be waited for [ns, of `posix.now`].
# From TOLD on: what it tells besides, see `Connection.tells`; from OWN on: what it remembers itself.
DESCRIPTOR, FORCE, READING, TIME, INDEX, UNTIL = range(6)
TOLD = 8
MOST_TOLD = 12
OWN = TOLD + MOST_TOLD

# What became of a question.
GOOD, SILENT, GARBLED, STALE, REFUSED, CLOSED = range(6)

STATUS = {
    GOOD: "good",
    SILENT: "no answer in time",
    GARBLED: "an answer that is no whole frame, or whose checksum is wrong",
    STALE: "an answer to an earlier question",
    REFUSED: "the device itself reports a fault",
    CLOSED: "the other side has closed",
}


Setting = tuple[str, str, str, str, str]
"""What is set in a device that can change sign, size or end of a force.

Its name as the maker has it (of a servo with the address of its register); its value as delivered, "" where
the maker does not say it; the effect; what is done about it before any force is given, one of `DONE`; file
and line, or page, in the version that `Connection.maker` names.
"""

REFUSES, TELLS, RESTORES, SETS, LEAVES = DONE = "read; refused", "read; told", "set; put back", "set", "left"

ZEROS = 3
"""How often force 0 is given after the end: a frame may be lost."""

exchanged = compiled
"""Of ``f(memory, inbox, outbox) -> status``, which the loop is given."""


Question = Callable[[Array, Bytes, Bytes], int]


class Opened(NamedTuple):
    """What a compiled connection works on; allocated once."""

    memory: Array
    inbox: Bytes
    outbox: Bytes


def blank(own: int, inbox: int = 512, outbox: int = 512) -> Opened:
    """Memory with room for `own` numbers from OWN on, and for so many bytes in and out."""
    return Opened(np.zeros(OWN + own), np.zeros(inbox, np.uint8), np.zeros(outbox, np.uint8))


class Closing(ABC):
    """What is closed at the end of a ``with``."""

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    @abstractmethod
    def close(self) -> object:
        """Give back what was taken; may be called again."""


class Connection(ABC):
    """A device that can be served, one axis of it."""

    motion: ClassVar[Literal["linear", "rotary"]]
    """Of the readings and forces: metres and newtons, or radians and newton metres."""

    late: ClassVar[int] = 0
    """Samples that a force waits by the protocol: 1 where it travels with the next question."""

    tells: ClassVar[tuple[str, ...]] = ()
    """What it tells besides the position, units in the names; `MOST_TOLD` numbers, from memory[TOLD] on."""

    maker: ClassVar[str] = ""
    """Whose words `settings` go by, and of which version."""

    settings: ClassVar[tuple[Setting, ...]] = ()
    """All that can change sign, size or end of its force, as far as the maker tells."""

    met_hardware: ClassVar[bool] = False
    """False where only an emulator of the other side has been met."""

    @property
    @abstractmethod
    def on_silence(self) -> str:
        """What the device does by itself when nothing comes any more, in words."""

    @property
    def samples(self) -> int | None:
        """None; of a simulated device the samples of its script, which begins anew with every run."""
        return None

    @abstractmethod
    def close(self) -> None:
        """Zero force, then let the device go; may be called again, and on a device that is gone."""

    @abstractmethod
    def describe(self) -> str:
        """Which device, over what, which axis: one line."""


class CompiledConnection(Connection):
    """A device whose bytes are read and written by compiled functions.

    ``measure(memory, inbox, outbox)`` asks for a position, waits until memory[UNTIL] at most, writes
    memory[READING] [m; rad] if all went well, and returns what became of it.  ``apply(…)`` gives
    memory[FORCE] [N; N·m, positive towards greater readings] and returns the same; it does not wait.
    Neither may block, allocate or raise.
    """

    measure: ClassVar[Question]
    apply: ClassVar[Question]

    @abstractmethod
    def open(self, sample_period: float) -> Opened:
        """Reach the device, make it ready to give a force, set its own watchdog; force 0.

        Raises
        ------
        InputError
            If there is no such port or device, or it does not answer as it should.
        """


class LibraryConnection(Connection):
    """A device that a library in Python speaks to."""

    @abstractmethod
    def open(self, sample_period: float) -> None:
        """As of a compiled one."""

    @abstractmethod
    def measure(self, until: int) -> tuple[int, float]:
        """(what became of it, position [m; rad])."""

    @abstractmethod
    def apply(self, force: float) -> int:
        """Give a force along the device's axis [N; N·m]; what became of it."""


def reach(connection: Connection, sample_period: float) -> Opened:
    """Open a connection of either kind; what its questions work on."""
    if isinstance(connection, CompiledConnection):
        return connection.open(sample_period)
    cast(LibraryConnection, connection).open(sample_period)
    return blank(0, 1, 1)


def questions(connection: Connection) -> tuple[Question, Question]:
    """`measure` and `apply` as a compiled connection has them, of either kind.

    Of a library an error of the system, such as a cable that is out, is a line that has closed.
    """
    if isinstance(connection, CompiledConnection):
        return type(connection).measure, type(connection).apply
    library = cast(LibraryConnection, connection)

    def measure(memory: Array, inbox: Bytes, outbox: Bytes) -> int:
        try:
            status, memory[READING] = library.measure(int(memory[UNTIL]))
        except OSError:
            status, memory[READING] = CLOSED, nan
        return status

    def apply(memory: Array, inbox: Bytes, outbox: Bytes) -> int:
        try:
            return library.apply(float(memory[FORCE]))
        except OSError:
            return CLOSED

    return measure, apply


def seconds_of(duration: RealLike) -> Exact:
    """How long a loop is to run, > 0 [s]."""
    found: Exact = read_number(
        duration, GLOSSARY["sample_period"], "duration", bound="> 0", why="0 has no sample"
    )
    return found


@dataclass(frozen=True)
class Placement(Parametric):
    """Where on the device's axis the wall is: ``x = sense (reading − origin)``.

    Parameters
    ----------
    origin
        Reading at the wall's surface [m; rad].
    sense
        1 where the wall lies towards greater readings, −1 where towards smaller ones.
    """

    origin: Reads[float, RealLike] = parameter("position", 0, kept=float)
    sense: int = 1

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.sense not in (1, -1):
            raise InputError(
                f"a wall lies towards greater readings, sense 1, or smaller ones, sense -1; got {self.sense}"
            )

    @classmethod
    def read(cls, table: Table, motion: str) -> Placement:
        """From the keys origin and sense of a table."""
        found = {}
        for key, quantity in (("origin", GLOSSARY["position"]), ("sense", plain("sense", "1 or -1"))):
            if key in table.values:
                with located(table.where(key)):
                    number = float(read_number(table.values[key], quantity, key, motion=motion))
                    if key == "sense" and number not in (1, -1):
                        raise InputError(f"sense is 1 or -1, got {number:g}")
                    found[key] = number
        with located(table.label):
            return cls(found.get("origin", 0.0), int(found.get("sense", 1)))


class Axis(Closing):
    """One axis of a device that is reached, at a period T [s], until it is closed; asked from Python.

    Sample by sample positions and forces along the x of a placement, of a compiled connection and of one of a
    library in the same way.  The interpreter's lock is held between the questions: what else runs in Python
    makes the loop later.
    """

    def __init__(
        self, connection: CompiledConnection | LibraryConnection, placement: Placement, sample_period: float
    ) -> None:
        self.connection, self.placement, self.period = connection, placement, sample_period
        self._measure, self._apply = questions(connection)
        self._opened = reach(connection, sample_period)
        self._at_first = self._opened.memory.copy()

    def begin(self) -> None:
        """The next sample is number 0: of a simulated device the script begins anew."""
        if self.connection.samples is not None:
            self._opened.memory[:] = self._at_first

    def measure(self, k: int, until: int, late: float = 0.0) -> tuple[int, float]:
        """(what became of sample k, x [m; rad]), where the loop is `late` [s], less than T.

        Waits until the clock `posix.now` reads `until` at most.
        """
        memory = self._opened.memory
        memory[TIME], memory[INDEX], memory[UNTIL] = k * self.period + late, k, until
        status = self._measure(*self._opened)
        return status, self.placement.sense * (float(memory[READING]) - self.placement.origin)

    def give(self, force: float) -> int:
        """Give a force, positive along x [N; N·m]; what became of it."""
        self._opened.memory[FORCE] = self.placement.sense * force
        return self._apply(*self._opened)

    def let_go(self) -> None:
        """Force 0, said more than once."""
        for _ in range(ZEROS):
            self.give(0.0)

    def close(self) -> None:
        """Force 0, then the device is let go; may be called again."""
        self.connection.close()
