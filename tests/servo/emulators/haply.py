"""A Haply board with its firmware, as its source tells (M3 1.5): at the other end of a pseudo-terminal.

The tip is moved by the test, exchange by exchange; what the board answers are counts of its encoders,
made from the position by inverse kinematics.  The forces that it remembers are what its torques are along an
axis, by differences of the inverse kinematics, F = Σ τᵢ ∂θᵢ/∂x, and so for y.
"""

import math
import struct
from collections.abc import Callable

from servo.emulators.faults import Fault
from servo.emulators.terminal import TerminalEmulator

INNER, OUTER, BASE = 0.07, 0.09, 0.038


def angles_of(x: float, y: float) -> tuple[float, float]:
    """Where the joints stand when the tip is there [degrees]: each elbow on the outer side."""
    return _elbow(x, y, bend=1), _elbow(x - BASE, y, bend=-1)


def _elbow(x: float, y: float, bend: int) -> float:
    reach = math.hypot(x, y)
    inside = math.acos((INNER**2 + reach**2 - OUTER**2) / (2 * INNER * reach))
    return math.degrees(math.atan2(y, x) + bend * inside)


class HaplyEmulator(TerminalEmulator):
    """Joint 1 at port 2, joint 2 at port 1, as on the 2DIY; its tip [m] is where an exchange has it."""

    def __init__(
        self,
        tip: Callable[[int], tuple[float, float]] = lambda exchange: (0.02, 0.1),
        fault: Fault | None = None,
        at: int = 0,
        axis: str = "x",
    ) -> None:
        super().__init__(fault, at)
        self.tip = tip
        self.axis = axis
        self.device = 0
        self.setup: tuple[float, ...] = ()
        self.resets = 0
        self._heard = b""

    def hear(self, data: bytes) -> None:
        """Frames are told apart by their type alone, as in the firmware."""
        self._heard += data
        while self._heard:
            kind = self._heard[0]
            if kind == 0:
                length = 2
            elif kind == 1:
                motors = bin(self._heard[2]).count("1") if len(self._heard) > 2 else 0
                length = 2 + 2 * (1 + motors) + 2 + 8 * motors
            else:
                length = 2 + 4 * self.joints
            if len(self._heard) < length:
                return
            frame, self._heard = self._heard[:length], self._heard[length:]
            (self._reset, self._set_up, self._exchange)[kind](frame)

    @property
    def joints(self) -> int:
        return len(self.setup) // 2

    def _reset(self, frame: bytes) -> None:
        self.resets += 1
        self.device, self.setup = 0, ()

    def _set_up(self, frame: bytes) -> None:
        self.device = frame[1]
        count = bin(frame[2]).count("1")
        self.motors, self.encoders = frame[3 : 3 + count], frame[4 + count : 4 + 2 * count]
        assert frame[2] == frame[3 + count]
        assert frame[4 + 2 * count : 6 + 2 * count] == b"\0\0"
        self.setup = struct.unpack(f"<{2 * count}f", frame[6 + 2 * count :])

    def _exchange(self, frame: bytes) -> None:
        if frame[1] != self.device:
            return
        torques = struct.unpack(f"<{self.joints}f", frame[2:])
        self.command(self._force(torques))
        self.answer(struct.pack(f"<B{self.joints}f", self.device, *self._angles(self.exchange)))

    def _angles(self, exchange: int) -> list[float]:
        first, second = angles_of(*self.tip(exchange))
        by_port = (second, first) if self.joints == 2 else (first,)
        counts = [
            (math.floor(angle * per_turn / 360), per_turn)
            for angle, per_turn in zip(by_port, self.setup[1::2], strict=True)
        ]
        return [360.0 * count / per_turn for count, per_turn in counts]

    def _force(self, torques: tuple[float, ...]) -> float:
        """Along the axis; of one motor its torque."""
        if self.joints == 1:
            return torques[0]
        (x, y), step = self.tip(self.exchange), 1e-6
        dx, dy = (step, 0.0) if self.axis == "x" else (0.0, step)
        ahead, back = angles_of(x + dx, y + dy), angles_of(x - dx, y - dy)
        change = [math.radians(a - b) / (2 * step) for a, b in zip(ahead, back, strict=True)]
        return torques[1] * change[0] + torques[0] * change[1]
