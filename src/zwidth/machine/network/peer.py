"""One process of many: a part of a scene, or a device, stepped at its rate, its lines over channels.

What is late is made up for, so that every peer's time is that of the clock: of two ends whose times part
the slower one could not keep up a force.  A step uses what has come by then and waits for nothing.  What has
not come is a wave of zero: a peer that is gone is felt as a line that fell silent, whose force ends at zero.
"""

from __future__ import annotations

import math
import time
from collections import deque
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar, Protocol

from zwidth.errors import InputError
from zwidth.links import Packet
from zwidth.machine.network.channel import Channel, Frame
from zwidth.quantity.answered import answered
from zwidth.quantity.documented import Documented
from zwidth.quantity.exact import RealLike
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.parameter import read_number
from zwidth.quantity.text import shown
from zwidth.showing import Part, Table

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
class PeerReport(Documented):
    """What a peer did."""

    steps: int = answered("how many began")
    late: int = answered(
        "steps that began more than a period late; they follow at once, until the time is made up for"
    )
    lateness: tuple[float, float, float] = answered(
        "of a step", unit="s", names=("median", "of_99_percent", "largest")
    )
    links: Mapping[str, LinkReport] = answered("by name, what was seen of each")
    forces: Mapping[str, float] = answered("what each line gave at last [N; N·m]", only_shown=True)

    def to_dict(self) -> dict[str, Any]:
        """The same with a unit in every key."""
        forces = self.forces
        links = {name: {**link.to_dict(), "last_force_N": forces[name]} for name, link in self.links.items()}
        return {**super().to_dict(), "links": links}

    def report(self) -> Iterable[Part]:
        """The steps, then line by line."""
        p50, p99, most = (shown(t, "s", 2) for t in self.lateness)
        late = f"late by {p50} median, {p99} in 99 %, {most} at most"
        yield f"{self.steps} steps, {self.late} by more than a period too late; {late}"
        rows = [link.row(name) for name, link in self.links.items()]
        yield Table(heads=[LinkReport._HEADS], rows=rows, lefts=1)


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


# A link's packets tell all the energy that their side has sent so far to the run that they are meant for:
# what one side has heard of is never more than what the other has sent, or the link is no link.


_REMEMBERED = 4096
"""Round trips kept for the shares of the report."""

_SILENT = 0.5
"""What is worth a word [s]."""

_OTHER_VERSION = "another version of zwidth, which is not read: install one at both ends"

WINDOW = 4096
"""A frame this much older than the newest is dropped: that it was not used yet can no longer be known."""


@dataclass(frozen=True, repr=False)
class LinkReport(Documented):
    """What was seen of a link from one side; in plain data null before the first packet, or echo."""

    sent: int = answered("packets sent")
    received: int = answered("packets received, each counted once")
    lost: int = answered("numbers between the first and the newest received that did not come")
    doubled: int = answered("packets that came once more")
    late: int = answered("packets that came after a younger one")
    foreign: int = answered("datagrams that were none of a port")
    other_version: int = answered("of those, from another version of zwidth", key="of_another_version")
    rate: float = answered("packets received per second since the first", unit="Hz")
    round_trip: tuple[float, float, float] = answered(
        "there and back; not known before the first echo",
        unit="s",
        finite=True,
        names=("median", "of_99_percent", "longest"),
    )
    energy_sent: float = answered("that this side has sent in all", unit="J")
    energy_received: float = answered(
        "that the other side has sent to this run in all, as far as this one has heard", unit="J"
    )
    silent: float = answered("since the last packet came; null before the first", unit="s", finite=True)

    def report(self) -> Iterable[Part]:
        """Six lines."""
        yield Table(rows=self.rows())

    _HEADS: ClassVar = [
        "line",
        "sent",
        "received",
        "lost",
        "there and back, 99 %",
        "energy out",
        "energy in",
    ]

    def row(self, name: str) -> list[str]:
        """One row of a table of links."""
        energies = (shown(e, "J") for e in (self.energy_sent, self.energy_received))
        return [name, str(self.sent), str(self.received), self._share, self._trips, *energies]

    @property
    def _share(self) -> str:
        return shown(self.lost / max(self.lost + self.received, 1), "%", 2)

    @property
    def _trips(self) -> str:
        if math.isnan(self.round_trip[0]):
            return "—"
        return ", ".join(shown(t, "s", 3) for t in self.round_trip[:2])

    @property
    def brief(self) -> str:
        """In a few words."""
        if not self.received:
            return f"what comes is of {_OTHER_VERSION}" if self.other_version else "nothing has come"
        waiting = f", silent for {shown(self.silent, 's', 2)}" if self.silent > _SILENT else ""
        echoed = math.isfinite(self.round_trip[0])
        trip = f", {shown(self.round_trip[0], 's', 3)} there and back" if echoed else ""
        return f"{self.rate:.4g} per second, {self._share} lost{trip}{waiting}"

    def rows(self) -> list[list[str]]:
        more = f", {self.other_version} of {_OTHER_VERSION}" if self.other_version else ""
        return [
            ["packets", f"{self.sent} sent, {self.received} received, {self.rate:.4g} per second"],
            ["lost", f"{self.lost} ({self._share}), {self.doubled} twice, {self.late} late"],
            ["foreign", f"{self.foreign} datagrams{more}"],
            ["there and back", f"{self._trips}: median, 99 %"],
            ["energy", f"{shown(self.energy_sent, 'J')} sent, {shown(self.energy_received, 'J')} received"],
            ["silent", f"for {shown(self.silent, 's', 3)}" if self.received else "from the start"],
        ]


