"""Packets in a stream of bytes: found by their first two bytes and their checksum, whatever stands between.

    'z' 'W'   kind   n   sequence, uint16   n bytes   CRC-16          numbers little-endian

The checksum is the CRC-16 of ITU-T V.41, polynomial 0x1021, begun with ones, of all bytes before it.  Within
a packet nothing is looked for.  Layout: firmware/mains/shared/telemetry.h.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Bytes = NDArray[np.uint8]
Indices = NDArray[np.int64]

SYNC = b"zW"
TEXT, SAMPLES = 1, 2
"""Kinds: what the law is; what it read and gave."""

HEAD, END = 6, 2
"""Bytes before and after what a packet carries."""

FIXED, EACH = 11, 4
"""Bytes of a packet of samples that come once, and for each sample."""

LARGEST = HEAD + 255 + END


def _table() -> NDArray[np.uint16]:
    rest = np.arange(256, dtype=np.uint32) << 8
    for _ in range(8):
        rest = np.where(rest & 0x8000, (rest << 1) ^ 0x1021, rest << 1) & 0xFFFF
    return rest.astype(np.uint16)


_OF_A_BYTE = _table()
"""What a byte adds to the checksum."""


class Found(NamedTuple):
    """Packets in a stretch of bytes."""

    starts: Indices
    sizes: Indices
    """In bytes, all of a packet."""
    rest: int
    """From where on the bytes belong to packets of which the end is still to come."""


def find(data: Bytes, *, last: bool) -> Found:
    """Every whole packet, in order.

    Parameters
    ----------
    data
        Bytes as they came.
    last
        Nothing more comes: what has no end is no packet.
    """
    syncs = np.flatnonzero((data[:-1] == SYNC[0]) & (data[1:] == SYNC[1]))
    begun = syncs[syncs + HEAD > data.size]
    syncs = syncs[syncs + HEAD <= data.size]
    kinds, lengths = data[syncs + 2], data[syncs + 3].astype(np.int64)
    samples = (kinds == SAMPLES) & (lengths > FIXED) & ((lengths - FIXED) % EACH == 0)
    plausible = samples | ((kinds == TEXT) & (lengths > 1))
    syncs, sizes = syncs[plausible], lengths[plausible] + HEAD + END
    whole = syncs + sizes <= data.size
    begun = np.concatenate([syncs[~whole], begun])
    syncs, sizes = syncs[whole], sizes[whole]
    right = np.zeros(syncs.size, dtype=bool)
    for size in np.unique(sizes):
        those = np.flatnonzero(sizes == size)
        right[those] = _checked(data, syncs[those], int(size))
    starts, sizes = _apart(syncs[right], sizes[right])
    end = int(starts[-1] + sizes[-1]) if starts.size else 0
    begun = begun[begun >= end]
    rest = data.size
    if not last and begun.size:
        rest = int(begun.min())
    elif not last and data.size > end and data[-1] == SYNC[0]:
        rest = data.size - 1
    return Found(starts, sizes, rest)


def number(data: Bytes, at: Indices, size: int) -> Indices:
    """The numbers ≥ 0 of so many bytes that stand at these places."""
    value = np.zeros(at.shape, dtype=np.int64)
    for i in range(size):
        value |= data[at + i].astype(np.int64) << (8 * i)
    return value


def signed(data: Bytes, at: Indices, size: int) -> Indices:
    """The same in two's complement."""
    value = number(data, at, size)
    return np.asarray(value - ((value >> (8 * size - 1)) << (8 * size)))


def _checked(data: Bytes, starts: Indices, size: int) -> NDArray[np.bool_]:
    """Which of the packets of one size have the right checksum."""
    rest = np.full(starts.size, 0xFFFF, dtype=np.uint16)
    for i in range(size - END):
        rest = (rest << 8) ^ _OF_A_BYTE[(rest >> 8) ^ data[starts + i]]
    return np.asarray(rest == number(data, starts + size - END, 2))


def _apart(starts: Indices, sizes: Indices) -> tuple[Indices, Indices]:
    """Without those that begin within the one before: bytes of a packet that look like another one."""
    if starts.size < 2 or (starts[1:] >= starts[:-1] + sizes[:-1]).all():
        return starts, sizes
    kept, end = [], 0
    for i, (start, size) in enumerate(zip(starts.tolist(), sizes.tolist(), strict=True)):
        if start >= end:
            kept.append(i)
            end = start + size
    return starts[kept], sizes[kept]
