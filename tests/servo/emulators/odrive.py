"""An ODrive's text protocol as documentation and firmware have it, one axis on a hand that is a spring.

Written from docs.odriverobotics.com ("ASCII Protocol") and the behaviour of firmware 0.5.6, whose settings as
delivered it has.
"""

from functools import reduce
from math import tau
from operator import xor

from servo.emulators.faults import Fault, Handle
from servo.emulators.terminal import TerminalEmulator


class ODriveEmulator(TerminalEmulator):
    """Its properties are those of axis 0 that matter here; `torques` gave its motor at every position asked.

    A fault is one of all answers, those to other questions as well; one that does not start stays idle.
    """

    def __init__(self, fault: Fault | None = None, at: int = 0, *, starts: bool = True) -> None:
        super().__init__(fault, at)
        self.handle = Handle(mass=1e-4, stiffness=0.05, damping=4e-4, hand=1.5, position=1.1)
        self.positions: list[float] = []
        self.torques: list[float] = []
        self.lines: list[str] = []
        self.watchdog_on: list[bool] = []
        self.disarm_at: int | None = None
        self.lose_states = 0
        self.frozen: set[str] = set()
        self.properties = {
            "axis0.current_state": "1",
            "axis0.requested_state": "0",
            "axis0.error": "0",
            "axis0.config.enable_watchdog": "0",
            "axis0.config.watchdog_timeout": "0.000000",
            "axis0.config.enable_sensorless_mode": "0",
            "axis0.controller.config.control_mode": "3",
            "axis0.controller.config.input_mode": "5",
            "axis0.controller.config.enable_torque_mode_vel_limit": "1",
            "axis0.controller.config.enable_overspeed_error": "1",
            "axis0.controller.config.vel_limit": "2.000000",
            "axis0.controller.config.vel_limit_tolerance": "1.200000",
            "axis0.controller.config.vel_gain": "0.166667",
            "axis0.motor.config.motor_type": "0",
            "axis0.motor.config.current_lim": "10.000000",
            "axis0.motor.config.torque_constant": "0.040000",
            "axis0.motor.config.torque_lim": "inf",
        }
        self._starts = starts
        self._data = b""

    def hear(self, data: bytes) -> None:
        *lines, self._data = (self._data + data).split(b"\n")
        for line in lines:
            self._command(line.decode())

    def with_wrong_checksum(self, frame: bytes) -> bytes:
        text, asterisk, checksum = frame.strip().partition(b"*")
        return text + b"*" + str((int(checksum) + 1) % 256).encode() + b"\r\n" if asterisk else frame

    def _command(self, line: str) -> None:
        text, asterisk, checksum = line.partition("*")
        if asterisk and int(checksum) != reduce(xor, text.encode()):
            return
        self.lines.append(text)
        answer = self._answer(text.split())
        if answer is None:
            return
        if asterisk:
            answer += f"*{reduce(xor, answer.encode())}"
        frame = f"{answer}\r\n".encode()
        if text.startswith("f"):
            self.answer(frame)
        elif self.exchange > 0 and self.lose_states > 0 and text.endswith("current_state"):
            self.lose_states -= 1
        else:
            self.disturb(frame)

    def _answer(self, words: list[str]) -> str | None:
        match words:
            case ["c", "0", torque]:
                self.command(float(torque))
                self.watchdog_on.append(self.properties["axis0.config.enable_watchdog"] == "1")
                return None
            case ["f", "0"]:
                return self._feedback()
            case ["r", name]:
                return self.properties[name][:9] if name in self.properties else "invalid property"
            case ["w", name, value] if name in self.properties:
                return self._set(name, value)
            case ["w", _, _]:
                return "invalid property"
            case ["f", motor] | ["c", motor, _]:
                return f"invalid motor {motor}"
            case ["r" | "f" | "c", *_]:
                return "invalid command format"
            case _:
                return "unknown command"

    def _feedback(self) -> str:
        if self.exchange == self.disarm_at:
            self.properties["axis0.current_state"] = "1"
        self.torques.append(self._torque())
        self.handle.step(self.torques[-1])
        turns = f"{self.handle.position / tau:f}"
        self.positions.append(float(turns) * tau)
        return f"{turns} {self.handle.speed / tau:f}"

    def _torque(self) -> float:
        """Firmware 0.5.6, MotorControl/controller.cpp lines 137 to 141, 332 to 341 and 387 to 405."""
        if self.properties["axis0.current_state"] != "8":
            return 0.0
        speed, torque = self.handle.speed / tau, self.commands[-1].force  # [turn/s]
        limit = self._number("controller.config.vel_limit")
        fastest = limit * self._number("controller.config.vel_limit_tolerance")
        if self._number("controller.config.enable_overspeed_error") and abs(speed) > fastest:
            self.properties["axis0.current_state"], self.properties["axis0.error"] = "1", "512"
            return 0.0
        if self.properties.get("axis0.controller.config.enable_torque_mode_vel_limit") == "1":
            gain = self._number("controller.config.vel_gain")
            torque = min(max(torque, (-limit - speed) * gain), (limit - speed) * gain)
        most = float(self.properties.get("axis0.motor.config.current_lim", "inf"))
        most *= self._number("motor.config.torque_constant")
        most = min(most, self._number("motor.config.torque_lim"))
        return min(max(torque, -most), most)

    def _number(self, name: str) -> float:
        return float(self.properties[f"axis0.{name}"])

    def _set(self, name: str, value: str) -> str | None:
        try:
            value = str(int(value)) if self.properties[name].isdigit() else f"{float(value):f}"
        except ValueError:
            return "not implemented"
        if name not in self.frozen:
            self.properties[name] = value
        if name == "axis0.requested_state" and (value != "8" or self._starts):
            self.properties["axis0.current_state"] = value
        return None
