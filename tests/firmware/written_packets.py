"""Packets of telemetry as docs/firmware.md has them, written without the code that reads them."""

from __future__ import annotations

import binascii
import struct
from collections.abc import Sequence

TEXT = (
    "zwidth telemetry 1\nperiod_s 0.001\nresolution 2.24e-05\nforce_per_unit 1.0\nforce_most 5.0\n"
    "certificate 9f86d081884c7d659a2feaa0c55ad015a3bf4f1b2b0b822cd15d6c15b0f00a08\n"
)
SERVING, FIRST = 1, 0x80


def packet(kind: int, sequence: int, content: bytes) -> bytes:
    framed = b"zW" + struct.pack("<BBH", kind, len(content), sequence & 0xFFFF) + content
    return framed + struct.pack("<H", binascii.crc_hqx(framed, 0xFFFF))


def text(said: str = TEXT, flags: int = 0) -> bytes:
    return packet(1, 0, bytes([flags]) + said.encode())


def samples(
    sequence: int,
    time: int,
    counts: Sequence[int],
    forces: Sequence[int],
    *,
    status: int = SERVING,
    dropped: int = 0,
) -> bytes:
    """A packet of samples; times in microseconds."""
    content = struct.pack("<IiBH", time & 0xFFFFFFFF, counts[0], status, dropped & 0xFFFF)
    for n, f in zip(counts, forces, strict=True):
        content += struct.pack("<hh", n - counts[0], f)
    return packet(2, sequence, content)


def packed(counts: Sequence[int], forces: Sequence[int], first: int = 0) -> list[bytes]:
    """Packets of 16 samples, a millisecond apart, of which the first has this number."""
    at = range(0, len(counts), 16)
    return [samples(n, 16_000 * n, counts[i : i + 16], forces[i : i + 16]) for n, i in enumerate(at, first)]


def unpacked(data: bytes) -> tuple[list[str], list[tuple[int, int, int, int, int]]]:
    """The texts, and (sequence, time, counts, force, status) of each sample, of whole packets in a row."""
    texts, found, at = [], [], 0
    while at < len(data):
        mark, kind, size, sequence = struct.unpack_from("<2sBBH", data, at)
        content = data[at + 6 : at + 6 + size]
        (total,) = struct.unpack_from("<H", data, at + 6 + size)
        assert mark == b"zW"
        assert total == binascii.crc_hqx(data[at : at + 6 + size], 0xFFFF)
        at += size + 8
        if kind == 1:
            texts.append(content[1:].decode())
            continue
        time, first, status, _ = struct.unpack_from("<IiBH", content)
        for i, (way, force) in enumerate(struct.iter_unpack("<hh", content[11:])):
            found.append((sequence, time + 1000 * i, first + way, force, status))
    return texts, found
