"""A Feetech servo of the STS series on a bus, written from its memory table and protocol manual."""

from servo.emulators.faults import Fault
from servo.emulators.terminal import TerminalEmulator

_RETURN_LEVEL, _MODE, _TORQUE, _DUTY, _LOCK, _POSITION = 8, 33, 40, 44, 55, 56


def packet(identifier: int, body: bytes) -> bytes:
    inner = bytes([identifier, len(body) + 1]) + body
    return b"\xff\xff" + inner + bytes([255 - sum(inner) % 256])


class FeetechEmulator(TerminalEmulator):
    """Its position is scripted; what is written where it stays after switching off is kept in `saved`.

    `packet` frames what it says, and what it obeys is framed just so.
    """

    packet = staticmethod(packet)

    def __init__(
        self, positions: list[int], fault: Fault | None = None, at: int = 0, *, identifier: int = 1
    ) -> None:
        super().__init__(fault, at)
        self.positions = positions
        self.identifier = identifier
        self.state = 0
        self.table = bytearray(90)
        self.table[:5] = bytes([3, 10, 0]) + (777).to_bytes(2, "little")  # firmware; an STS3215
        self.table[7], self.table[_RETURN_LEVEL], self.table[30], self.table[_TORQUE] = 250, 1, 1, 1
        self.table[48:50] = (1000).to_bytes(2, "little")
        self.saved: list[int] = []
        self.touched: set[int] = set()
        self._heard = b""

    def hear(self, data: bytes) -> None:
        self._heard += data
        while True:
            start = self._heard.find(b"\xff\xff")
            if start < 0 or len(self._heard) < start + 4:
                return
            size = 4 + self._heard[start + 3]
            if len(self._heard) < start + size:
                return
            whole = self._heard[start : start + size]
            self._heard = self._heard[start + size :]
            if self.packet(whole[2], whole[4:-1]) == whole:
                self._obey(whole[2], whole[4], whole[5:-1])

    def with_wrong_checksum(self, frame: bytes) -> bytes:
        return frame[:-1] + bytes([frame[-1] ^ 1])

    def _obey(self, identifier: int, instruction: int, parameters: bytes) -> None:
        if instruction == 0x83 and identifier == 0xFE:
            address, count = parameters[:2]
            for at in range(2, len(parameters), 1 + count):
                if parameters[at] == self.identifier:
                    self._write(address, parameters[at + 1 : at + 1 + count])
        elif instruction == 0x82 and identifier == 0xFE and self.identifier in parameters[2:]:
            self._read(*parameters[:2])
        elif instruction == 0x02 and identifier == self.identifier:
            self._read(*parameters)
        elif instruction in (0x01, 0x03) and identifier in (self.identifier, 0xFE):
            if instruction == 0x03:
                self._write(parameters[0], parameters[1:])
            if instruction == 0x01 or (identifier != 0xFE and self.table[_RETURN_LEVEL]):
                self.write(self.packet(self.identifier, bytes([self.state])))

    def _write(self, address: int, data: bytes) -> None:
        self.touched.add(address)
        self.table[address : address + len(data)] = data
        if address < _TORQUE and not self.table[_LOCK]:
            self.saved.append(address)
        if address in (_DUTY, _TORQUE) and self.table[_TORQUE] and self.table[_MODE] == 2:
            word = int.from_bytes(self.table[_DUTY : _DUTY + 2], "little")
            self.command((-1 if word & 1024 else 1) * (word % 1024) / 1000)

    def _read(self, address: int, count: int) -> None:
        self.touched.add(address)
        position = self.positions[min(self.exchange, len(self.positions) - 1)]
        word = abs(position) | (0x8000 if position < 0 else 0)
        self.table[_POSITION : _POSITION + 2] = word.to_bytes(2, "little")
        said = bytes([self.state]) + bytes(self.table[address : address + count])
        (self.answer if address == _POSITION else self.write)(self.packet(self.identifier, said))