@dataclass
class _Run:
    """Of one run of the other side: first and newest number, those seen, and the energy for this side."""

    first: int
    newest: int = -1
    received: int = 0
    energy: float = 0.0
    seen: set[int] = field(default_factory=set)


class Link:
    """Packets over a channel: dated, each taken once, and counted.

    Parameters
    ----------
    channel
        What carries them.
    clock
        What tells the time [s].
    """

    def __init__(self, channel: Channel, clock: Callable[[], float] = time.monotonic) -> None:
        self.channel, self._clock = channel, clock
        self._run = self._sent = 0
        self._called = False
        self._runs: dict[int, _Run] = {}
        self._came: tuple[float, float] | None = None
        self._began = math.nan
        self._doubled = self._late = self._foreign = self._other_version = 0
        self._out: dict[int, float] = {}
        self._trips: deque[float] = deque(maxlen=_REMEMBERED)

    def send(self, packet: Packet) -> None:
        """Send a packet of a port."""
        now = self._clock()
        echo, held = (self._came[0], now - self._came[1]) if self._came else (math.nan, 0.0)
        self.channel.send(Frame(packet, now, echo, held).to_bytes())
        self._sent += 1
        self._run = packet.run
        self._out[packet.to] = packet.energy

    def call(self) -> bool:
        """Call the other side, with a frame that holds nothing; True once it was heard of."""
        if self.receive():
            self._called = True
        self.channel.send(Frame(None, self._clock()).to_bytes())
        return self._called

    def receive(self) -> list[Packet]:
        """The packets that have come since the last call, none a second time, in the order of arrival."""
        now = self._clock()
        return [packet for datagram in self.channel.receive() if (packet := self._taken(datagram, now))]

    def _taken(self, datagram: bytes, now: float) -> Packet | None:
        frame = Frame.from_bytes(datagram)
        if frame is None:
            self._foreign += 1
            self._other_version += Frame.is_of_another_version(datagram)
            return None
        packet = frame.packet
        if packet is None:
            self._called = True
            return None
        run = self._runs.setdefault(packet.run, _Run(packet.number))
        if packet.number in run.seen or packet.number <= run.newest - WINDOW:
            self._doubled += 1
            return None
        run.seen.add(packet.number)
        run.received += 1
        if packet.number < run.newest:
            self._late += 1
        else:
            run.newest = packet.number
            if len(run.seen) > 2 * WINDOW:
                run.seen = {n for n in run.seen if n > packet.number - WINDOW}
            self._came = (frame.sent, now)
            if packet.to == self._run and math.isfinite(frame.echo):
                self._trips.append(now - frame.echo - frame.held)
        if math.isnan(self._began):
            self._began = now
        if packet.to == self._run:
            run.energy = max(run.energy, packet.energy)
        return packet

    def report(self) -> LinkReport:
        """What was seen so far."""
        now = self._clock()
        trips = sorted(self._trips)
        at = [trips[min(int(q * len(trips)), len(trips) - 1)] if trips else math.nan for q in (0.5, 0.99, 1)]
        received = sum(run.received for run in self._runs.values())
        return LinkReport(
            sent=self._sent,
            received=received,
            lost=sum(max(run.newest - run.first + 1 - run.received, 0) for run in self._runs.values()),
            doubled=self._doubled,
            late=self._late,
            foreign=self._foreign,
            other_version=self._other_version,
            rate=received / (now - self._began) if now > self._began else 0.0,
            round_trip=(at[0], at[1], at[2]),
            energy_sent=sum(self._out.values()),
            energy_received=sum(run.energy for run in self._runs.values()),
            silent=now - self._came[1] if self._came else math.inf,
        )
