"""Hapkit boards over a serial line, by a small protocol of our own and the sketch in examples/hapkit.

The Hapkit's own sketches talk to no host.  The frames, numbers little-endian:

    to the board    A5  kind  number  force, int16 [mN]          CRC-16          7 bytes
    from the board  5A  number  state  position, int32 [counts]  CRC-16          9 bytes

Kind 1 starts: force 0, position 0, the state cleared; 2 asks for the position; 3 gives a force, and is not
answered.  1 and 2 are answered with their own number, so that an answer to another question is known as one.
Bit 0 of the state tells that the board cut a force, not 0, since nothing had come for 20 ms: it stays 0
until the next start.  The checksum is the CRC-16 of ITU-T V.41, begun with ones, of all bytes before it.

A byte takes ten bits on the line.  A period takes 7 + 9 + 7 bytes: 0.23 ms at 1 000 000 Bd, which a board's
clock of 16 MHz divides without a rest (16 · 1 MHz), and 2 ms at 115 200 Bd, which it meets by 2 % only
(16 MHz/(8 · 17) = 117 647; ATmega328P data sheet, section on baud rates).
"""

from __future__ import annotations

import math
from typing import Any, ClassVar, Literal

from zwidth.errors import InputError
from zwidth.machine.servo.connection import (
    CLOSED,
    DESCRIPTOR,
    FORCE,
    GOOD,
    LEAVES,
    OWN,
    READING,
    REFUSED,
    SETS,
    SILENT,
    STATUS,
    UNTIL,
    Opened,
    Setting,
    exchanged,
)
from zwidth.machine.servo.devices.frames import (
    BROKEN,
    CCITT,
    EARLIER,
    RIGHT,
    answered,
    crc16,
    get_signed,
    get_unsigned,
    put,
    unwritten,
)
from zwidth.machine.servo.devices.serial_port import SerialConnection
from zwidth.machine.servo.posix import Bytes, discard, now, write_all
from zwidth.native.compiled import Array, compiled
from zwidth.quantity.text import shown
from zwidth.quantity.units import in_si

TO_DEVICE, FROM_DEVICE = 0xA5, 0x5A
START, ASK, GIVE = 1, 2, 3
CUT = 1
_QUESTION, _ANSWER = 7, 9
_ONES = 0xFFFF

# What is remembered, from OWN on: the number of the last frame, and metres in one count.
NUMBER, COUNT = OWN, OWN + 1

_BOOT = 5e9
"""How long the board may take to start its sketch after the port was opened [ns]."""
_ONE_TRY = 500e6
"""After which it is asked again [ns]."""

WATCHDOG = 0.02
"""Of the sketch [s]."""


@compiled
def _send(memory: Array, outbox: Bytes, kind: int, millinewtons: int) -> bool:
    """A frame with the next number."""
    memory[NUMBER] = (int(memory[NUMBER]) + 1) % 256
    outbox[0], outbox[1], outbox[2] = TO_DEVICE, kind, int(memory[NUMBER])
    end = put(outbox, 3, 2, millinewtons)
    end = put(outbox, end, 2, crc16(outbox, 0, end, CCITT, _ONES))
    return write_all(int(memory[DESCRIPTOR]), outbox, end)


@compiled
def _size(inbox: Bytes, at: int) -> int:
    return _ANSWER if inbox[at] == FROM_DEVICE else 0


@compiled
def _kind(inbox: Bytes, at: int, size: int, number: int, _: int) -> int:
    """What the frame is; the right one is moved to the beginning."""
    if size == 0 or crc16(inbox, at, at + 7, CCITT, _ONES) != get_unsigned(inbox, at + 7, 2):
        return BROKEN
    if inbox[at + 1] != number:
        return EARLIER
    for i in range(_ANSWER):
        inbox[i] = inbox[at + i]
    return RIGHT


@compiled
def _ask(memory: Array, inbox: Bytes, outbox: Bytes, kind: int) -> int:
    """What came before the question is no answer to it."""
    if discard(int(memory[DESCRIPTOR]), inbox) == -2:
        return CLOSED
    if not _send(memory, outbox, kind, 0):
        return unwritten(int(memory[DESCRIPTOR]), inbox)
    number, until = int(memory[NUMBER]), int(memory[UNTIL])
    status = answered(int(memory[DESCRIPTOR]), inbox, number, 0, until, 1, _size, _kind)
    if status == GOOD and int(inbox[2]) & CUT:
        return REFUSED
    if status == GOOD:
        memory[READING] = memory[COUNT] * get_signed(inbox, 3, 4)
    return status


@exchanged
def _measure(memory: Array, inbox: Bytes, outbox: Bytes) -> int:
    return _ask(memory, inbox, outbox, ASK)


