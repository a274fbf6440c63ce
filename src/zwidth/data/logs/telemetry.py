"""Telemetry of a law, from the bytes of a line to samples and to the table of a log.

    t_k = t_0 + k T         within a packet, t_0 its stamp
    x_k = (n_0 + d_k) q     n_0 the counts of the first sample, d_k how many more there are

Stamps are of 32 bits, in microseconds: they begin anew after 71.6 minutes.  A machine that was started anew
says so in its first packet; where that is lost, its stamp that goes back says it.
"""

from __future__ import annotations

from binascii import crc_hqx
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from zwidth.data.logs.contents import COLUMNS
from zwidth.data.logs.table import Finding, Table, Values
from zwidth.errors import InputError
from zwidth.native.compiled import Array

FIRST = 0x80
"""In the status: the first packet since the machine was started."""


class Samples(NamedTuple):
    """Samples in a row; arrays of one length."""

    start: Indices
    """Which start of the machine they belong to, from 0 on."""
    stamp: Indices
    """Of the first sample of the packet, since the start of the machine [µs]."""
    place: Indices
    """Which sample of its packet, from 0 on."""
    counts: Indices
    force: Indices
    """In units of what is sent."""
    status: Indices

    @property
    def size(self) -> int:
        return int(self.counts.size)

    def time(self, about: About) -> Array:
        """Since the start of the machine [s]."""
        return np.asarray(1e-6 * self.stamp + about.period * self.place)

    def position(self, about: About) -> Array:
        """As the encoder read it [m; rad], positive into the wall."""
        return np.asarray(about.resolution * self.counts)

    def given(self, about: About) -> Array:
        """Force of the actuator [N; N·m], positive out of the wall."""
        return np.asarray(about.force_unit * self.force)


class Decoder:
    """Takes bytes as they come, cut anywhere; counts what is missing."""

    def __init__(self) -> None:
        self.about: About | None = None
        self.packets = 0
        self.lost = 0
        """Packets that the sequence shows to be missing."""
        self.damaged = 0
        """Stretches of bytes between two packets that are no packet."""
        self.dropped = 0
        """Samples that the machine had no room for."""
        self.unfinished = 0
        """Bytes at the end that are no packet."""
        self._held = b""
        self._ended: int | None = None
        self._passed = 0
        self._start = 0
        self._before: tuple[int, int, int, int] | None = None

    def take(self, data: bytes, *, last: bool = False) -> Samples:
        """The samples of all packets that are whole by now; `last` says that nothing more comes."""
        held = np.frombuffer(self._held + data, dtype=np.uint8)
        found = find(held, last=last)
        self._count_damage(found.starts, found.starts + found.sizes)
        for at, size in zip(found.starts.tolist(), found.sizes.tolist(), strict=True):
            if held[at + 2] == TEXT:
                self._hear(held[at + HEAD : at + size - END].tobytes())
        self._passed += found.rest
        self._held = held[found.rest :].tobytes()
        if last:
            self.unfinished = self._passed - (self._ended or 0)
        whole = held[found.starts + 2] == SAMPLES
        return self._samples(held, found.starts[whole])

    def _count_damage(self, starts: Indices, ends: Indices) -> None:
        if not starts.size:
            return
        before = self._passed if self._ended is None else self._ended
        gaps = starts + self._passed - np.concatenate([[before], ends[:-1] + self._passed])
        if self._ended is None:
            gaps[0] = 0  # it was begun in the middle of a packet
        self.damaged += int(np.count_nonzero(gaps))
        self._ended = int(ends[-1]) + self._passed

    def _hear(self, content: bytes) -> None:
        about = about_in(content)
        if self.about is not None and about != self.about:
            raise InputError(
                f"this is telemetry of two laws, certificates {self.about.certificate[:8]} and "
                f"{about.certificate[:8]}, or of one with other settings: record each in a file of its own"
            )
        self.about = about

    def _samples(self, data: Bytes, at: Indices) -> Samples:
        body = at + HEAD
        status = number(data, body + 8, 1)
        starts, stamps = self._follow(
            number(data, at + 4, 2), number(data, body, 4), status, number(data, body + 9, 2)
        )
        counts = (number(data, at + 3, 1) - FIXED) // EACH
        place = np.arange(counts.sum()) - np.repeat(np.cumsum(counts) - counts, counts)
        each = np.repeat(body + FIXED, counts) + EACH * place
        return Samples(
            np.repeat(starts, counts),
            np.repeat(stamps, counts),
            place,
            np.repeat(signed(data, body + 4, 4), counts) + signed(data, each, 2),
            signed(data, each + 2, 2),
            np.repeat(status & ~FIRST, counts),
        )

    def _follow(
        self, sequence: Indices, stamp: Indices, status: Indices, dropped: Indices
    ) -> tuple[Indices, Indices]:
        """Which start each packet belongs to, and when it was; what is missing is counted."""
        if not stamp.size:
            return stamp, stamp
        self.packets += int(stamp.size)
        before = self._before or (int(sequence[0]) - 1, int(stamp[0]), int(dropped[0]), int(stamp[0]))
        passed = np.diff(stamp, prepend=before[1]) & 0xFFFFFFFF
        anew = ((status & FIRST) > 0) | (passed >= 1 << 31)
        anew[0] &= self._before is not None
        self.lost += int((np.diff(sequence, prepend=before[0]) - 1 & 0xFFFF)[~anew].sum())
        more = np.diff(dropped, prepend=before[2]) & 0xFFFF
        self.dropped += int(np.where(anew, dropped, more).sum())
        along = np.cumsum(np.where(anew, 0, passed)) + before[3]
        begins = np.maximum.accumulate(np.where(anew, np.arange(stamp.size), -1))
        since = np.where(begins >= 0, along - along[begins] + stamp[begins], along)
        starts = self._start + np.cumsum(anew)
        self._start = int(starts[-1])
        self._before = (int(sequence[-1]), int(stamp[-1]), int(dropped[-1]), int(since[-1]))
        return starts, since


