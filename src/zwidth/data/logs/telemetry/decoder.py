"""From the bytes of a line to samples: time and sequence go on where their counters begin anew.

    t_k = t_0 + k T         within a packet, t_0 its stamp
    x_k = (n_0 + d_k) q     n_0 the counts of the first sample, d_k how many more there are

Stamps are of 32 bits, in microseconds: they begin anew after 71.6 minutes.  A machine that was started anew
says so in its first packet; where that is lost, its stamp that goes back says it.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from zwidth.data.logs.telemetry.about import About, about_in
from zwidth.data.logs.telemetry.packets import (
    EACH,
    END,
    FIXED,
    HEAD,
    SAMPLES,
    TEXT,
    Bytes,
    Indices,
    find,
    number,
    signed,
)
from zwidth.errors import InputError

Array = NDArray[np.float64]

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
        """How many."""
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
        """The samples of all packets that are whole by now.

        Parameters
        ----------
        data
            What has come since.
        last
            Nothing more comes.
        """
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
        """Of the packets of samples that begin at these places."""
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
