"""One process of many: a part of a scene, or a device, stepped at its rate, its lines over channels.

What is late is made up for, so that every peer's time is that of the clock: of two ends whose times part
the slower one could not keep up a force.  A step uses what has come by then and waits for nothing.  What has
not come is a wave of zero: a peer that is gone is felt as a line that fell silent, whose force ends at zero.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any, Protocol

from zwidth.errors import InputError
from zwidth.links import Packet
from zwidth.machine.network.channel import Channel
from zwidth.machine.network.monitor import Link, LinkReport
from zwidth.quantity.exact import RealLike
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.parameter import read_number
from zwidth.showing import Part, Shown, Table

_CALL = 0.02
"""Between two calls to the other ends [s]."""

_SPIN = 2e-4
"""Slept is until so long before a deadline, the rest is waited out awake [s]."""


class Steps(Protocol):
    """What a peer runs: a `PartRun` or a `DeviceRun`."""

    @property
    def lines(self) -> tuple[str, ...]:
        """The names of the lines that end in it."""

    @property
    def forces(self) -> Mapping[str, float]:
        """What each line gives in the last step [N; N·m]."""

    def step(self, heard: Mapping[str, Iterable[Packet]] | None = None) -> dict[str, Packet]:
        """One step, from packets to packets."""


@dataclass(frozen=True, repr=False)
class PeerReport(Shown):
    """What a peer did."""

    steps: int
    late: int
    """Steps that began more than a period late; they follow at once, until the time is made up for."""
    lateness: tuple[float, float, float]
    """Median, 99 % and largest lateness of a step [s]."""
    links: Mapping[str, LinkReport]
    forces: Mapping[str, float]
    """What each line gave at last [N; N·m]."""

    def to_dict(self) -> dict[str, Any]:
        """The same with a unit in every key."""
        p50, p99, most = self.lateness
        return {
            "steps": self.steps,
            "late": self.late,
            "lateness_s": {"median": p50, "of_99_percent": p99, "largest": most},
            "links": {
                name: {**link.to_dict(), "last_force_N": self.forces[name]}
                for name, link in self.links.items()
            },
        }

    def report(self) -> Iterable[Part]:
        """The steps, then line by line."""
        p50, p99, most = (f"{1e3 * t:.2g}" for t in self.lateness)
        late = f"late by {p50} ms median, {p99} ms in 99 %, {most} ms at most"
        yield f"{self.steps} steps, {self.late} by more than a period too late; {late}"
        rows = [link.row(name) for name, link in self.links.items()]
        yield Table(heads=[LinkReport.HEADS], rows=rows, lefts=1)


class Peer:
    """A part or a device with its links.

    Parameters
    ----------
    runs
        What is stepped.
    channels
        Of each line that ends in it, by its name, what carries its packets.
    sample_period
        T > 0 [s].
    clock, sleep
        What tells and what passes the time [s].

    Raises
    ------
    InputError
        If a line has no channel, or a channel no line.
    """

    def __init__(
        self,
        runs: Steps,
        channels: Mapping[str, Channel],
        sample_period: RealLike,
        *,
        clock: Callable[[], float] = time.monotonic,
        sleep: Callable[[float], None] = time.sleep,
    ) -> None:
        if set(channels) != set(runs.lines):
            raise InputError(
                f"a channel is wanted for each of the lines {', '.join(runs.lines) or '(none)'}, "
                f"got {', '.join(channels) or 'none'}"
            )
        period = read_number(
            sample_period, GLOSSARY["sample_period"], "sample_period", bound="> 0", why="a step takes time"
        )
        self.runs, self.period, self._clock, self._sleep = runs, float(period), clock, sleep
        self._exactly = period.fraction
        self.links = {name: Link(channel, clock) for name, channel in channels.items()}

    def run(
        self,
        duration: RealLike,
        each: Callable[[int], None] | None = None,
        *,
        stop: Callable[[], bool] | None = None,
    ) -> PeerReport:
        """Step at the period's pace.

        Parameters
        ----------
        duration
            How long [s].
        each
            Called after each step with its number; what it takes is taken from the period.
        stop
            Asked before each step whether to end.
        """
        seconds = read_number(
            duration, GLOSSARY["sample_period"], "duration", bound="> 0", why="0 has no step"
        ).fraction
        lateness: list[float] = []
        late = 0
        deadline = self._clock()
        for k in range(int(seconds / self._exactly)):
            if stop is not None and stop():
                break
            self._until(deadline)
            behind = self._clock() - deadline
            lateness.append(behind)
            late += behind > self.period
            deadline += self.period
            self.step()
            if each is not None:
                each(k)
        ordered = sorted(lateness) or [0.0]
        at = [ordered[min(int(q * len(ordered)), len(ordered) - 1)] for q in (0.5, 0.99, 1)]
        links = {name: link.report() for name, link in self.links.items()}
        return PeerReport(len(lateness), late, (at[0], at[1], at[2]), links, dict(self.runs.forces))

    def meet(self, wait: float) -> tuple[str, ...]:
        """Call the other ends until all have been heard of; the lines where nobody was in that time [s]."""
        until = self._clock() + wait
        while True:
            silent = tuple(name for name, link in self.links.items() if not link.call())
            if not silent or self._clock() >= until:
                return silent
            self._sleep(_CALL)

    def step(self) -> None:
        """Hear, step, send."""
        packets = self.runs.step({name: link.receive() for name, link in self.links.items()})
        for name, packet in packets.items():
            self.links[name].send(packet)

    def _until(self, deadline: float) -> None:
        left = deadline - self._clock() - _SPIN
        if left > 0:
            self._sleep(left)
        while self._clock() < deadline:
            pass

    def close(self) -> None:
        """Close all channels."""
        for link in self.links.values():
            link.channel.close()
