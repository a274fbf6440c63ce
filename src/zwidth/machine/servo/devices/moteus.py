"""A motor on an mjbots moteus controller, over its CAN adapter or its own serial line.

Each sample is two frames: a question for position, mode and fault, whose answer is waited for, and a torque,
for which no answer is asked.  One frame could carry both, but then the answer to a torque is as old as the
period at the next sample, or the torque waits for the next question.

The torque is the feed-forward of the position mode, all scales of its loop 0.  It is good for a given time
only: the controller's own watchdog.  The answers to different questions go to different sources (112 to 127),
so that an old one is known.
"""

from __future__ import annotations

import math
import time
from contextlib import suppress
from typing import Any, ClassVar, Literal

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
    SETS,
    TELLS,
    TOLD,
    UNTIL,
    Opened,
    Setting,
    exchanged,
)
from zwidth.machine.servo.devices.frames import (
    MOST_READS,
    counted_on,
    dropped,
    more_bytes,
    unanswered,
    unwritten,
)
from zwidth.machine.servo.devices.moteus_frames import (
    ANY,
    BROKEN,
    EARLIER,
    FAILED,
    FAULT,
    MODE,
    NO_CHECKSUM,
    OPERATING,
    RAW,
    RIGHT,
    TURNS,
    addressed,
    put_data,
    put_question,
    put_stop,
    put_torque,
    understood,
)
from zwidth.machine.servo.devices.serial_port import SerialConnection, check_watchdog
from zwidth.machine.servo.posix import Bytes, now, write_all
from zwidth.native.compiled import Array, compiled
from zwidth.quantity.text import shown
from zwidth.quantity.units import in_si

# What it remembers besides MODE, FAULT and TURNS: how many questions it has asked, the position before
# [turns] and whether there is one; the address of the servo, the watchdog [ms], whether lines have checksums.
ASKED, BEFORE, SEEN, SERVO, WATCHDOG, CHECKED = range(OWN + 3, OWN + 9)

_FIRST_SOURCE, _SOURCES = 112, 16

_START_TIME = 0.6
"""For the controller to operate, when it is opened [s]."""
_ONE_TRY = 200e6
"""For an answer then [ns]."""

_AROUND = 65536.0
"""Turns after which the position begins anew, from 32768 at −32768 (moteus documentation, "Limits")."""

_FAULTS = {
    32: "calibration",
    33: "motor driver",
    34: "over voltage",
    35: "encoder",
    36: "motor not configured",
    37: "pulse width cycle overrun",
    38: "over temperature",
    39: "position outside servopos.position_min and position_max",
    40: "under voltage",
    41: "configuration changed",
    42: "no valid commutation encoder",
    43: "no valid output encoder",
    44: "gate driver could not be enabled",
    45: "stop position, which firmware has given up",
    46: "timing violation",
    47: "servo.bemf_feedforward without a limit of the acceleration",
    48: "servopos.position_min and position_max invalid",
    49: "position error beyond servo.fault_position_error",
    50: "velocity beyond servo.fault_velocity_error",
}
"""mjbots, moteus, fw/error.h, lines 36 to 54."""

_TIMEOUT_MODE = "servo.timeout_mode"

_TIMEOUTS: dict[float, str] = {
    10: "brings its motor to rest and holds it there with its own gains, up to servo.max_current_A",
    12: "goes limp, for its zero velocity takes the derivative scale of the last torque, 0 (firmware before "
    "May 2022 damps, with up to servo.timeout_max_torque_Nm)",
    15: "brakes, its phases shorted",
}
"""By servo.timeout_mode; any other goes limp: fw/bldc_servo_control.h, lines 1137 to 1152, 1451 to 1477."""

_POLLS = 50


@compiled
def _judged(memory: Array) -> int:
    """Good where the controller gives the torques that it is told; then the reading [rad]."""
    memory[TOLD] = memory[FAULT]
    if memory[MODE] != OPERATING or not math.isfinite(memory[TURNS]):
        return REFUSED
    memory[READING] = 2.0 * math.pi * counted_on(memory, BEFORE, memory[TURNS], _AROUND)
    return GOOD


