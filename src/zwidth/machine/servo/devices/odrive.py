"""A motor on an ODrive, by its text protocol over USB or a UART (docs.odriverobotics.com, "ASCII Protocol").

A line for each command, ``command*checksum``; the checksum is the exclusive or of the bytes before the
asterisk, and an answer has one if and only if the command has.  ``f 0`` asks for ``position velocity``
[turns, turns/s], ``c 0 torque`` gives a torque [N·m] and feeds the watchdog, ``r name`` and ``w name value``
read and write a property.  What that means for a loop: `odrive_lines`.
"""

from __future__ import annotations

import time
from contextlib import suppress
from functools import reduce
from math import inf, isnan, nan
from operator import xor
from typing import Any, ClassVar

import numpy as np

from zwidth.errors import InputError
from zwidth.machine.servo.connection import (
    LEAVES,
    REFUSES,
    RESTORES,
    TELLS,
    Opened,
    Setting,
)
from zwidth.machine.servo.devices.odrive_lines import (
    CLOSED_LOOP,
    OFF,
    OFF_END,
    ON,
    ON_END,
    POSITION,
    POSITION_END,
    STATE,
    STATE_END,
    TORQUE,
    TORQUE_END,
    TURN,
    ask_position,
    give_torque,
)
from zwidth.machine.servo.devices.serial_port import SerialConnection
from zwidth.quantity.text import shown
from zwidth.quantity.units import in_si

_ANSWER_TIME = 1.0
_START_TIME = 3.0
_LAST_WORD = 0.2
_GIMBAL = 2
_IDLE = 1
_TORQUE_CONTROL, _PASSTHROUGH = 1, 1
_SPEED_LIMITS = (
    "controller.config.enable_torque_mode_vel_limit",
    "controller.config.enable_current_mode_vel_limit",
)
"""From firmware 0.5.3 on, and before."""


