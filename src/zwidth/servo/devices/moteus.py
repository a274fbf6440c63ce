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

from zwidth.compiled import Array, compiled
from zwidth.errors import InputError
from zwidth.servo.connection import (
    CLOSED,
    DESCRIPTOR,
    FORCE,
    GARBLED,
    GOOD,
    OWN,
    READING,
    REFUSED,
    TOLD,
    UNTIL,
    CompiledConnection,
    Opened,
    blank,
    exchanged,
)
from zwidth.servo.devices.arrivals import (
    MOST_READS,
    dropped,
    more_bytes,
    unanswered,
    unwrapped,
    unwritten,
)
from zwidth.servo.devices.moteus_frames import (
    ANY,
    BROKEN,
    EARLIER,
    FAILED,
    FAULT,
    MODE,
    OPERATING,
    RIGHT,
    TURNS,
    put_question,
    put_stop,
    put_torque,
    understood,
)
from zwidth.servo.devices.serial_port import open_port
from zwidth.servo.devices.watchdog import check_watchdog
from zwidth.servo.posix import Bytes, now, write_all

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
    38: "over temperature",
    39: "position outside servopos.position_min and position_max",
    40: "under voltage",
    41: "configuration changed",
    42: "no valid commutation encoder",
    43: "no valid output encoder",
    44: "gate driver could not be enabled",
}
"""moteus documentation, "Register reference", 0x00f."""


@compiled
def _judged(memory: Array) -> int:
    """Good where the controller gives the torques that it is told; then the reading [rad]."""
    memory[TOLD] = memory[FAULT]
    if memory[MODE] != OPERATING or not math.isfinite(memory[TURNS]):
        return REFUSED
    turns = memory[TURNS]
    if memory[SEEN] > 0.0:
        turns = unwrapped(turns, memory[BEFORE], _AROUND)
    memory[BEFORE], memory[SEEN] = turns, 1.0
    memory[READING] = 2.0 * math.pi * turns
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


class Moteus(CompiledConnection):
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

    Raises
    ------
    InputError
        If a number is out of its bounds.
    """

    motion: ClassVar[Literal["linear", "rotary"]] = "rotary"
    tells: ClassVar[tuple[str, ...]] = ("fault_code",)
    """In the operating mode 96 to 103: what keeps the torque below the one that was asked for."""
    measure: ClassVar[Any] = staticmethod(_measure)
    apply: ClassVar[Any] = staticmethod(_apply)

    def __init__(
        self,
        port: str,
        *,
        identifier: int = 1,
        watchdog: float = 0.1,
        checksums: bool = False,
        baud: int = 921_600,
    ) -> None:
        if not (isinstance(identifier, int) and 1 <= identifier < _FIRST_SOURCE):
            raise InputError(
                f"identifier must be 1 to {_FIRST_SOURCE - 1}, got {identifier!r}: answers to the host go to "
                "the higher ones; give the controller another id.id"
            )
        if not 0.001 <= watchdog <= 32.0:
            raise InputError(
                f"watchdog must be 1 ms to 32 s, what the register holds, got {watchdog:g} s; "
                "take some sample periods, at most what the hand can do without"
            )
        self.port = port
        self.identifier = identifier
        self.watchdog = watchdog
        self.checksums = checksums
        self.baud = baud
        self._line: Any = None
        self._opened: Opened | None = None

    @property
    def on_silence(self) -> str:
        """What the controller does by itself."""
        return (
            f"after {self.watchdog:g} s without a torque it goes to its timeout mode and stays there until "
            "it is stopped; as delivered that mode holds the velocity at 0 with at most "
            "servo.timeout_max_torque_Nm, 5 N·m: set servo.timeout_mode to 0 for a motor that goes limp"
        )

    def open(self, sample_period: float) -> Opened:
        """Stop the controller, so that its faults are forgotten; then torque 0, until it operates.

        Until the first torque of the loop the watchdog is off, and the torque 0.

        Raises
        ------
        InputError
            If there is no such port, the controller does not answer, reports a fault, or its watchdog is
            shorter than two sample periods.
        """
        check_watchdog(self.watchdog, sample_period)
        self._line = open_port(self.port, self.baud)
        memory, inbox, outbox = self._opened = blank(CHECKED + 1 - OWN)
        memory[DESCRIPTOR], memory[SERVO] = self._line.fileno(), self.identifier
        memory[CHECKED], memory[WATCHDOG] = float(self.checksums), ANY
        try:
            self._begin(memory, inbox, outbox)
        except InputError:
            self.close()
            raise
        memory[WATCHDOG] = round(self.watchdog * 1e3)
        memory[SEEN] = 0.0
        return self._opened

    def close(self) -> None:
        """Torque 0, then the driver off."""
        if self._line is None or self._opened is None:
            return
        memory, inbox, outbox = self._opened
        memory[FORCE] = 0.0
        _apply(memory, inbox, outbox)
        write_all(int(memory[DESCRIPTOR]), outbox, put_stop(outbox, self.identifier, self.checksums))
        with suppress(OSError):
            self._line.close()
        self._line = None

    def describe(self) -> str:
        """Which controller, where, and what has been met of it."""
        return (
            f"moteus {self.identifier} at {self.port}, torque at the output shaft; "
            "tried against an emulator only"
        )

    def _begin(self, memory: Array, inbox: Bytes, outbox: Bytes) -> None:
        """Ask and command 0 until the controller operates."""
        write_all(int(memory[DESCRIPTOR]), outbox, put_stop(outbox, self.identifier, self.checksums))
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

    def _trouble(self, status: int, mode: int, fault: int) -> str:
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