# Packets in a stream of bytes: found by their first two bytes and their checksum, whatever stands between.
#
#     'z' 'W'   kind   n   sequence, uint16   n bytes   CRC-16          numbers little-endian
#
# The checksum is the CRC-16 of ITU-T V.41, polynomial 0x1021, begun with ones, of all bytes before it.
# Within a packet nothing is looked for.  Layout: firmware/mains/shared/telemetry.h.

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


class Found(NamedTuple):
    starts: Indices
    sizes: Indices
    """In bytes, all of a packet."""
    rest: int
    """From where on the bytes belong to packets of which the end is still to come."""


def find(data: Bytes, *, last: bool) -> Found:
    """Every whole packet, in order; `last` says that nothing more comes: what has no end is no packet."""
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
    kept, end, held = np.zeros(syncs.size, dtype=bool), 0, data.tobytes()
    for k, (start, size) in enumerate(zip(syncs.tolist(), sizes.tolist(), strict=True)):
        # what begins within the one before are bytes of that packet which look like another one
        if start >= end and _is_right(held[start : start + size]):
            kept[k], end = True, start + size
    begun = begun[begun >= end]
    rest = data.size
    if not last and begun.size:
        rest = int(begun.min())
    elif not last and data.size > end and data[-1] == SYNC[0]:
        rest = data.size - 1
    return Found(syncs[kept], sizes[kept], rest)


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


def _is_right(packet: bytes) -> bool:
    """Whether a packet has the right checksum."""
    return crc_hqx(packet[:-END], 0xFFFF) == int.from_bytes(packet[-END:], "little")


# What a law tells of itself: the text of a packet, its numbers as they stand in the law's header.
#
#     zwidth telemetry 1
#     period_s 0.001
#     resolution 2.24e-05
#     force_per_unit 1.0
#     force_most 5.0
#     certificate 9f86d0…
#
# One byte of flags stands before it: 1, positions are in rad; 2, forces are sent as whole units of the law.
# Otherwise one unit of a force that is sent is ``force_most / 32767``.

FORMAT = "zwidth telemetry 1"

_ROTARY, _EXACT = 1, 2
_NUMBERS = ("period_s", "resolution", "force_per_unit", "force_most")