@exchanged
def _measure(memory: Array, inbox: Bytes, outbox: Bytes) -> int:
    """Ask for the position; every line that has come meanwhile is read, for one may report a fault."""
    descriptor, servo, checked = int(memory[DESCRIPTOR]), int(memory[SERVO]), memory[CHECKED] > 0.0
    source = _FIRST_SOURCE + int(memory[ASKED]) % _SOURCES
    memory[ASKED] += 1.0
    if not write_all(descriptor, outbox, put_question(outbox, servo, source, checked)):
        return unwritten(descriptor, inbox)
    filled, garbled, stale = 0, False, False
    for _ in range(MOST_READS):
        came = more_bytes(descriptor, inbox, filled, int(memory[UNTIL]))
        if came == -2:
            return CLOSED
        if came <= 0:
            return unanswered(garbled or filled > 0, stale)
        looked, start = filled, 0
        filled += came
        for i in range(looked, filled):
            if inbox[i] not in (10, 13):
                continue
            kind = understood(inbox[start:i], i - start, servo, source, checked, memory)
            start = i + 1
            if kind == RIGHT:
                return _judged(memory)
            if kind == FAILED:
                return REFUSED
            stale = stale or kind == EARLIER
            garbled = garbled or kind == BROKEN
        filled = dropped(inbox, start, filled)
        if filled == inbox.shape[0]:
            filled, garbled = 0, True
    return GARBLED


@exchanged
def _apply(memory: Array, inbox: Bytes, outbox: Bytes) -> int:
    """Command the torque."""
    descriptor, servo, checked = int(memory[DESCRIPTOR]), int(memory[SERVO]), memory[CHECKED] > 0.0
    count = put_torque(outbox, servo, memory[FORCE], int(memory[WATCHDOG]), checked)
    return GOOD if write_all(descriptor, outbox, count) else unwritten(descriptor, inbox)


