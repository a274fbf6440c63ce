"""Bytes of a frame as numbers, in compiled code: whole numbers and singles, little-endian, and a checksum.

A number in a frame starts at any byte, so it is put together of bytes: a view of wider numbers would
need a multiple of their width.  The sum of a frame is a cyclic redundancy check, highest bit first:
the rest of the frame, times x¹⁶, divided by a polynomial over two elements (Peterson and Brown 1961).
"""

from __future__ import annotations

import struct

import numpy as np

from zwidth.machine.servo.posix import Bytes
from zwidth.native.compiled import compiled

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
