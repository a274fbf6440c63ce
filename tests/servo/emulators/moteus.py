"""A moteus controller behind an adapter that speaks fdcanusb's lines, written from mjbots' documentation.

What it does after its watchdog is the rule of mjbots/moteus db1a7623, fw/bldc_servo_control.h, lines 1137 to
1152 and 1451 to 1477; when it wants checksums, that of fw/uart_fdcanusb_micro_server.h, lines 223 to 270.
"""

import math
import struct

from servo.emulators.faults import Fault
from servo.emulators.terminal import TerminalEmulator

_TYPES = "bhif"
_SPECIAL = {"b": -(2**7), "h": -(2**15), "i": -(2**31)}
_TIME = {"b": 1e-2, "h": 1e-3, "i": 1e-6, "f": 1.0}


def checksum(line: bytes) -> int:
    """CRC-8 of polynomial 97 hex: the rest of a long division of the line as one number."""
    rest = int.from_bytes(line, "big") << 8
    for bit in range(rest.bit_length() - 1, 7, -1):
        if rest >> bit & 1:
            rest ^= 0x197 << (bit - 8)
    return rest


class MoteusEmulator(TerminalEmulator):
    """Operates one answer after it was told to; its positions [turn] are scripted, the last one stays.

    With `checksums` it has heard a line with one, and wants them from now on; its configuration is what
    "conf get" tells, as delivered.
    """

    def __init__(
        self,
        positions: list[float],
        fault: Fault | None = None,
        at: int = 0,
        *,
        identifier: int = 1,
        checksums: bool = False,
    ) -> None:
        super().__init__(fault, at)
        self.positions = positions
        self.identifier = identifier
        self.checksums = checksums
        self.mode = 11
        self.fault_code = 0
        self.bus_is_off = False
        self.complaints: list[str] = []
        self.watchdogs: list[float] = []
        self.configuration = {
            "servo.timeout_mode": 12.0,
            "servo.timeout_max_torque_Nm": 5.0,
            "servo.pid_position.kd": 0.05,
            "servo.fixed_voltage_mode": 0.0,
            "servo.voltage_mode_control": 0.0,
            "servo.max_current_A": 100.0,
            "servo.inertia_feedforward": 0.0,
            "motor.cogging_dq_scale": 0.0,
        }
        self.asked_for: set[str] = set()
        self._scale = math.nan
        self._stream = b""
        self._heard = b""

    def torque(self, speed: float) -> float:
        """Of the motor at a speed [turn/s], when it operates as when its watchdog has run out."""
        way = self.configuration["servo.timeout_mode"] if self.mode == 11 else self.mode
        damping = -self.configuration["servo.pid_position.kd"] * speed  # of its own law, scale 1
        if way == 12:
            most = self.configuration["servo.timeout_max_torque_Nm"]
            return min(max(self._scale * damping, -most), most)
        if way == 10:
            return damping if self.mode == 11 else self.commands[-1].force + self._scale * damping
        return -0.2 * speed if way == 15 else 0.0  # the short-circuited motor's own constant is for itself

    def hear(self, data: bytes) -> None:
        *lines, self._heard = (self._heard + data).split(b"\n")
        for line in lines:
            self._obey(line)

    def with_wrong_checksum(self, frame: bytes) -> bytes:
        body, _, digits = frame.rstrip(b"\r\n").rpartition(b"*")
        return body + b"*%02X\r\n" % (int(digits, 16) ^ 1)

    def nonsense(self, count: int) -> bytes:
        return super().nonsense(count - 1).replace(b"\n", b" ").replace(b"\r", b" ") + b"\n"

    def line(self, text: bytes) -> bytes:
        return text + (b" *%02X" % checksum(text + b" ") if self.checksums else b"") + b"\r\n"

    def _obey(self, line: bytes) -> None:
        body, star, digits = line.rpartition(b"*")
        if star:
            right = int(digits, 16) == checksum(body)
            self.checksums, line = self.checksums or right, body.rstrip()
        if not (right if star else not self.checksums):
            self.write(self.line(b"ERR checksum"))
            return
        words = line.split()
        if words[:2] != [b"can", b"send"] or self.bus_is_off:
            self.write(self.line(b"ERR unknown command"))
            return
        address, data = int(words[2], 16), bytes.fromhex(words[3].decode())
        self.write(self.line(b"OK"))
        if len(data) not in (*range(9), 12, 16, 20, 24, 32, 48, 64):
            self.complaints.append(f"a CAN FD frame cannot have {len(data)} bytes")
        if address & 0x7F != self.identifier:
            return
        answer = self._registers(data)
        if address & 0x8000:
            to = self.identifier << 8 | (address >> 8 & 0x7F)
            give = self.write if answer[:1] == b"\x41" else self.answer
            give(self.line(b"rcv %x %s E B F" % (to, answer.hex().encode())))

    def _registers(self, data: bytes) -> bytes:
        answer = b""
        written: dict[int, tuple[str, float]] = {}
        at = 0
        while at < len(data):
            what, kind, count = data[at] & 0xF0, _TYPES[data[at] >> 2 & 3], data[at] & 3
            at += 1
            if data[at - 1] == 0x50:
                continue
            if what == 0x40:
                answer += self._told(data[at - 1], data[at + 1], data[at + 2 :])
                at += 2 + (data[at + 1] if data[at - 1] == 0x40 else 0)
                continue
            if count == 0:
                count, at = data[at], at + 1
            first, at = data[at], at + 1
            if what == 0x00:
                size = struct.calcsize(kind)
                for i in range(count):
                    written[first + i] = (kind, struct.unpack_from(f"<{kind}", data, at)[0])
                    at += size
            else:
                values = [self._value(first + i) for i in range(count)]
                answer += bytes([0x20 | _TYPES.index(kind) << 2 | count, first])
                answer += struct.pack(f"<{count}{kind}", *values)
        if 0x000 in written:
            self._command({register: self._meaning(*value) for register, value in written.items()}, written)
        return answer

    def _told(self, what: int, count: int, data: bytes) -> bytes:
        """The stream of text: 40 hex tells it something, 42 asks for what it says."""
        if what == 0x42:
            part, self._stream = self._stream[:count], self._stream[count:]
            return bytes([0x41, 1, len(part)]) + part
        _, _, name = data[:count].decode().strip().split()
        self.asked_for.add(name)
        known = self.configuration.get(name)
        self._stream += b"ERR error reading\r\n" if known is None else b"%.6f\r\n" % known
        return b""

    def _meaning(self, kind: str, value: float) -> float:
        return math.nan if value == _SPECIAL.get(kind) else value

    def _command(self, values: dict[int, float], written: dict[int, tuple[str, float]]) -> None:
        if values[0x000] == 0:
            self.mode, self.fault_code = 0, 0
            return
        if self.mode == 0:
            self.mode = 2
        if values[0x000] != 10 or not math.isnan(values[0x020]):
            self.complaints.append("no torque mode")
        if any(values.get(register, 1.0) != 0.0 for register in (0x021, 0x023, 0x024, 0x02B)):
            self.complaints.append("a loop inside is not off")
        self._scale = values[0x024]
        kind, _ = written[0x027]
        self.watchdogs.append(values[0x027] * _TIME[kind])
        self.command(values[0x022])

    def _value(self, register: int) -> float:
        if register == 0x000:
            mode = self.mode
            self.mode = 10 if mode == 2 else mode
            return mode
        if register == 0x001:
            return self.positions[min(self.exchange, len(self.positions) - 1)]
        return self.fault_code