class ODrive(SerialConnection):
    """One axis of an ODrive, torque against angle.

    Opening it sets torque control without a filter of the input and without its limit of the speed

        |τ| ≤ (vel_limit ∓ v) vel_gain,

    0.333 N·m at rest as delivered; the watchdog's time, torque 0, and closed loop control.  Closing gives
    torque 0, lets the motor go and puts back what was set before.  The watchdog runs while the torque is not
    0, so that a loop may take its time to begin.  With every 16th torque this is said again, and the state of
    the axis asked for: one that left closed loop control is a fault.

    Parameters
    ----------
    port
        "/dev/ttyACM0" for USB, or a UART's.
    axis
        Number of the axis, 0 or 1.
    baud
        Of a UART [1/s]; USB ignores it.
    watchdog
        Seconds without a torque after which the ODrive lets the motor go by itself.
    """

    motion = "rotary"
    maker = "ODrive firmware 0.5.6, Firmware/MotorControl; that of 0.6 is not published"
    settings: ClassVar[tuple[Setting, ...]] = (
        (_SPEED_LIMITS[0], "1", "size: |τ| ≤ (vel_limit ∓ v)·vel_gain, as delivered (2 turn/s ∓ v)/6 N·m",
         RESTORES, "controller.cpp:137, 387"),
        ("controller.config.control_mode", "3", "what is controlled: 1, the torque", RESTORES,
         "controller.cpp:374"),
        ("controller.config.input_mode", "1", "filters or ramps the torque unless 1", RESTORES,
         "controller.cpp:187"),
        ("config.watchdog_timeout", "0", "end: how long the last torque acts", RESTORES, "axis.hpp:164"),
        ("config.enable_watchdog", "0", "end: whether it ends by itself", RESTORES, "axis.cpp:172"),
        ("requested_state", "0", "8, closed loop control; 1, idle, in the end", RESTORES, "axis.cpp:572"),
        ("config.enable_sensorless_mode", "0", "spins the motor before it takes a torque", REFUSES,
         "axis.cpp:262"),
        ("motor.config.motor_type", "0", "size: of a gimbal motor, 2, a torque is volts", REFUSES,
         "motor.cpp:589"),
        ("motor.config.current_lim", "10 A", "size: |τ| ≤ current_lim·torque_constant", TELLS,
         "motor.cpp:365, 391"),
        ("motor.config.torque_constant", "0.04 N·m/A", "size: the current is τ over it", TELLS,
         "motor.cpp:542"),
        ("motor.config.torque_lim", "∞", "size: |τ| ≤ torque_lim", TELLS, "motor.cpp:392"),
        ("controller.config.vel_limit", "2 turn/s", "end: above tolerance·vel_limit it is dropped", TELLS,
         "controller.cpp:337"),
        ("controller.config.vel_limit_tolerance", "1.2", "end: as above", TELLS, "controller.cpp:337"),
        ("controller.config.enable_overspeed_error", "1", "end: whether it is dropped", TELLS,
         "controller.cpp:332"),
        ("controller.config.spinout_mechanical_power_threshold", "−10 W",
         "end: a motor that takes more than 10 W from the hand and from the supply is let go", LEAVES,
         "controller.cpp:438"),
        ("controller.config.anticogging.anticogging_enabled", "1",
         "size: once calibrated, adds a torque by the angle", LEAVES, "controller.cpp:364"),
        ("encoder.config.direction", "by calibration", "sign, of torque and angle alike", LEAVES,
         "motor.cpp:520"),
        ("min_endstop, max_endstop", "off", "end: pressed, the axis is dropped", LEAVES, "axis.cpp:156"),
        ("fet_thermistor, motor_thermistor", "100 °C", "size: less current from there on", LEAVES,
         "motor.cpp:376"),
    )  # fmt: skip
    taken = 1024
    measure = ask_position
    apply = give_torque

    def __init__(self, port: str, *, axis: int = 0, baud: int = 115200, watchdog: float | str = 0.05) -> None:
        watchdog = in_si(watchdog, "s", "watchdog")
        if axis not in (0, 1):
            raise InputError(f"the axis of an ODrive must be 0 or 1, got {axis!r}")
        if not 0 < watchdog < 10:
            raise InputError(
                f"the watchdog of an ODrive must be > 0 and < 10 s, got {watchdog!r}: it is what ends the "
                "torque when this program or the line does"
            )
        self.port, self.axis, self.baud, self.watchdog = port, axis, baud, watchdog
        self._before: dict[str, str] = {}
        self._limits = ""

    def _check_period(self, sample_period: float) -> None:
        if self.watchdog < 4 * sample_period:
            raise InputError(
                f"watchdog must be {shown(4 * sample_period, 's', 6)} or more, four sample periods, got "
                f"{shown(self.watchdog, 's', 6)}: one lost sample must not end the torque"
            )

    def _end(self, opened: Opened) -> None:
        """Torque 0, idle, the settings that were found."""
        before, self._before = self._before, {}
        if before:  # else what is at the port has not answered as an ODrive
            self._line.write(b"\n" + _line_of(f"c {self.axis} 0"))  # what was cut before ends here
            for name, value in {"requested_state": _IDLE, **before}.items():
                self._write(name, value)
            _ask(self._line, f"r axis{self.axis}.current_state", _LAST_WORD)  # heard, once it answers

    @property
    def on_silence(self) -> str:
        """Its own watchdog."""
        return f"lets the motor go {shown(self.watchdog, 's', 6)} after the last torque that was not 0"

    def describe(self) -> str:
        """Which axis, over what, and what the position is."""
        return (
            f"ODrive axis {self.axis} at {self.port}, torque control{self._limits}; the position is its own "
            "filtered estimate, told in steps of 6.3 µrad; only an emulator of it has been met"
        )

    def _prepare(self, opened: Opened) -> None:
        """What opening sets, each setting read back; the lines that never change, and nothing asked yet."""
        self._line.write(b"\n")  # ends what an earlier program left unfinished
        self._read("current_state")
        self._check_motor()
        settings = {
            self._known(*_SPEED_LIMITS): "0",
            "config.enable_watchdog": "0",
            "config.watchdog_timeout": f"{self.watchdog:g}",
            "controller.config.control_mode": str(_TORQUE_CONTROL),
            "controller.config.input_mode": str(_PASSTHROUGH),
        }
        for name in settings:
            self._before[name] = self._read(name)
        for name, value in settings.items():
            self._write(name, value)
            found = self._read(name)
            if abs(float(found) - float(value)) > 1e-3 * abs(float(value)):
                raise InputError(
                    f"axis{self.axis}.{name} of the ODrive at {self.port} stays {found} when set to {value}"
                )
        self._line.write(_line_of(f"c {self.axis} 0"))
        self._write("requested_state", CLOSED_LOOP)
        self._wait_for_start()
        for start, end, line in (
            (POSITION, POSITION_END, _line_of(f"f {self.axis}")),
            (STATE, STATE_END, _line_of(f"r axis{self.axis}.current_state")),
            (ON, ON_END, _line_of(f"w axis{self.axis}.config.enable_watchdog 1")),
            (OFF, OFF_END, _line_of(f"w axis{self.axis}.config.enable_watchdog 0")),
            (TORQUE, TORQUE_END, f"c {self.axis} ".encode()),
        ):
            opened.memory[end] = start + len(line)
            opened.outbox[start : start + len(line)] = np.frombuffer(line, np.uint8)

    def _check_motor(self) -> None:
        """Refuse what would not be a torque; keep what limits one in words."""
        which = f"axis {self.axis} of the ODrive at {self.port}"
        if self._found("config.enable_sensorless_mode") == 1:
            raise InputError(
                f"{which} is in its sensorless mode, which spins the motor before it takes a torque; set "
                "config.enable_sensorless_mode to 0, with an encoder"
            )
        if self._found("motor.config.motor_type", "config.motor.motor_type") == _GIMBAL:
            raise InputError(
                f"{which} has a gimbal motor, for which a torque is volts, so that no wall is as stiff as "
                "it was proved; take one whose current is controlled, motor_type 0"
            )
        current = self._found("motor.config.current_lim", "config.motor.current_soft_max")
        constant = self._found("motor.config.torque_constant", "config.motor.torque_constant")
        most = min(current * constant, self._found("motor.config.torque_lim", "config.torque_soft_max"))
        limits = "an unknown torque" if isnan(most) else shown(most, "N*m", 3)
        fastest = self._found("controller.config.vel_limit")
        fastest *= self._found("controller.config.vel_limit_tolerance")
        if self._found("controller.config.enable_overspeed_error") == 0:
            fastest = inf
        dropped = "above an unknown speed" if isnan(fastest) else f"above {shown(TURN * fastest, 'rad/s', 3)}"
        self._limits = f", at most {limits}; it lets the motor go {dropped}, whatever it holds"

    def _known(self, *names: str) -> str:
        for name in names[:-1]:
            with suppress(InputError):
                self._read(name)
                return name
        return names[-1]

    def _found(self, *names: str) -> float:
        """The first of these properties that its firmware has; NaN for none."""
        with suppress(InputError):
            return float(self._read(self._known(*names)))
        return nan

    def _wait_for_start(self) -> None:
        """Closed loop control, or the errors that keep the axis from it."""
        until = time.monotonic() + _START_TIME
        while (state := self._read("current_state")) != str(CLOSED_LOOP):
            if time.monotonic() > until:
                raise InputError(
                    f"axis {self.axis} of the ODrive at {self.port} does not go into closed loop control "
                    f"(its state is {state}; {self._errors()}); calibrate it, clear its errors, and try again"
                )

    def _errors(self) -> str:
        """What firmware 0.5 calls error, and 0.6 active_errors and disarm_reason."""
        found = {}
        for name in ("error", "active_errors", "disarm_reason"):
            with suppress(InputError):
                found[name] = self._read(name)
        return ", ".join(f"{name} {value}" for name, value in found.items()) or "it tells of no errors"

    def _read(self, name: str) -> str:
        """A property of the axis that is a number."""
        answer = _ask(self._line, f"r axis{self.axis}.{name}", _ANSWER_TIME)
        if answer is None:
            raise InputError(
                f"no ODrive answers at {self.port}; is it the right port, and is its text protocol turned on "
                "there?"
            )
        try:
            float(answer)
        except ValueError:
            raise InputError(
                f"the ODrive at {self.port} has no axis{self.axis}.{name}: it said {answer!r}; firmware from "
                "0.5.1 on is spoken here"
            ) from None
        return answer

    def _write(self, name: str, value: object) -> None:
        self._line.write(_line_of(f"w axis{self.axis}.{name} {value}"))


def _line_of(command: str) -> bytes:
    """A command with its checksum."""
    return f"{command}*{reduce(xor, command.encode())}\n".encode()


def _ask(serial: Any, command: str, seconds: float) -> str | None:
    """The answer to a question; lines without a right checksum are answers to what others asked."""
    serial.write(_line_of(command))
    data, until = b"", time.monotonic() + seconds
    while True:
        over = time.monotonic() >= until  # the last look is after the time
        part = serial.read(256)
        *lines, data = (data + part).split(b"\n")
        for line in lines:
            text, asterisk, checksum = line.strip().partition(b"*")
            if asterisk and checksum.isdigit() and text and int(checksum) == reduce(xor, text):
                return text.decode(errors="replace")
        if over:
            return None
        if not part:
            time.sleep(1e-3)
