"""A channel made worse on purpose: what a bad network does, drawn as a schedule says."""

from __future__ import annotations

import heapq
import random
import time
from collections.abc import Callable
from itertools import count

from zwidth.links import Schedule
from zwidth.machine.network.channel import Channel


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
