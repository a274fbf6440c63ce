"""What carries datagrams between two processes, what a datagram holds, and a channel made worse on purpose.

A channel may lose, delay, double and reorder what it is given; it never waits, and it never
fails because the other side is not there yet, or no longer.  The waves that cross it
bear all of that without creating energy, so nothing is sent twice and nothing is waited for.

    "zw" 2 0 | sent | echo | held | packet, or nothing | CRC-32        (little-endian)

`sent` is the sender's clock, `echo` the newest `sent` that it has received and `held` how long it has kept
that: now − echo − held is the round trip, whatever the two clocks say.  Which runs of the two ends a packet
is from and for it says itself, see `zwidth.links.Packet`.  A datagram that is cut, mixed, foreign, of
another version or holds a number that is none (NaN, infinity) is not a frame, and is dropped.
"""

from __future__ import annotations

import heapq
import math
import random
import struct
import time
import zlib
from abc import abstractmethod
from collections.abc import Callable
from itertools import count
from typing import NamedTuple

from zwidth.errors import InputError
from zwidth.links import Packet, Schedule
from zwidth.machine.servo.connection import Closing

LARGEST = 1400
"""Bytes of a datagram that pass every usual network in one piece."""


class Channel(Closing):
    """Both directions between two ends; closed by `close` or at the end of a ``with``."""

    @abstractmethod
    def send(self, datagram: bytes) -> None:
        """Give one datagram on its way; it may be lost."""

    @abstractmethod
    def receive(self) -> list[bytes]:
        """What has arrived since the last call, in the order of arrival; empty where nothing has."""

    @abstractmethod
    def close(self) -> None:
        """Give back what the system lent; a second time does nothing."""


_HEAD = struct.Struct("<4sddd")
_MARK = b"zw\x02\x00"
_SUM = struct.Struct("<I")
_SIZES = [_HEAD.size + _SUM.size, _HEAD.size + Packet._SIZE + _SUM.size]


class Frame(NamedTuple):
    """One message: a packet, or None of a call, and the three times [s]."""

    packet: Packet | None
    sent: float = 0.0
    echo: float = math.nan
    """NaN where nothing has been received yet."""
    held: float = 0.0

    def to_bytes(self) -> bytes:
        """The datagram; of the same numbers always the same bytes."""
        body = _HEAD.pack(_MARK, self.sent, self.echo, self.held)
        body += b"" if self.packet is None else self.packet.to_bytes()
        return body + _SUM.pack(zlib.crc32(body))

    @classmethod
    def from_bytes(cls, datagram: bytes) -> Frame | None:
        """The frame, or None of what is none."""
        if len(datagram) not in _SIZES:
            return None
        body = datagram[: -_SUM.size]
        if _SUM.unpack(datagram[-_SUM.size :])[0] != zlib.crc32(body):
            return None
        mark, sent, echo, held = _HEAD.unpack_from(body)
        if mark != _MARK or not (math.isfinite(sent) and math.isfinite(held)):
            return None
        try:
            packet = Packet.from_bytes(body[_HEAD.size :]) if len(body) > _HEAD.size else None
        except InputError:
            return None
        return cls(packet, sent, echo, held)

    @staticmethod
    def is_of_another_version(datagram: bytes) -> bool:
        """True of what begins as a frame does, with the number of another version."""
        return datagram[:2] == _MARK[:2] and datagram[2:4] != _MARK[2:] and len(datagram) > _HEAD.size


class Lossy(Channel):
    """Delays, loses and doubles what is sent through another channel; so also the order changes.

    Parameters
    ----------
    channel
        What really carries the datagrams.
    schedule
        Delay, jitter, loss in bursts, duplicates and the seed of the draws.
    way
        0 at one end, 1 at the other: each way is drawn by itself.
    clock
        What tells the time [s].
    """

    def __init__(
        self,
        channel: Channel,
        schedule: Schedule,
        *,
        way: int = 0,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._channel, self._clock, self._order = channel, clock, count()
        self._random = random.Random(2 * schedule.seed + way)
        self._delay, self._jitter = float(schedule.delay), float(schedule.jitter)
        self._twice = float(schedule.duplicates)
        self._lost = schedule.losses(iter(self._random.random, None))
        self._waiting: list[tuple[float, int, bytes]] = []

    def send(self, datagram: bytes) -> None:
        """Lose it, or keep it until its time has come."""
        if not next(self._lost):
            draw = self._random.random
            for _ in range(2 if draw() < self._twice else 1):
                due = self._clock() + self._delay + self._jitter * draw()
                heapq.heappush(self._waiting, (due, next(self._order), datagram))
        self._forward()

    def receive(self) -> list[bytes]:
        """What has arrived at this end; what is due of the other direction goes on its way."""
        self._forward()
        return self._channel.receive()

    def _forward(self) -> None:
        now = self._clock()
        while self._waiting and self._waiting[0][0] <= now:
            self._channel.send(heapq.heappop(self._waiting)[2])

    def close(self) -> None:
        """Close what carries; what still waits is lost."""
        self._channel.close()
