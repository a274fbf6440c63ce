"""Packets of Dynamixel's Protocol 2.0: registers of a servo, read and written over a bus.

    FF FF FD 00  identifier  length (2)  instruction  parameters  remainder (2)

The length counts from the instruction on; the remainder is that of all before it, divided by x¹⁶ + x¹⁵ + x² +
1.  Where FF FF FD stands between instruction and remainder an FD is put in behind it, and counted.  An answer
has the instruction 55 and an error before its parameters: bit 7 says that the hardware has a problem, the
rest what was wrong with the question.

Source: ROBOTIS e-Manual, "DYNAMIXEL Protocol 2.0" and "CRC calculation".
"""

from __future__ import annotations

from zwidth.machine.servo.devices.frames import (
    BROKEN,
    EARLIER,
    FAILED,
    NOT_OURS,
    RIGHT,
    answered,
    crc16,
    get_unsigned,
    put,
)
from zwidth.machine.servo.posix import Bytes
from zwidth.native.compiled import compiled

EVERYBODY = 0xFE
"""An identifier that all obey and none answers."""

ALERT = 0x80

_READ, _SYNC_WRITE, _STATUS = 0x02, 0x83, 0x55
_POLYNOMIAL = 0x8005
_LONGEST = 64
"""Bytes of an answer; ours have 11 to 25."""


@compiled
def put_read(out: Bytes, identifier: int, address: int, count: int) -> int:
    """Ask for registers; how many bytes to send."""
    at = _begun(out, 0, identifier, _READ)
    return _finished(out, 0, put(out, put(out, at, 2, address), 2, count))


@compiled
def put_write(out: Bytes, start: int, identifier: int, address: int, count: int, value: int) -> int:
    """Behind `start` bytes, write a register of one servo, which does not answer; how many bytes to send.

    No FF FF FD can come about: an identifier is below FD, and the value of a register ends the parameters.
    """
    at = _begun(out, start, EVERYBODY, _SYNC_WRITE)
    at = put(out, put(out, put(out, at, 2, address), 2, count), 1, identifier)
    return _finished(out, start, put(out, at, count, value))


@compiled
def receive(descriptor: int, inbox: Bytes, identifier: int, count: int, until: int) -> int:
    """Wait for the answer with so many parameters; its error is then inbox[0], the parameters follow.

    An answer of another length is one to an earlier question.
    """
    return answered(descriptor, inbox, identifier, count, until, 7, _size, _kind)


@compiled
def _begun(out: Bytes, start: int, identifier: int, instruction: int) -> int:
    put(out, start, 4, 0x00FDFFFF)
    out[start + 4] = identifier
    out[start + 7] = instruction
    return start + 8


@compiled
def _finished(out: Bytes, start: int, stop: int) -> int:
    put(out, start + 5, 2, stop - start - 5)
    return put(out, stop, 2, crc16(out, start, stop, _POLYNOMIAL, 0))


@compiled
def _size(inbox: Bytes, at: int) -> int:
    """Of the packet that begins here; 0 if none does."""
    size = 7 + get_unsigned(inbox, at + 5, 2)
    begins = get_unsigned(inbox, at, 4) == 0x00FDFFFF
    return size if begins and 10 <= size <= _LONGEST else 0


@compiled
def _kind(inbox: Bytes, at: int, size: int, identifier: int, count: int) -> int:
    """What the packet is; error and parameters of the right one are moved to the beginning."""
    if size == 0:
        return BROKEN
    stop = at + size - 2
    if crc16(inbox, at, stop, _POLYNOMIAL, 0) != get_unsigned(inbox, stop, 2):
        return BROKEN
    if inbox[at + 4] != identifier or inbox[at + 7] != _STATUS or size < 11:
        return NOT_OURS  # of another servo, or what we have sent ourselves
    if inbox[at + 8] & 0x7F != 0:
        return FAILED
    return RIGHT if _unstuffed(inbox, at + 8, stop) == count + 1 else EARLIER


@compiled
def _unstuffed(inbox: Bytes, start: int, stop: int) -> int:
    """Move the bytes to the beginning, without the FD that was put in behind each FF FF FD; how many."""
    kept, ones, put_in = 0, 0, False
    for i in range(start, stop):
        byte = inbox[i]
        if put_in:
            put_in, ones = False, 0
            continue
        put_in = ones >= 2 and byte == 0xFD
        ones = ones + 1 if byte == 0xFF else 0
        inbox[kept] = byte
        kept += 1
    return kept
