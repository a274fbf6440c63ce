"""A Hapkit with its sketch, written from docs/devices/hapkit.md: at the other end of a pseudo-terminal."""

import binascii
import struct
from collections.abc import Callable

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
