"""A Feetech bus servo, series STS or SMS (STS3215: LeRobot's SO-100 and SO-101), in its open-loop mode.

There is no torque mode: what is set is the duty d of the bridge, and the torque at the output

    τ = τ_1 d − (k²/R) ω,   τ_1 = k U/R

k the motor's constant at the output, R its resistance, U the supply.  So τ_1, the torque at standstill with
the whole supply, is asked for; it goes with the supply, which sags under load.  The second term is the
motor's back electromotive force: damping that a certificate does not count on.  Friction of the gears comes
on top.

The servo has no watchdog: what it was told last it does until it is told something else.

Each sample is two packets, as of any servo here.  Questions ask for 2, 4 and 6 bytes in turn, so that an
answer to one of the two questions before is known.

Source:  Feetech, memory table of the STS3215; mode 2 and the sign bit 10 of its duty in Feetech's own SMS_STS
library.
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
    REFUSES,
    RESTORES,
    SETS,
    TELLS,
    UNTIL,
    Opened,
    Setting,
    exchanged,
)
from zwidth.machine.servo.devices.frames import (
    BROKEN,
    EARLIER,
    NOT_OURS,
    RIGHT,
    answered,
    counted_on,
    get_unsigned,
    put,
    unwritten,
)
from zwidth.machine.servo.devices.serial_port import BusServo
from zwidth.machine.servo.posix import Bytes, discard, write_all
from zwidth.native.compiled import Array, compiled
from zwidth.quantity.text import shown
from zwidth.quantity.units import in_si

# What it remembers: the servo; how many questions it has asked; the position before [counts] and whether
# there is one; duty [1/1000] per N·m and at most.
SERVO, ASKED, BEFORE, SEEN, PER_TORQUE, MOST = range(OWN, OWN + 6)

COUNTS = 4096.0
"""Of a turn of the output."""

FULL_DUTY = 1000

_RETURN_DELAY, _RESOLUTION, _OPERATING_MODE = 7, 30, 33
_TORQUE_ENABLE, _DUTY, _TORQUE_LIMIT, _LOCK, _PRESENT_POSITION = 40, 44, 48, 55, 56
_OPEN_LOOP = 2
_SIGN_OF_DUTY, _SIGN_OF_POSITION = 10, 15
_WRONG = {0: "supply voltage", 1: "position sensor", 2: "overheating", 3: "current", 5: "overload"}
"""Bits of the state; Feetech, memory table, "servo status"."""


@exchanged
def _measure(memory: Array, inbox: Bytes, outbox: Bytes) -> int:
    """Ask for the position; whatever came before is old."""
    descriptor, servo = int(memory[DESCRIPTOR]), int(memory[SERVO])
    count = 2 + 2 * (int(memory[ASKED]) % 3)
    memory[ASKED] += 1.0
    if discard(descriptor, inbox) == -2:
        return CLOSED
    if not write_all(descriptor, outbox, put_read(outbox, servo, _PRESENT_POSITION, count)):
        return unwritten(descriptor, inbox)
    status = receive(descriptor, inbox, servo, count, int(memory[UNTIL]))
    if status != GOOD:
        return status
    if inbox[0] != 0:
        return REFUSED
    position = float(magnitude(get_unsigned(inbox, 1, 2), _SIGN_OF_POSITION))
    memory[READING] = counted_on(memory, BEFORE, position, COUNTS) * (2.0 * math.pi / COUNTS)
    return GOOD


@exchanged
def _apply(memory: Array, inbox: Bytes, outbox: Bytes) -> int:
    """Set the duty."""
    descriptor, most = int(memory[DESCRIPTOR]), memory[MOST]
    duty = math.floor(min(max(memory[FORCE] * memory[PER_TORQUE], -most), most) + 0.5)
    word = with_sign_bit(int(duty), _SIGN_OF_DUTY)
    count = put_write(outbox, int(memory[SERVO]), _DUTY, 2, word)
    return GOOD if write_all(descriptor, outbox, count) else unwritten(descriptor, inbox)


class Feetech(BusServo):
    """``d = τ/τ_1``; angle of the output [rad], counted on over the turns.

    Parameters
    ----------
    port
        Of the adapter: "/dev/ttyACM0".
    full_duty_torque
        τ_1 at the output, at standstill with the whole supply [N·m], > 0: of your own measurement at your
        supply; a data sheet's stall torque stands for it at the data sheet's voltage.
    identifier
        Of the servo on the bus, 0 to 253.
    reverse
        True where a positive duty turns the servo towards smaller positions: the register "phase" of a servo
        can swap either.  Try it by hand before a wall is rendered: with the wrong one a wall pulls the hand
        in.
    baud
        Of the bus [1/s].
    """

    motion: ClassVar[Literal["linear", "rotary"]] = "rotary"
    maker: ClassVar[str] = (
        "Feetech, memory table of the STS3215; huggingface/lerobot 7427f318, src/lerobot/motors/feetech"
    )
    settings: ClassVar[tuple[Setting, ...]] = (
        ("operation mode 33", "0", "what is controlled: 2, the duty", RESTORES, "tables.py:68"),
        ("lock 55", "", "1: what is written is forgotten when it is switched off", RESTORES, "tables.py:82"),
        ("return delay 7", "250", "delay of the position, 0.5 ms", RESTORES, "feetech.py:213"),
        ("torque switch 40", "0", "whether there is a torque; 0 in the end", SETS, "tables.py:76"),
        ("running time 44", "0", "the duty in mode 2, bit 10 its sign; 0 before the torque is on", SETS,
         "SMS_STS library, WritePwm"),
        ("angular resolution 30", "1", "place: a count is no 1/4096 of a turn unless 1", REFUSES,
         "tables.py:66"),
        ("torque limit 48", "1000", "size: a duty is at most this", TELLS, "tables.py:81"),
        ("state of the servo", "0", "end: a fault, in every answer", TELLS, "memory table, servo status"),
        ("max torque 16", "1000", "size: torque limit 48 is this when it is switched on", LEAVES,
         "tables.py:55"),
        ("phase 18", "", "sign: which way a duty turns; tried by hand, and `reverse` given", LEAVES,
         "feetech.py:219"),
        ("overload torque 36, protective torque 34, protection time 35", "",
         "size: after so long at so much it gives the protective torque", LEAVES, "tables.py:69 to 71"),
        ("protection current 28, over-current time 38", "", "end: a fault", LEAVES,
         "tables.py:65, 73"),
        ("unloading condition 19", "", "end: which faults put the torque off", LEAVES,
         "tables.py:57"),
        ("homing offset 31", "0", "where the zero is", LEAVES, "tables.py:67"),
    )  # fmt: skip
    measure: ClassVar[Any] = staticmethod(_measure)
    apply: ClassVar[Any] = staticmethod(_apply)

    def __init__(
        self,
        port: str,
        *,
        full_duty_torque: float | str,
        identifier: int = 1,
        reverse: bool = False,
        baud: int = 1_000_000,
    ) -> None:
        if not (isinstance(identifier, int) and 0 <= identifier <= 253):
            raise InputError(f"identifier must be 0 to 253, those of a Feetech servo, got {identifier!r}")
        full_duty_torque = in_si(full_duty_torque, "N*m", "full_duty_torque")
        if full_duty_torque <= 0:
            raise InputError(
                f"full-duty torque must be > 0, got {full_duty_torque!r} N·m: with it torques become duties; "
                "measure it at standstill with your supply, or take the stall torque of the data sheet at "
                "its voltage"
            )
        super().__init__(port, identifier, baud, put_read, put_write, receive)
        self.full_duty_torque = full_duty_torque
        self.reverse = reverse
        self._most_torque = math.nan

    @property
    def on_silence(self) -> str:
        """What the servo does by itself."""
        return (
            "it keeps its last duty, for it has no watchdog, also when the host dies or the cable breaks: "
            "have a switch in its supply at hand"
        )

    def describe(self) -> str:
        """Which servo, its numbers, and what has been met of it."""
        limit = "" if math.isnan(self._most_torque) else f", {shown(self._most_torque, 'N*m', 3)} at most"
        return (
            f"{self._name}, a duty in place of a torque, {shown(self.full_duty_torque, 'N*m', 6)} at full "
            f"duty and standstill{limit}; tried against an emulator only"
        )

    @property
    def _name(self) -> str:
        return f"Feetech servo {self.identifier} at {self.port}"

    def _prepare(self, opened: Opened) -> None:
        """With the lock on, what is written is forgotten when the servo is switched off."""
        memory = opened.memory
        memory[SERVO] = self.identifier
        resolution = self._read(_RESOLUTION, 1)
        if resolution != 1:
            raise InputError(
                f"{self._name} has the angular resolution {resolution}, register {_RESOLUTION}: its counts "
                f"are then no 1/{COUNTS:.0f} of a turn; set it to 1"
            )
        limit = min(self._read(_TORQUE_LIMIT, 2), FULL_DUTY)
        self._set(_TORQUE_ENABLE, 1, 0)
        self._change(_LOCK, 1, 1)
        self._change(_RETURN_DELAY, 1, 0)
        self._change(_OPERATING_MODE, 1, _OPEN_LOOP)
        self._set(_DUTY, 2, 0)
        self._set(_TORQUE_ENABLE, 1, 1)
        memory[PER_TORQUE] = (-1.0 if self.reverse else 1.0) * FULL_DUTY / self.full_duty_torque
        memory[MOST] = limit
        self._most_torque = limit / FULL_DUTY * self.full_duty_torque

    def _leave(self) -> None:
        self._set(_TORQUE_ENABLE, 1, 0)

    def _fault(self, state: int) -> str:
        words = [word for bit, word in _WRONG.items() if state >> bit & 1]
        return ", ".join(words) or f"state {state}"


# FF FF  identifier  length  instruction  parameters  checksum
#
# The length counts from the instruction on, with the checksum: the complement of the sum of all from the
# identifier on.  An answer has in place of the instruction the state of the servo: 0, or a bit for each thing
# wrong.  Numbers are little-endian; signed ones are a magnitude with a sign bit, which bit depends on the
# register.  Sources: Feetech, "Communication protocol manual" and the memory table of the STS3215; the packet
# handler of feetech-servo-sdk.


EVERYBODY = 0xFE
"""An identifier that all obey and none answers."""

_READ, _SYNC_WRITE = 0x02, 0x83
_LONGEST = 32
"""Bytes of an answer; ours have 6 to 12."""


@compiled
def put_read(out: Bytes, identifier: int, address: int, count: int) -> int:
    """Ask for registers; how many bytes to send."""
    out[4], out[5], out[6] = _READ, address, count
    return _finished(out, identifier, 7)


@compiled
def put_write(out: Bytes, identifier: int, address: int, count: int, value: int) -> int:
    """Write a register of one servo, which does not answer; how many bytes to send."""
    out[4], out[5], out[6], out[7] = _SYNC_WRITE, address, count, identifier
    return _finished(out, EVERYBODY, put(out, 8, count, value))


@compiled
def magnitude(value: int, sign_bit: int) -> int:
    """Of a number as the registers have it: below the sign bit its size."""
    size = value & ((1 << sign_bit) - 1)
    return -size if value >> sign_bit & 1 else size


@compiled
def with_sign_bit(value: int, sign_bit: int) -> int:
    """A number as the registers have it."""
    return -value | 1 << sign_bit if value < 0 else value


@compiled
def receive(descriptor: int, inbox: Bytes, identifier: int, count: int, until: int) -> int:
    """Wait for the answer with so many parameters; the state is then inbox[0], the parameters follow.

    An answer of another length is one to an earlier question.
    """
    return answered(descriptor, inbox, identifier, count, until, 4, _size, _kind)


@compiled
def _finished(out: Bytes, identifier: int, stop: int) -> int:
    out[0], out[1], out[2], out[3] = 0xFF, 0xFF, identifier, stop - 3
    out[stop] = _complement(out, 2, stop)
    return stop + 1


@compiled
def _complement(frame: Bytes, start: int, stop: int) -> int:
    total = 0
    for i in range(start, stop):
        total += int(frame[i])
    return ~total & 0xFF


@compiled
def _size(inbox: Bytes, at: int) -> int:
    """Of the packet that begins here; 0 if none does."""
    size = 4 + int(inbox[at + 3])
    begins = get_unsigned(inbox, at, 2) == 0xFFFF and inbox[at + 2] != 0xFF
    return size if begins and 6 <= size <= _LONGEST else 0


@compiled
def _kind(inbox: Bytes, at: int, size: int, identifier: int, count: int) -> int:
    """What the packet is; state and parameters of the right one are moved to the beginning."""
    if size == 0 or _complement(inbox, at + 2, at + size - 1) != inbox[at + size - 1]:
        return BROKEN
    if inbox[at + 2] != identifier:
        return NOT_OURS
    if size != 6 + count:
        return EARLIER
    for i in range(count + 1):
        inbox[i] = inbox[at + 4 + i]
    return RIGHT
