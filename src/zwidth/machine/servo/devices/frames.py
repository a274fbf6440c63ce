"""Bytes of a frame as numbers, in compiled code: whole numbers and singles, little-endian, and a checksum.

A number in a frame starts at any byte, so it is put together of bytes: a view of wider numbers would
need a multiple of their width.  The sum of a frame is a cyclic redundancy check, highest bit first:
the rest of the frame, times x¹⁶, divided by a polynomial over two elements (Peterson and Brown 1961).
"""

from __future__ import annotations

import struct
from collections.abc import Callable
from math import floor

import numpy as np

from zwidth.machine.servo.connection import CLOSED, GARBLED, GOOD, REFUSED, SILENT, STALE
from zwidth.machine.servo.posix import Bytes, now, pause, read_some
from zwidth.native.compiled import Array, compiled

CCITT = 0x1021
"""x¹⁶ + x¹² + x⁵ + 1, of ITU-T V.41."""


@compiled
def get_unsigned(frame: Bytes, at: int, count: int) -> int:
    """The number ≥ 0 in `count` bytes, seven at most, from `at` on."""
    value = 0
    for i in range(count):
        value |= int(frame[at + i]) << (8 * i)
    return value


@compiled
def get_signed(frame: Bytes, at: int, count: int) -> int:
    """The number in two's complement in `count` bytes, seven at most, from `at` on."""
    value = get_unsigned(frame, at, count)
    half = 1 << (8 * count - 1)
    return value - 2 * half if value >= half else value


@compiled
def put(frame: Bytes, at: int, count: int, value: int) -> int:
    """Write the low `count` bytes of a number, of either sign; the place after them."""
    for i in range(count):
        frame[at + i] = (value >> (8 * i)) & 0xFF
    return at + count


@compiled
def get_float32(frame: Bytes, at: int) -> float:
    """The IEEE 754 single in four bytes; it may be no number."""
    return _float_of(get_unsigned(frame, at, 4))


@compiled
def put_float32(frame: Bytes, at: int, value: float) -> int:
    """Write a number as an IEEE 754 single, rounded to the nearest; the place after it."""
    return put(frame, at, 4, _bits_of(value))


@compiled
def crc16(frame: Bytes, start: int, stop: int, polynomial: int, initial: int) -> int:
    """The checksum of the bytes from `start` to before `stop`; highest bit first, nothing reflected."""
    rest = initial
    for i in range(start, stop):
        rest ^= int(frame[i]) << 8
        for _ in range(8):
            rest = ((rest << 1) ^ polynomial if rest & 0x8000 else rest << 1) & 0xFFFF
    return rest


# In C the two that follow are written by hand, in `native/system.c`.


@compiled
def _float_of(bits: int) -> float:
    """The single whose bits these are."""
    return float(struct.unpack("<f", struct.pack("<I", bits & 0xFFFFFFFF))[0])


@compiled
def _bits_of(value: float) -> int:
    """The bits of the single nearest to a number."""
    with np.errstate(over="ignore"):
        return int(np.float32(value).view(np.uint32))


# An answer is looked for among all that comes: what belongs to an earlier question, or to nobody, is passed
# over, so that one answer too many does not make every later one old.


MOST_READS = 256
"""For one answer: a flood of bytes must not hold up the loop.  The longest answer is shorter than that."""

_PAUSE = 20_000
"""Between two looks [ns]."""


@compiled
def more_bytes(descriptor: int, inbox: Bytes, filled: int, until: int) -> int:
    """Take what comes, behind the `filled` bytes: how many; 0 when the time is over, −2 at a closed line.

    The last look is after the time: a thread that stood still until then does not miss what came meanwhile.
    """
    while True:
        over = now() >= until
        count = read_some(descriptor, inbox, filled)
        if count != -1:
            return count
        if over:
            return 0
        pause(_PAUSE)


# What a packet is to the one who asked.
NOT_OURS, RIGHT, EARLIER, BROKEN, FAILED = range(5)


@compiled
def answered(
    descriptor: int,
    inbox: Bytes,
    asked: int,
    count: int,
    until: int,
    head: int,
    size_of: Callable[[Bytes, int], int],
    kind_of: Callable[[Bytes, int, int, int, int], int],
) -> int:
    """Wait for the answer of whom was asked, with so many parameters, and let `kind_of` move it to the
    beginning.  `size_of` is the size of the packet that begins at a place, 0 if none does; it needs `head`
    bytes."""
    filled, garbled, stale = 0, False, False
    for _ in range(MOST_READS):
        came = more_bytes(descriptor, inbox, filled, until)
        if came == -2:
            return CLOSED
        if came <= 0:
            return unanswered(garbled or filled > 0, stale)
        filled += came
        at = 0
        while filled - at >= head:
            size = size_of(inbox, at)
            if size > filled - at:
                break
            kind = kind_of(inbox, at, size, asked, count)
            if kind == RIGHT:
                return GOOD
            if kind == FAILED:
                return REFUSED
            stale = stale or kind == EARLIER
            garbled = garbled or kind == BROKEN
            at += 1 if kind == BROKEN else size
        filled = dropped(inbox, at, filled)
    return GARBLED


@compiled
def dropped(inbox: Bytes, count: int, filled: int) -> int:
    """Forget the first `count` of the `filled` bytes; how many are left, now at the beginning."""
    for i in range(filled - count):
        inbox[i] = inbox[count + i]
    return filled - count


@compiled
def unanswered(garbled: bool, stale: bool) -> int:
    """The time is over: what came in place of the answer."""
    if garbled:
        return GARBLED
    return STALE if stale else SILENT


@compiled
def unwritten(descriptor: int, inbox: Bytes) -> int:
    """The system did not take what was to be sent: the line is closed, or nobody takes the bytes away."""
    return CLOSED if read_some(descriptor, inbox, 0) == -2 else SILENT


@compiled
def counted_on(memory: Array, before: int, reading: float, turn: float) -> float:
    """``reading + n turn`` that is nearest to the one before: a counter that begins anew has not jumped.

    True as long as less than half a turn of the counter passes between two samples.  The one before is
    remembered in its place, and behind it whether there is one.
    """
    if memory[before + 1] > 0.0:
        reading += turn * floor((memory[before] - reading) / turn + 0.5)
    memory[before], memory[before + 1] = reading, 1.0
    return reading