@exchanged
def _start(memory: Array, inbox: Bytes, outbox: Bytes) -> int:
    return _ask(memory, inbox, outbox, START)


@exchanged
def _apply(memory: Array, inbox: Bytes, outbox: Bytes) -> int:
    force = 1000.0 * memory[FORCE] if memory[COUNT] > 0 else -1000.0 * memory[FORCE]
    whole = round(min(max(force, -32767.0), 32767.0)) if math.isfinite(force) else 0
    return GOOD if _send(memory, outbox, GIVE, whole) else unwritten(int(memory[DESCRIPTOR]), inbox)


class Hapkit(SerialConnection):
    """A Hapkit with the sketch of examples/hapkit, at its handle [m, N].

    The reading is 0 where the handle stands when the port is opened.  A force is sent in whole millinewtons,
    up to ±32.767 N; which pulse width gives it, the sketch reckons from the radii and the torque at its head.

    Parameters
    ----------
    port
        Serial port of the board, "/dev/ttyUSB0".
    count
        Way of the handle in one count of the sensor [m], not 0; negative where the counts fall while
        the position grows.  To be found with a rule, see docs/connections.md.
    baud
        As the sketch has it [Bd].
    """

    motion: ClassVar[Literal["linear", "rotary"]] = "linear"
    maker: ClassVar[str] = "the sketch of this project, examples/hapkit/hapkit.ino"
    settings: ClassVar[tuple[Setting, ...]] = (
        ("start", "", "end: the force is 0, one that was cut may be given again", SETS, "hapkit.ino"),
        ("SILENCE", "20 ms", "end: the force is cut, and the loop ends", LEAVES, "hapkit.ino:32"),
        ("count", "", "sign, and size of a position; tried with a rule", LEAVES, "of the specification"),
        ("FORWARD", "HIGH", "sign; tried by hand", LEAVES, "hapkit.ino:19"),
        ("SECTOR_RADIUS, HANDLE_RADIUS, PULLEY_RADIUS", "75, 70, 4.191 mm", "size", LEAVES,
         "hapkit.ino:21 to 23"),
        ("TORQUE", "0.03 N·m", "size: at most this at the motor, and it goes with the supply", LEAVES,
         "hapkit.ino:24"),
        ("SPAN", "980", "place: a jump of the sensor that is counted wrong", LEAVES, "hapkit.ino:20"),
    )  # fmt: skip
    measure: ClassVar[Any] = staticmethod(_measure)
    apply: ClassVar[Any] = staticmethod(_apply)

    def __init__(self, port: str, count: float | str, *, baud: int = 1_000_000) -> None:
        count = in_si(count, "m", "count")
        if count == 0:
            raise InputError(
                f"count is the handle's way in one count of the sensor [m] and not 0, got {count}: the board "
                "tells counts alone; move the handle by a known way and divide it by the counts"
            )
        if not (isinstance(baud, int) and baud > 0):
            raise InputError(f"baud is a whole number > 0, got {baud!r}: give the one of the sketch")
        self.port, self.count, self.baud = port, count, baud

    @property
    def on_silence(self) -> str:
        """The sketch has a watchdog of its own."""
        return (
            f"sets its force to 0 after {shown(WATCHDOG, 's')} without a frame, and keeps it there until "
            "it is opened anew"
        )

    def _prepare(self, opened: Opened) -> None:
        opened.memory[COUNT] = self.count
        end, status = now() + _BOOT, SILENT
        while status != GOOD and status != CLOSED and now() < end:
            opened.memory[UNTIL] = now() + _ONE_TRY
            status = _start(*opened)
        if status != GOOD:
            raise InputError(
                f"the board at {self.port} gave, when asked to start: {STATUS[status]}; "
                f"does it run the sketch of examples/hapkit, at {self.baud} Bd?"
            )

    def _check_period(self, sample_period: float) -> None:
        if 2 * sample_period >= WATCHDOG:
            raise InputError(
                f"the sample period must be below {shown(WATCHDOG / 2, 's')}, got "
                f"{shown(sample_period, 's', 6)}: the board cuts its force after two that long"
            )
        exchange = 10 * (_QUESTION + _ANSWER) / self.baud
        if 2 * exchange > sample_period:
            raise InputError(
                f"at {self.baud} Bd a question and its answer take {shown(exchange, 's', 3)}, more than half "
                f"of the sample period of {shown(sample_period, 's', 6)}: take 1000000 Bd, in the sketch "
                "too, or serve it more slowly"
            )

    def _end(self, opened: Opened) -> None:
        _apply(*opened)

    def describe(self) -> str:
        """Which device, over what, which axis: one line."""
        return (
            f"Hapkit at {self.port}, {self.baud} Bd, its handle, {shown(abs(self.count), 'm')} "
            f"in one count, force in whole mN, watchdog of {shown(WATCHDOG, 's')}"
        )
