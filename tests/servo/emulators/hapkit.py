"""A Hapkit with its sketch, written from the frames at the head of the sketch; and that sketch itself."""

import binascii
import ctypes
import shutil
import struct
import subprocess
from collections.abc import Callable
from pathlib import Path

from servo.emulators.faults import Fault
from servo.emulators.terminal import TerminalEmulator


class HapkitEmulator(TerminalEmulator):
    """Counts at an exchange, since the start, are what the test says; forces are remembered in newtons."""

    def __init__(
        self,
        counts: Callable[[int], int] = lambda exchange: exchange,
        fault: Fault | None = None,
        at: int = 0,
    ) -> None:
        super().__init__(fault, at)
        self.counts = counts
        self.cut_at: int | None = None
        self.starts = 0
        self.wrong = 0
        self._heard = b""

    def hear(self, data: bytes) -> None:
        """Frames of seven bytes; of a wrong one the first byte is passed over."""
        self._heard += data
        while (begin := self._heard.find(b"\xa5")) >= 0 and len(self._heard) >= begin + 7:
            frame = self._heard[begin : begin + 7]
            if struct.pack("<H", binascii.crc_hqx(frame[:5], 0xFFFF)) != frame[5:]:
                self.wrong += 1
                self._heard = self._heard[begin + 1 :]
                continue
            self._heard = self._heard[begin + 7 :]
            self._obey(*struct.unpack("<BBh", frame[1:5]))

    def _obey(self, kind: int, number: int, force: int) -> None:
        if kind == 3:
            self.command(force / 1000)
            return
        if kind == 1:
            self.starts += 1
        cut = self.cut_at is not None and self.exchange >= self.cut_at
        self.answer(self._signed(struct.pack("<BBBi", 0x5A, number, cut, self.counts(self.exchange))))

    def _signed(self, frame: bytes) -> bytes:
        return frame + struct.pack("<H", binascii.crc_hqx(frame, 0xFFFF))

    def with_wrong_checksum(self, frame: bytes) -> bytes:
        """Of a position one count away."""
        other = bytearray(frame)
        other[3] ^= 1
        return bytes(other)


ARDUINO = Path(__file__).parent / "arduino"
SKETCH = Path(__file__).parents[3] / "examples" / "hapkit" / "hapkit.ino"
COMPILER = shutil.which("c++") or shutil.which("g++")

PWM, DIRECTION = 5, 8


def compiled(folder: Path) -> Path:
    library = folder / "hapkit.so"
    command = [str(COMPILER), "-std=c++11", "-Wall", "-Wextra", "-Werror", "-O1", "-shared", "-fPIC"]
    files = ["-I", str(ARDUINO), "-x", "c++", str(SKETCH), str(ARDUINO / "board.cpp")]
    subprocess.run([*command, *files, "-o", str(library)], check=True)
    return library


class Sketch:
    """A board just switched on; only one lives in a process at a time."""

    def __init__(self, library: Path, reading: int = 500) -> None:
        copy = library.with_name(f"{library.stem}-{len(list(library.parent.iterdir()))}.so")
        shutil.copy(library, copy)  # loaded anew: its variables are as at the start
        self.board = ctypes.CDLL(str(copy))
        self.board.board_sensor(reading)
        self.board.board_begin()
        self._into = (ctypes.c_uint8 * 256)()

    def turn(self, ticks: int = 10) -> None:
        """Once through the loop, so many ticks of 4 µs later."""
        self.board.board_turn(ticks)

    def sense(self, reading: int) -> None:
        self.board.board_sensor(reading)

    def hear(self, data: bytes) -> None:
        for byte in data:
            self.board.board_hear(byte)

    def told(self) -> bytes:
        return bytes(self._into[: self.board.board_tell(self._into)])

    @property
    def motor(self) -> tuple[int, int]:
        """Pulse width, 0 … 255, and level of the direction pin."""
        return self.board.board_width(PWM), self.board.board_level(DIRECTION)


class SketchEmulator(TerminalEmulator):
    """The sketch at the other end of a line; for each position asked the sensor reads what the test says."""

    def __init__(
        self, sketch: Sketch, reading: Callable[[int], int], fault: Fault | None = None, at: int = 0
    ) -> None:
        super().__init__(fault, at)
        self.sketch = sketch
        self.reading = reading

    def hear(self, data: bytes) -> None:
        """One turn of its loop sees the sensor, the next one the bytes."""
        self.sketch.sense(self.reading(self.exchange))
        self.sketch.turn()
        for byte in data:
            self.sketch.hear(bytes((byte,)))
            self.sketch.turn(0)
            if answer := self.sketch.told():
                self.answer(answer)
                self.sketch.sense(self.reading(self.exchange))
                self.sketch.turn()
        width, level = self.sketch.motor
        self.command(float(width if level else -width))
