"""A motor on an ODrive, by its text protocol over USB or a UART (docs.odriverobotics.com, "ASCII Protocol").

A line for each command, ``command*checksum``; the checksum is the exclusive or of the bytes before the
asterisk, and an answer has one if and only if the command has.  ``f 0`` asks for ``position velocity``
[turns, turns/s], ``c 0 torque`` gives a torque [N·m] and feeds the watchdog, ``r name`` and ``w name value``
read and write a property.  Answers have no number of their own, and an ODrive still busy with one answer
drops the next: so there is one question at a time, and behind one that was not answered another of a
different kind is asked first, whose answer separates the old from the new.
"""

from __future__ import annotations

import time
from contextlib import suppress
from functools import reduce
from math import inf, isnan, nan, pi
from operator import xor
from typing import Any, ClassVar

import numpy as np

from zwidth.errors import InputError
from zwidth.machine.servo.connection import (
    CLOSED,
    DESCRIPTOR,
    FORCE,
    GARBLED,
    GOOD,
    LEAVES,
    OWN,
    READING,
    REFUSED,
    REFUSES,
    RESTORES,
    SILENT,
    STALE,
    TELLS,
    UNTIL,
    CompiledConnection,
    Opened,
    Setting,
    blank,
    exchanged,
)
from zwidth.machine.servo.devices.json_text import read_decimal, write_decimal
from zwidth.machine.servo.devices.serial_port import open_port
from zwidth.machine.servo.posix import Bytes, now, pause, read_some, write_all
from zwidth.native.compiled import Array, compiled

# What the connection remembers: bytes in the inbox; the position of the newest answer [rad]; whether a
# position, and whether the state, was asked for and not answered; whether the last measurement failed; in
# this one the answers to earlier questions, and the lines that were none; how many torques were given;
# whether the watchdog runs; where the lines in the outbox end.
HAVE, SEEN, POSITION_ASKED, STATE_ASKED, FAILED, OLD, BAD, COUNT, WATCHED = range(OWN, OWN + 9)
POSITION_END, STATE_END, ON_END, OFF_END, TORQUE_END = range(OWN + 9, OWN + 14)

# Where the lines that never change begin, and what the torque's begins with; it is sent from 0 on.
_POSITION, _STATE, _ON, _OFF, _TORQUE = 128, 160, 224, 288, 352

_TURN = 2.0 * pi
_DECIMALS = 6
_POLL = 20_000
_STATE_EVERY = 16
_CLOSED_LOOP, _IDLE = 8, 1
_TORQUE_CONTROL, _PASSTHROUGH = 1, 1
_ANSWER_TIME = 1.0
_START_TIME = 3.0
_LAST_WORD = 0.2
_GIMBAL = 2
_SPEED_LIMITS = (
    "controller.config.enable_torque_mode_vel_limit",
    "controller.config.enable_current_mode_vel_limit",
)
"""From firmware 0.5.3 on, and before."""
_ASTERISK, _NEWLINE, _RETURN, _BLANK = (ord(c) for c in "*\n\r ")


@compiled
def _take(memory: Array, inbox: Bytes) -> int:
    """Read what has come, and every whole line in it: GOOD, CLOSED, or REFUSED if the device says so."""
    while True:
        count = read_some(int(memory[DESCRIPTOR]), inbox, int(memory[HAVE]))
        if count == -2:
            return CLOSED
        if count <= 0:
            break
        memory[HAVE] += count
    status, have, start = GOOD, int(memory[HAVE]), 0
    for at in range(have):
        if inbox[at] == _NEWLINE:
            if _line(memory, inbox, start, at) == REFUSED:
                status = REFUSED
            start = at + 1
    if start == 0 and have == inbox.shape[0]:  # so long is no line
        memory[BAD] += 1
        start = have
    for place in range(have - start):
        inbox[place] = inbox[start + place]
    memory[HAVE] = have - start
    return status


@compiled
def _line(memory: Array, text: Bytes, start: int, end: int) -> int:
    """One answer without its line end: position and velocity, a state, or words, which refuse a command."""
    end = _checked(text, start, end)
    if end < 0:
        memory[BAD] += 1
        return GARBLED
    value, at = read_decimal(text, start, end + 1)
    if at < 0 or not np.isfinite(value):
        memory[BAD] += 1 if at >= 0 else 0
        return REFUSED if at < 0 else GARBLED
    if at == end:
        if memory[STATE_ASKED] > 0:  # or it came twice, and separates nothing
            memory[STATE_ASKED] = memory[POSITION_ASKED] = 0
        return GOOD if value == _CLOSED_LOOP else REFUSED
    _, at = read_decimal(text, at + 1, end + 1) if text[at] == _BLANK else (0.0, -1)
    if at != end:
        memory[BAD] += 1
        return GARBLED
    if memory[STATE_ASKED] > 0 or memory[POSITION_ASKED] == 0:
        memory[OLD] += 1
    else:
        memory[POSITION_ASKED] = 0
        memory[SEEN] = _TURN * value
    return GOOD


