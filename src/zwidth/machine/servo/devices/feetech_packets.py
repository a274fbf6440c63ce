"""Packets of Feetech's bus servos, series STS and SMS: registers of a servo, read and written over a bus.

    FF FF  identifier  length  instruction  parameters  checksum

The length counts from the instruction on, with the checksum: the complement of the sum of all from the
identifier on.  An answer has in place of the instruction the state of the servo: 0, or a bit for each thing
wrong.  Numbers are little-endian; signed ones are a magnitude with a sign bit, which bit depends on the
register.

Sources: Feetech, "Communication protocol manual" and the memory table of the STS3215; the packet handler of
feetech-servo-sdk.
"""

from __future__ import annotations

from zwidth.machine.servo.connection import CLOSED, GARBLED, GOOD
from zwidth.machine.servo.devices.arrivals import MOST_READS, dropped, more_bytes, unanswered
from zwidth.machine.servo.devices.frames import get_unsigned, put
from zwidth.machine.servo.posix import Bytes
from zwidth.native.compiled import compiled

EVERYBODY = 0xFE
"""An identifier that all obey and none answers."""

_READ, _SYNC_WRITE = 0x02, 0x83
_LONGEST = 32
"""Bytes of an answer; ours have 6 to 12."""

# What a packet is to the one who asked.
_NOT_OURS, _RIGHT, _EARLIER, _BROKEN = range(4)


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
    filled, garbled, stale = 0, False, False
    for _ in range(MOST_READS):
        came = more_bytes(descriptor, inbox, filled, until)
        if came == -2:
            return CLOSED
        if came <= 0:
            return unanswered(garbled or filled > 0, stale)
        filled += came
        at = 0
        while filled - at >= 4:
            size = _size(inbox, at)
            if size > filled - at:
                break
            kind = _kind(inbox, at, size, identifier, count)
            if kind == _RIGHT:
                return GOOD
            stale = stale or kind == _EARLIER
            garbled = garbled or kind == _BROKEN
            at += 1 if kind == _BROKEN else size
        filled = dropped(inbox, at, filled)
    return GARBLED


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
        return _BROKEN
    if inbox[at + 2] != identifier:
        return _NOT_OURS
    if size != 6 + count:
        return _EARLIER
    for i in range(count + 1):
        inbox[i] = inbox[at + 4 + i]
    return _RIGHT
