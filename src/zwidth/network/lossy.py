"""A channel made worse on purpose: what a bad network does, drawn at random from a seed."""

from __future__ import annotations

import heapq
import random
import time
from collections.abc import Callable
from itertools import count

from zwidth.errors import InputError
from zwidth.network.channel import Channel


class Lossy(Channel):
    """Delays, loses and doubles what is sent through another channel; so also the order changes.

    Parameters
    ----------
    channel
        What really carries the datagrams.
    delay, jitter
        Each datagram waits `delay` and a random part of `jitter` [s].
    loss, doubled
        The share that is lost, and the share of the rest that is sent twice, 0 to 1.
    seed
        Of the draws.
    clock
        What tells the time [s].

    Raises
    ------
    InputError
        If a time is negative or a share not between 0 and 1.
    """

    def __init__(
        self,
        channel: Channel,
        *,
        delay: float = 0.0,
        jitter: float = 0.0,
        loss: float = 0.0,
        doubled: float = 0.0,
        seed: int = 0,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        for name, seconds in (("delay", delay), ("jitter", jitter)):
            if not 0 <= seconds < float("inf"):
                raise InputError(f"the {name} of a link must be ≥ 0 s, got {seconds!r}")
        for name, share in (("loss", loss), ("doubled", doubled)):
            if not 0 <= share <= 1:
                raise InputError(f"the share {name} of a link must be from 0 to 1, got {share!r}")
        self._channel, self._clock = channel, clock
        self._delay, self._jitter, self._loss, self._doubled = delay, jitter, loss, doubled
        self._random, self._order = random.Random(seed), count()
        self._waiting: list[tuple[float, int, bytes]] = []

    def send(self, datagram: bytes) -> None:
        """Lose it, or keep it until its time has come."""
        if self._random.random() >= self._loss:
            for _ in range(2 if self._random.random() < self._doubled else 1):
                due = self._clock() + self._delay + self._jitter * self._random.random()
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