@compiled
def _checked(text: Bytes, start: int, end: int) -> int:
    """Where the asterisk stands, if what is behind it is the checksum of what is before it; −1."""
    total, at = 0, start
    while at < end and text[at] != _ASTERISK:
        total ^= int(text[at])
        at += 1
    stop = end - 1 if end > start and text[end - 1] == _RETURN else end
    if stop - at < 2 or stop - at > 4:
        return -1
    given = 0
    for place in range(at + 1, stop):
        digit = int(text[place]) - 48
        if digit < 0 or digit > 9:
            return -1
        given = 10 * given + digit
    return at if given == total else -1


@compiled
def _send(memory: Array, outbox: Bytes, start: int, end: int) -> bool:
    """Lines that stand ready; a port that does not take so few bytes is gone."""
    return write_all(int(memory[DESCRIPTOR]), outbox[start:], end - start)


@compiled
def _wait(memory: Array, inbox: Bytes, flag: int) -> int:
    """Until the question of this flag has its answer: GOOD; or what went wrong."""
    while True:
        over = now() >= memory[UNTIL]  # the last look is after the time, see `frames.more_bytes`
        status = _take(memory, inbox)
        if status != GOOD or memory[flag] == 0:
            return status
        if over:
            if memory[HAVE] > 0 or memory[BAD] > 0:
                return GARBLED
            return STALE if memory[OLD] > 0 else SILENT
        pause(_POLL)


@compiled
def _append(outbox: Bytes, start: int, end: int, at: int) -> int:
    """A line that stands ready, behind what is to be sent."""
    for place in range(end - start):
        outbox[at + place] = outbox[start + place]
    return at + end - start


@compiled
def _put_torque(memory: Array, outbox: Bytes) -> int:
    """The line that gives the torque, with its checksum."""
    at = _append(outbox, _TORQUE, int(memory[TORQUE_END]), 0)
    at = write_decimal(memory[FORCE], _DECIMALS, outbox, at)
    total = 0
    for place in range(at):
        total ^= int(outbox[place])
    outbox[at] = _ASTERISK
    at += 1
    for unit in (100, 10, 1):
        if total >= unit or unit == 1:
            outbox[at] = 48 + total // unit % 10
            at += 1
    outbox[at] = _NEWLINE
    return at + 1


@exchanged
def _measure(memory: Array, inbox: Bytes, outbox: Bytes) -> int:
    """The position; behind a measurement that failed the state first, see the top of the file."""
    status = _take(memory, inbox)
    if status != GOOD:
        return status
    if memory[FAILED] > 0 and memory[POSITION_ASKED] + memory[STATE_ASKED] > 0:
        memory[HAVE] = 0
        memory[STATE_ASKED] = 1
        if not _send(memory, outbox, _STATE, int(memory[STATE_END])):
            return CLOSED
    memory[FAILED], memory[OLD], memory[BAD] = 1, 0, 0
    status = _wait(memory, inbox, STATE_ASKED)
    if status != GOOD:
        return status
    memory[POSITION_ASKED] = 1
    if not _send(memory, outbox, _POSITION, int(memory[POSITION_END])):
        return CLOSED
    status = _wait(memory, inbox, POSITION_ASKED)
    if status == GOOD:
        memory[READING], memory[FAILED] = memory[SEEN], 0
    return status


@exchanged
def _apply(memory: Array, inbox: Bytes, outbox: Bytes) -> int:
    """The torque; the watchdog with it where it begins or ends; now and then both again, and the state."""
    end = _put_torque(memory, outbox)
    watched = 1.0 if memory[FORCE] != 0.0 else 0.0
    often = memory[COUNT] % _STATE_EVERY == 0
    if often or watched != memory[WATCHED]:
        if watched > 0:
            end = _append(outbox, _ON, int(memory[ON_END]), end)
        else:
            end = _append(outbox, _OFF, int(memory[OFF_END]), end)
    if often and memory[FAILED] == 0:
        end = _append(outbox, _STATE, int(memory[STATE_END]), end)
        memory[STATE_ASKED] = 1
    memory[WATCHED] = watched
    memory[COUNT] += 1
    return GOOD if _send(memory, outbox, 0, end) else CLOSED


