"""A Dynamixel of the X series on a bus, written from the e-Manual: control table, packets, odd habits.

Its positions are those of its shaft, its commands the currents that turn the shaft: what the Drive Mode makes
of both is for the host to find out.
"""

import struct

from servo.emulators.faults import Fault
from servo.emulators.terminal import TerminalEmulator

HEADER = b"\xff\xff\xfd\x00"
_TORQUE, _WATCHDOG, _GOAL, _LIMIT, _MODE, _DRIVE, _RETURN_LEVEL = 64, 98, 102, 38, 11, 10, 68
_X540 = (1110, 1120)
"""Models whose currents Reverse inverts as well: the e-Manual, "Drive Mode"."""
_OTHER_VALUES, _REFUSED = 0x04, 0x07
"""Of an answer: "Data Range Error", "Access Error"."""


def remainder(packet: bytes) -> bytes:
    """CRC-16 of polynomial 8005 hex: the rest of a long division of the packet as one number."""
    rest = int.from_bytes(packet, "big") << 16
    for bit in range(rest.bit_length() - 1, 15, -1):
        if rest >> bit & 1:
            rest ^= 0x18005 << (bit - 16)
    return struct.pack("<H", rest)


def packet(identifier: int, body: bytes) -> bytes:
    """Instruction and parameters with what stands around them."""
    stuffed = body.replace(b"\xff\xff\xfd", b"\xff\xff\xfd\xfd")
    whole = HEADER + bytes([identifier]) + struct.pack("<H", len(stuffed) + 2) + stuffed
    return whole + remainder(whole)


class DynamixelEmulator(TerminalEmulator):
    """Its position is scripted: counts at each exchange, of which the last one stays.

    `packet` frames what it says, and what it obeys is framed just so.
    """

    packet = staticmethod(packet)

    def __init__(
        self,
        positions: list[int],
        fault: Fault | None = None,
        at: int = 0,
        *,
        model: int = 1020,
        firmware: int = 45,
        indirect_data: int = 224,
        identifier: int = 1,
    ) -> None:
        super().__init__(fault, at)
        self.positions = positions
        self.identifier = identifier
        self.indirect_data = indirect_data
        self.table = bytearray(700)
        self.alert = False
        self.touched: set[int] = set()
        self._heard = b""
        self._room = 28 if indirect_data == 224 else 20
        self.put(0, 2, model)
        self.put(6, 1, firmware)
        self.put(9, 1, 250)
        self.put(_MODE, 1, 3)
        self.put(_LIMIT, 2, 1193)
        self.put(36, 2, 885)
        self.put(_RETURN_LEVEL, 1, 2)
        self.put(100, 2, 885)
        for i in range(self._room):
            self.put(168 + 2 * i, 2, indirect_data + i)

    def put(self, address: int, count: int, value: int) -> None:
        self.table[address : address + count] = (value & (1 << 8 * count) - 1).to_bytes(count, "little")

    def value(self, address: int, count: int) -> int:
        return int.from_bytes(self.table[address : address + count], "little")

    def hear(self, data: bytes) -> None:
        self._heard += data
        while True:
            start = self._heard.find(HEADER)
            if start < 0 or len(self._heard) < start + 7:
                return
            size = 7 + struct.unpack_from("<H", self._heard, start + 5)[0]
            if len(self._heard) < start + size:
                return
            whole = self._heard[start : start + size]
            self._heard = self._heard[start + size :]
            body = whole[7:-2].replace(b"\xff\xff\xfd\xfd", b"\xff\xff\xfd")
            if self.packet(whole[4], body) == whole:
                self._obey(whole[4], body[0], body[1:])

    def with_wrong_checksum(self, frame: bytes) -> bytes:
        return frame[:-2] + bytes([frame[-2] ^ 1, frame[-1]])

    def _obey(self, identifier: int, instruction: int, parameters: bytes) -> None:
        if instruction == 0x83 and identifier == 0xFE:
            address, count = struct.unpack_from("<HH", parameters)
            for at in range(4, len(parameters), 1 + count):
                if parameters[at] == self.identifier:
                    self._write(address, parameters[at + 1 : at + 1 + count])
        elif instruction == 0x82 and identifier == 0xFE and self.identifier in parameters[4:]:
            self._read(*struct.unpack_from("<HH", parameters))
        elif instruction == 0x01 and identifier in (self.identifier, 0xFE):
            self.write(self._status(0, bytes(self.table[:2]) + bytes([self.table[6]])))
        elif instruction == 0x02 and identifier == self.identifier:
            self._read(*struct.unpack("<HH", parameters))
        elif instruction == 0x03 and identifier in (self.identifier, 0xFE):
            error = self._write(struct.unpack_from("<H", parameters)[0], parameters[2:])
            if identifier != 0xFE and self.table[_RETURN_LEVEL] == 2:
                self.write(self._status(error))

    def _status(self, error: int, parameters: bytes = b"") -> bytes:
        return self.packet(self.identifier, bytes([0x55, error | (0x80 if self.alert else 0)]) + parameters)

    def _write(self, address: int, data: bytes) -> int:
        """What is wrong with it, as an answer says it; 0."""
        self.touched.add(address)
        value = int.from_bytes(data, "little", signed=True)
        torque, limit = self.table[_TORQUE], self.value(_LIMIT, 2)
        if address < 64 and torque:
            return _REFUSED
        if address == _GOAL and (self.table[_WATCHDOG] == 0xFF or abs(value) > limit):
            return _OTHER_VALUES
        if address == _MODE and value != self.table[_MODE]:
            self.put(_GOAL, 2, limit)  # what a change of the operating mode does
        self.put(address, len(data), value)
        if address == _GOAL and self.table[_DRIVE] & 8:
            self.table[_TORQUE] = 1
        if address in (_GOAL, _TORQUE) and self.table[_TORQUE] and self.table[_MODE] == 0:
            current = int.from_bytes(self.table[_GOAL : _GOAL + 2], "little", signed=True)
            turned = self.table[_DRIVE] & 1 and self.value(0, 2) in _X540
            self.command(0 if self.table[_DRIVE] & 2 else (-current if turned else current))
        return 0

    def _read(self, address: int, count: int) -> None:
        if self.table[_RETURN_LEVEL] == 0:
            return
        self.touched.add(address)
        counted = address == self.indirect_data and count >= 6
        index = min(self.exchange, len(self.positions) - 1)
        self.put(132, 4, -self.positions[index] if self.table[_DRIVE] & 1 else self.positions[index])
        values = bytes(self.table[self._behind(i)] for i in range(address, address + count))
        frame = self._status(0, values)
        (self.answer if counted else self.write)(frame)

    def _behind(self, address: int) -> int:
        """Where a register of indirect data leads to."""
        i = address - self.indirect_data
        return self.value(168 + 2 * i, 2) if 0 <= i < self._room else address