class Moteus(SerialConnection):
    """``τ`` as feed-forward torque, gains 0; angle of the output shaft [rad], counted on over the turns.

    Parameters
    ----------
    port
        Of the CAN adapter, "/dev/fdcanusb" or "/dev/ttyACM0"; or of the controller's own UART.
    identifier
        Of the controller on the bus (id.id), 1 to 111: the higher ones are taken for the host's questions.
    watchdog
        After so long without a torque the controller leaves off [s]; to a millisecond.
    checksums
        True for a controller's own UART: lines end in a checksum, both ways.  USB has its own.
    baud
        Of the UART [1/s]; an adapter on USB ignores it.
    """

    motion: ClassVar[Literal["linear", "rotary"]] = "rotary"
    maker: ClassVar[str] = "mjbots/moteus db1a7623 of April 2026, fw; bldc_servo_ left out of file names"
    settings: ClassVar[tuple[Setting, ...]] = (
        ("mode, kp, kd and ilimit scale", "", "what is controlled: of position mode the torque alone",
         SETS, "control.h:1126"),
        ("watchdog_timeout", "servo.default_timeout_s", "end: how long a torque acts", SETS,
         "control.h:1670"),
        (_TIMEOUT_MODE, "12", "end: what comes then: limp, brake, or a hold of its own", TELLS,
         "control.h:1451"),
        ("servo.fixed_voltage_mode", "0", "turns the motor by a voltage, whatever the torque", REFUSES,
         "control.h:1178"),
        ("servo.voltage_mode_control", "0", "size: less by the back-EMF, and as the resistance is set", TELLS,
         "control.h:1112"),
        ("servo.max_current_A", "20 to 120", "size: no more current; fault_code 99", TELLS, "control.h:900"),
        ("servo.inertia_feedforward", "0", "size: adds a torque to a motor that turns at the start", TELLS,
         "control.h:1222"),
        ("motor.cogging_dq_scale", "0", "size: adds a current by the angle of the rotor", TELLS,
         "control.h:1292"),
        ("servopos.position_min, _max", "±0.01 turn", "end: no start outside; outward torques fade there, "
         "fault_code 103", LEAVES, "control.h:831, 1598"),
        ("servo.max_velocity", "500 turn/s", "size: driving torques fade above; fault_code 96", LEAVES,
         "control.h:861"),
        ("servo.max_power_W", "of the board", "size: less current; fault_code 97", LEAVES, "control.h:986"),
        ("command max torque", "100 N·m", "size: |τ| ≤ 100 N·m; fault_code 102", LEAVES, "structs.h:359"),
        ("servo.fault_temperature", "75 °C", "size, end: less current 25 °C below; code 100", LEAVES,
         "control.h:880"),
        ("servo.max_voltage", "37 to 56 V", "end: a motor that is turned charges the supply", LEAVES,
         "control.h:1651"),
        ("servo.fault_velocity_error", "NaN", "end: faster than this, fault 50", LEAVES, "control.h:1246"),
        ("motor.Kv, motor.rotation_*", "by calibration", "size: its current; with Kv 0 5 A at most", LEAVES,
         "control.h:386, 1303"),
        ("motor_position.rotor_to_output_ratio", "1", "size: torque at the output over the rotor's", LEAVES,
         "control.h:1268"),
        ("motor_position.output.sign", "1", "sign, of torque and angle alike", LEAVES, "control.h:784"),
    )  # fmt: skip
    tells: ClassVar[tuple[str, ...]] = ("fault_code",)
    """In the operating mode 96 to 105: what keeps the torque below the one that was asked for."""
    measure: ClassVar[Any] = staticmethod(_measure)
    apply: ClassVar[Any] = staticmethod(_apply)

    def __init__(
        self,
        port: str,
        *,
        identifier: int = 1,
        watchdog: float | str = 0.1,
        checksums: bool = False,
        baud: int = 921_600,
    ) -> None:
        if not (isinstance(identifier, int) and 1 <= identifier < _FIRST_SOURCE):
            raise InputError(
                f"identifier must be 1 to {_FIRST_SOURCE - 1}, got {identifier!r}: answers to the host go to "
                "the higher ones; give the controller another id.id"
            )
        watchdog = in_si(watchdog, "s", "watchdog")
        if not 0.001 <= watchdog <= 32.0:
            raise InputError(
                f"watchdog must be 1 ms to 32 s, what the register holds, got {watchdog!r} s; "
                "take some sample periods, at most what the hand can do without"
            )
        self.port = port
        self.identifier = identifier
        self.watchdog = watchdog
        self.checksums = checksums
        self.baud = baud
        self._configuration: dict[str, float] = {}

    @property
    def on_silence(self) -> str:
        """What the controller does by itself."""
        first = f"after {shown(self.watchdog, 's', 6)} without a torque it"
        last = ", and stays so until it is stopped; what it held up falls where it is limp"
        mode = self._configuration.get(_TIMEOUT_MODE)
        if mode is None:
            return (
                f"{first} does what its servo.timeout_mode says, not read here: with 0, or 12 as delivered, "
                f"it goes limp, with 15 it brakes, with 10 it holds its place by a law of its own{last}"
            )
        return f"{first} {_TIMEOUTS.get(mode, 'goes limp')} (servo.timeout_mode {mode:g}){last}"

    def _check_period(self, sample_period: float) -> None:
        check_watchdog(self.watchdog, sample_period)

    def _prepare(self, opened: Opened) -> None:
        """Stop the controller, so that its faults are forgotten; then torque 0, until it operates.

        Until the first torque of the loop the watchdog is off, and the torque 0.
        """
        memory = opened.memory
        memory[SERVO], memory[CHECKED], memory[WATCHDOG] = self.identifier, float(self.checksums), ANY
        self._begin(*opened)
        memory[WATCHDOG] = round(self.watchdog * 1e3)
        memory[SEEN] = 0.0

    def _end(self, opened: Opened) -> None:
        """Torque 0, then the driver off."""
        memory, inbox, outbox = opened
        if memory[MODE] == OPERATING:  # else a torque, also of 0, would make it begin
            _apply(memory, inbox, outbox)
        write_all(int(memory[DESCRIPTOR]), outbox, put_stop(outbox, self.identifier, self.checksums))

    def describe(self) -> str:
        """Which controller, where, what of its configuration bears on the torque, and what has been met."""
        found = self._configuration.items()
        bears = "".join(f", {name} {value:g}" for name, value in found if name != _TIMEOUT_MODE and value)
        return (
            f"moteus {self.identifier} at {self.port}, torque at the output shaft{bears}; "
            "tried against an emulator only"
        )

    def _begin(self, memory: Array, inbox: Bytes, outbox: Bytes) -> None:
        """Ask and command 0 until the controller operates."""
        write_all(int(memory[DESCRIPTOR]), outbox, put_stop(outbox, self.identifier, self.checksums))
        self._configure(outbox)
        end = time.monotonic() + _START_TIME
        while True:
            _apply(memory, inbox, outbox)
            memory[UNTIL] = now() + _ONE_TRY
            status = _measure(memory, inbox, outbox)
            if status == GOOD:
                return
            faulty = status == REFUSED and memory[MODE] == 1
            if status == CLOSED or faulty or time.monotonic() >= end:
                break
            time.sleep(0.005)
        raise InputError(self._trouble(status, int(memory[MODE]), int(memory[FAULT])))

    def _configure(self, outbox: Bytes) -> None:
        """Read what the controller is set to, before it is to operate; leave out what it does not say."""
        self._configuration = {}
        while (left := self._said(outbox)) is not None:
            if not left:
                break
        else:
            return  # it does not answer, which is said when it is to operate
        for name in (name for name, _, _, done, _ in self.settings if done in (TELLS, REFUSES)):
            text = f"conf get {name}\n".encode()
            self._send(outbox, self.identifier, bytes((0x40, 1, len(text))) + text)
            said = b""
            for _ in range(_POLLS):
                part = self._said(outbox)
                if part is None:
                    return
                said += part
                if b"\n" in said or b"\r" in said:
                    break
                time.sleep(1e-3)
            with suppress(ValueError):  # an error in words: its firmware does not have it
                self._configuration[name] = float(said)
        if self._configuration.get("servo.fixed_voltage_mode"):
            raise InputError(
                f"moteus {self.identifier} at {self.port} has servo.fixed_voltage_mode: it turns its motor "
                "by a voltage and gives no torque; set it to 0, with an encoder"
            )

    def _send(self, outbox: Bytes, address: int, data: bytes) -> None:
        outbox[RAW : RAW + len(data)] = np.frombuffer(data, np.uint8)
        write_all(self._line.fileno(), outbox, put_data(outbox, address, len(data), self.checksums))

    def _said(self, outbox: Bytes) -> bytes | None:
        """What the controller had to say in its stream of text; None where it does not answer."""
        self._send(outbox, 0x8000 | self.identifier, bytes((0x42, 1, 48)))
        end, text = time.monotonic() + _ONE_TRY * 1e-9, b""
        while True:
            over = time.monotonic() >= end  # the last look is after the time
            *lines, text = (text + self._line.read(512)).replace(b"\r", b"\n").split(b"\n")
            for line in lines:
                data = np.frombuffer(line, np.uint8).copy()
                size = addressed(data, len(line), self.identifier, 0, self.checksums)
                if size == -1 - FAILED:
                    return None
                if size >= 3 and data[0] == 0x41 and data[1] == 1:
                    return bytes(data[3 : min(size, 3 + int(data[2]))])
            if over:
                return None
            time.sleep(1e-4)

    def _trouble(self, status: int, mode: int, fault: int) -> str:
        if status == REFUSED and fault == NO_CHECKSUM:
            return (
                f"moteus {self.identifier} at {self.port} has heard a line with a checksum since it was "
                "switched on, and takes none without: give checksums = true, or switch it off and on"
            )
        if status == REFUSED:
            name = _FAULTS.get(fault, "see the register reference of moteus")
            return (
                f"moteus {self.identifier} at {self.port} does not operate: mode {mode}, fault {fault} "
                f"({name}); or the adapter answers ERR, as it does where its bus is off"
            )
        return (
            f"moteus {self.identifier} at {self.port} does not answer; is it powered, on this bus, and is "
            f"its id.id {self.identifier}?"
            + ("" if self.checksums else "  Its own UART, without a CAN adapter, may want checksums")
        )