@dataclass(frozen=True, kw_only=True)
class About:
    motion: Literal["linear", "rotary"]
    period: float
    """T [s]."""
    resolution: float
    """Of a count [m; rad]."""
    force_unit: float
    """Of a force that is sent [N; N·m]."""
    force_most: float
    """Largest force that can be sent [N; N·m]."""
    certificate: str
    """SHA-256 of the law's certificate."""


def about_in(content: bytes) -> About:
    flags, text = content[0], content[1:].decode("ascii", "replace")
    first, *lines = text.splitlines() or [""]
    if first != FORMAT:
        raise InputError(
            f'this telemetry says it is "{first}", and "{FORMAT}" is read; use the zwidth of its law'
        )
    said = dict(line.partition(" ")[::2] for line in lines)
    try:
        period, resolution, unit, most = (float(said[name]) for name in _NUMBERS)
        positive = min(period, resolution, unit, most) > 0
    except (KeyError, ValueError):
        positive = False
    if not positive:
        raise InputError(
            f"the telemetry must state {', '.join(_NUMBERS)} as numbers > 0, got {text!r}: "
            "check what law.h defines"
        )
    return About(
        motion="rotary" if flags & _ROTARY else "linear",
        period=period,
        resolution=resolution,
        force_unit=unit if flags & _EXACT else most / 32767,
        force_most=most,
        certificate=said.get("certificate", ""),
    )


PIECE = 2**17


def is_telemetry(start: bytes) -> bool:
    """Whether there is a whole packet among the first bytes of a file."""
    if SYNC not in start:
        return False
    decoder = Decoder()
    try:
        return bool(decoder.take(start, last=True).size or decoder.about is not None)
    except InputError:
        return True  # of another version: who reads it says so


def telemetry_table(path: Path) -> Table:
    """The table of a file of telemetry; its columns are known by what they are called."""
    about = about_of(path)
    position, force = COLUMNS[about.motion]
    resolution = "resolution_m" if about.motion == "linear" else "resolution_rad"
    table = Table(
        source=str(path),
        units={"time_s": None, position: None, force: None},
        read=lambda names: _read(path, about, names, table.notes),
        attributes={
            "motion": about.motion,
            resolution: about.resolution,
            "certificate_sha256": about.certificate,
        },
        means={"time": "time_s", "position": position, "hand_force": None, "actuator_force": force},
    )
    return table


def about_of(path: Path) -> About:
    """What the first text of a file says."""
    decoder = Decoder()
    for _ in samples_of(path, decoder):
        if decoder.about is not None:
            break
    if decoder.about is None:
        raise InputError(
            f"{path} holds {decoder.packets} packets of telemetry and none that says what their numbers are: "
            "it comes every 64 packets, about once a second at 1 kHz; record for longer"
        )
    return decoder.about


def samples_of(path: Path, decoder: Decoder) -> Iterator[Samples]:
    """The samples of a file, piece by piece; the last piece may be empty."""
    with open(path, "rb") as file:
        while data := file.read(PIECE):
            yield decoder.take(data)
    yield decoder.take(b"", last=True)


def findings(decoder: Decoder) -> Iterator[Finding]:
    if decoder.lost:
        text = (
            f"{decoder.lost} packets are missing, and {decoder.damaged} stretches of the file are no packet"
        )
        yield Finding(kind="packets lost", text=text)
    if decoder.dropped:
        text = f"{decoder.dropped} samples were not sent: the line was too slow for them"
        yield Finding(kind="samples dropped", text=text, samples=decoder.dropped)


def _read(
    path: Path, about: About, names: tuple[str, ...], notes: dict[str, Finding]
) -> Iterator[tuple[Values, ...]]:
    decoder = Decoder()
    position, force = COLUMNS[about.motion]
    for samples in samples_of(path, decoder):
        if samples.size:
            columns = {
                "time_s": samples.time(about),
                position: samples.position(about),
                force: samples.given(about),
            }
            yield tuple(columns[name] for name in names)
    notes.update((finding.kind, finding) for finding in findings(decoder))