class ODrive(CompiledConnection):
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

    Raises
    ------
    InputError
        If a number is out of its range.
    """

    motion = "rotary"
    late = 0
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
    met_hardware = False
    measure = _measure
    apply = _apply

    def __init__(self, port: str, *, axis: int = 0, baud: int = 115200, watchdog: float = 0.05) -> None:
        if axis not in (0, 1):
            raise InputError(f"the axis of an ODrive must be 0 or 1, got {axis!r}")
        if not 0 < watchdog < 10:
            raise InputError(
                f"the watchdog of an ODrive must be > 0 and < 10 s, got {watchdog!r}: it is what ends the "
                "torque when this program or the line does"
            )
        self.port, self.axis, self.baud, self.watchdog = port, axis, baud, watchdog
        self._serial: Any = None
        self._before: dict[str, str] = {}
        self._limits = ""

    def open(self, sample_period: float) -> Opened:
        """Reach the ODrive, set it up, and wait until the axis is in closed loop control."""
        if self.watchdog < 4 * sample_period:
            raise InputError(
                f"a watchdog of {self.watchdog:g} s is too short for a sample period of {sample_period:g} s: "
                f"one lost sample must not end the torque; give {4 * sample_period:g} s or more"
            )
        self._serial = open_port(self.port, self.baud)
        try:
            self._set_up()
        except InputError:
            self.close()
            raise
        return self._memory(self._serial.fileno())

    def close(self) -> None:
        """Torque 0, idle, the settings that were found; then the port."""
        serial, self._serial = self._serial, None
        before, self._before = self._before, {}
        if serial is None:
            return
        with suppress(OSError):
            if before:  # else what is at the port has not answered as an ODrive
                serial.write(b"\n" + _line_of(f"c {self.axis} 0"))  # what was cut before ends here
                for name, value in {"requested_state": _IDLE, **before}.items():
                    self._write(serial, name, value)
                _ask(serial, f"r axis{self.axis}.current_state", _LAST_WORD)  # heard, once it answers
        with suppress(OSError):
            serial.close()

    @property
    def on_silence(self) -> str:
        """Its own watchdog."""
        return (
            f"lets the motor go {self.watchdog:g} s after the last torque that was not 0, by its own watchdog"
        )

    def describe(self) -> str:
        """Which axis, over what, and what the position is."""
        return (
            f"ODrive axis {self.axis} at {self.port}, torque control{self._limits}; the position is its own "
            "filtered estimate, told in steps of 6.3 µrad; only an emulator of it has been met"
        )

    def _set_up(self) -> None:
        """What opening sets, each setting read back."""
        serial = self._serial
        serial.write(b"\n")  # ends what an earlier program left unfinished
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
            self._write(serial, name, value)
            found = self._read(name)
            if abs(float(found) - float(value)) > 1e-3 * abs(float(value)):
                raise InputError(
                    f"axis{self.axis}.{name} of the ODrive at {self.port} stays {found} when set to {value}"
                )
        serial.write(_line_of(f"c {self.axis} 0"))
        self._write(serial, "requested_state", _CLOSED_LOOP)
        self._wait_for_start()

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
        limits = "an unknown torque" if isnan(most) else f"{most:.3g} N·m"
        fastest = self._found("controller.config.vel_limit")
        fastest *= self._found("controller.config.vel_limit_tolerance")
        if self._found("controller.config.enable_overspeed_error") == 0:
            fastest = inf
        dropped = "above an unknown speed" if isnan(fastest) else f"above {_TURN * fastest:.3g} rad/s"
        self._limits = f", at most {limits}; it lets the motor go {dropped}, whatever it holds"

    def _known(self, *names: str) -> str:
        """The first of these properties that its firmware has."""
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
        while (state := self._read("current_state")) != str(_CLOSED_LOOP):
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
        answer = _ask(self._serial, f"r axis{self.axis}.{name}", _ANSWER_TIME)
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

    def _write(self, serial: Any, name: str, value: object) -> None:
        serial.write(_line_of(f"w axis{self.axis}.{name} {value}"))

    def _memory(self, descriptor: int) -> Opened:
        """The lines that never change, and nothing asked yet."""
        opened = blank(14, inbox=1024)
        memory = opened.memory
        memory[DESCRIPTOR] = descriptor
        for start, end, line in (
            (_POSITION, POSITION_END, _line_of(f"f {self.axis}")),
            (_STATE, STATE_END, _line_of(f"r axis{self.axis}.current_state")),
            (_ON, ON_END, _line_of(f"w axis{self.axis}.config.enable_watchdog 1")),
            (_OFF, OFF_END, _line_of(f"w axis{self.axis}.config.enable_watchdog 0")),
            (_TORQUE, TORQUE_END, f"c {self.axis} ".encode()),
        ):
            memory[end] = start + len(line)
            opened.outbox[start : start + len(line)] = np.frombuffer(line, np.uint8)
        return opened


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
