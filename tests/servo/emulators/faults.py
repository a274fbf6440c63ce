"""What the other side of a connection can do wrong, the same for every emulated device; and what it moves.

An emulator counts the positions that it is asked for: the first is exchange 0.  Up to exchange `at` it
answers as it should; from there on its fault decides what becomes of every answer.
"""

from abc import ABC, abstractmethod
from dataclasses import dataclass
from enum import StrEnum
from random import Random


class Fault(StrEnum):
    """From the exchange `at` on, at every exchange."""

    CLOSED = "closed"  # the other side closes the line instead of answering
    HALF_FRAME = "half frame"  # the first half of the answer comes, and no more
    GARBAGE = "garbage"  # as many bytes as the answer has come, and mean nothing
    SILENCE = "silence"  # nothing comes
    DUPLICATE = "duplicate"  # the answer comes twice, in one piece: no later sample may be old by it
    SLOW = "slow"  # the answer comes a few bytes at a time, in time: no fault to the loop
    WRONG_CHECKSUM = "wrong checksum"  # the answer comes whole, and its checksum is that of another
    LATE_ANSWERS = "late answers"  # to each question comes the answer to the one before, to the first nothing


@dataclass(frozen=True)
class Command:
    """A force [N; N·m] that the emulator was told to give, after so many positions were asked for."""

    exchange: int
    force: float


class Emulator(ABC):
    """The other side of a line; it calls `answer` for every position asked, `command` for every force.

    It has the fault from the exchange `at` on, up to that of `until` or for ever.
    """

    def __init__(self, fault: Fault | None = None, at: int = 0) -> None:
        self.fault = fault
        self.at = at
        self.until: int | None = None
        self.exchange = 0
        self.commands: list[Command] = []
        self._held = b""
        self._random = Random(7)

    @abstractmethod
    def write(self, data: bytes) -> None:
        """Put bytes on the line at once."""

    @abstractmethod
    def hang_up(self) -> None:
        """Close it."""

    def with_wrong_checksum(self, frame: bytes) -> bytes:
        """The same frame with the checksum of another one."""
        raise NotImplementedError(f"the frames of {type(self).__name__} have no checksum")

    def nonsense(self, count: int) -> bytes:
        return self._random.randbytes(count)

    def pieces(self, frame: bytes) -> list[bytes]:
        third = max(1, len(frame) // 3)
        return [frame[:third], frame[third : 2 * third], frame[2 * third :]]

    def command(self, force: float) -> None:
        self.commands.append(Command(self.exchange, force))

    def answer(self, frame: bytes) -> None:
        """Answer the exchange with a right frame, or with what the fault makes of it; count it."""
        self.disturb(frame)
        self.exchange += 1

    def disturb(self, frame: bytes) -> None:
        """Send a right frame, or what the fault makes of it at this exchange, which is not counted."""
        over = self.exchange < self.at or (self.until is not None and self.exchange >= self.until)
        match None if over else self.fault:
            case None:
                self.write(self._held + frame)
                self._held = b""
            case Fault.CLOSED:
                self.hang_up()
            case Fault.HALF_FRAME:
                self.write(frame[: len(frame) // 2])
            case Fault.GARBAGE:
                self.write(self.nonsense(len(frame)))
            case Fault.SILENCE:
                pass
            case Fault.DUPLICATE:
                self.write(frame + frame)
            case Fault.SLOW:
                for piece in self.pieces(frame):
                    self.write(piece)
            case Fault.WRONG_CHECKSUM:
                self.write(self.with_wrong_checksum(frame))
            case Fault.LATE_ANSWERS:
                if self._held:
                    self.write(self._held)
                self._held = frame


@dataclass
class Handle:
    """``m a = f + k (h − x) − b v``, one semi-implicit step of Euler for each command; all in SI units.

    The same numbers serve a handle that turns: kg m², N·m/rad, N·m·s/rad, rad.
    """

    mass: float = 0.1
    hand: float = 0.02
    stiffness: float = 80.0
    damping: float = 0.6
    step_length: float = 1e-3
    position: float = 0.0137
    speed: float = 0.0

    def step(self, force: float) -> None:
        pull = self.stiffness * (self.hand - self.position) - self.damping * self.speed
        self.speed += self.step_length * (force + pull) / self.mass
        self.position += self.step_length * self.speed
