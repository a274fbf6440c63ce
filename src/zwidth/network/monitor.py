"""One link, watched: how many packets, how old, how many lost, and how much energy went each way.

A packet tells all the energy that its side has sent so far: what one side has heard of is never more than
what the other has sent, or the link is no link.
"""

from __future__ import annotations

import math
import secrets
import time
from collections import deque
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any, ClassVar

from zwidth.errors import InputError
from zwidth.links import Packet
from zwidth.network.channel import Channel
from zwidth.network.frame import Frame
from zwidth.quantity.text import shown
from zwidth.showing import Part, Shown, Table

_REMEMBERED = 4096
"""Round trips kept for the shares of the report."""

_SILENT = 0.5
"""What is worth a word [s]."""

WINDOW = 4096
"""A frame this much older than the newest is dropped: that it was not used yet can no longer be known."""


@dataclass(frozen=True, repr=False)
class LinkReport(Shown):
    """What was seen of a link from one side."""

    sent: int
    """Packets sent."""
    received: int
    """Packets received, each counted once."""
    lost: int
    """Numbers between the first and the newest received that did not come."""
    doubled: int
    late: int
    """Packets that came after a younger one."""
    foreign: int
    """Datagrams that were none of a port."""
    rate: float
    """Packets received per second since the first."""
    round_trip: tuple[float, float, float]
    """Median, 99 % and longest round trip [s]; NaN before the first echo."""
    energy_sent: float
    """That this side has sent in all [J]."""
    energy_received: float
    """That the other side has sent in all, as far as this one has heard [J]."""
    silent: float
    """Since the last packet came [s]; infinite before the first."""

    def report(self) -> Iterable[Part]:
        """Six lines."""
        yield Table(rows=self.rows())

    HEADS: ClassVar = ["line", "sent", "received", "lost", "there and back, 99 %", "energy out", "energy in"]

    def to_dict(self) -> dict[str, Any]:
        """The same with a unit in every key; null where there is none yet."""
        p50, p99, most = (t if math.isfinite(t) else None for t in self.round_trip)
        return {
            "sent": self.sent,
            "received": self.received,
            "lost": self.lost,
            "doubled": self.doubled,
            "late": self.late,
            "foreign": self.foreign,
            "rate_Hz": self.rate,
            "round_trip_s": {"median": p50, "of_99_percent": p99, "longest": most},
            "energy_sent_J": self.energy_sent,
            "energy_received_J": self.energy_received,
            "silent_s": self.silent if math.isfinite(self.silent) else None,
        }

    def row(self, name: str) -> list[str]:
        """One row of a table of links."""
        energies = (shown(e, "J") for e in (self.energy_sent, self.energy_received))
        return [name, str(self.sent), str(self.received), self._share, self._trips, *energies]

    @property
    def _share(self) -> str:
        return f"{100 * self.lost / max(self.lost + self.received, 1):.2g} %"

    @property
    def _trips(self) -> str:
        if math.isnan(self.round_trip[0]):
            return "—"
        return ", ".join(f"{1e3 * t:.3g}" for t in self.round_trip[:2]) + " ms"

    @property
    def brief(self) -> str:
        """In a few words."""
        if not self.received:
            return "nothing has come"
        waiting = f", silent for {self.silent:.2g} s" if self.silent > _SILENT else ""
        echoed = math.isfinite(self.round_trip[0])
        trip = f", {1e3 * self.round_trip[0]:.3g} ms there and back" if echoed else ""
        return f"{self.rate:.4g} per second, {self._share} lost{trip}{waiting}"

    def rows(self) -> list[list[str]]:
        return [
            ["packets", f"{self.sent} sent, {self.received} received, {self.rate:.4g} per second"],
            ["lost", f"{self.lost} ({self._share}), {self.doubled} twice, {self.late} late"],
            ["foreign", f"{self.foreign} datagrams"],
            ["there and back", f"{self._trips}: median, 99 %"],
            ["energy", f"{shown(self.energy_sent, 'J')} sent, {shown(self.energy_received, 'J')} received"],
            ["silent", f"for {self.silent:.3g} s" if self.received else "from the start"],
        ]


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
        self._run, self._other = secrets.randbelow(2**32 - 1) + 1, 0
        self._sent = 0
        self._called = False
        self._newest = -1
        self._first = -1
        self._seen: set[int] = set()
        self._came: tuple[float, float] | None = None
        self._began = math.nan
        self._received = self._doubled = self._late = self._foreign = 0
        self._in = self._out = 0.0
        self._trips: deque[float] = deque(maxlen=_REMEMBERED)

    def send(self, packet: Packet) -> None:
        """Send a packet of a port."""
        now = self._clock()
        echo, held = (self._came[0], now - self._came[1]) if self._came else (math.nan, 0.0)
        values = (packet.wave, packet.energy, packet.position)
        frame = Frame(packet.number, values, now, echo, held, self._run, self._other)
        self.channel.send(frame.to_bytes())
        self._sent += 1
        self._out = packet.energy

    def call(self) -> bool:
        """Call the other side, with a frame that holds nothing; True once it was heard of."""
        if self.receive():
            self._called = True
        self.channel.send(Frame(0, (), self._clock(), run=self._run, to=self._other).to_bytes())
        return self._called

    def receive(self) -> list[Packet]:
        """The packets that have come since the last call, none a second time, in the order of arrival."""
        now = self._clock()
        return [packet for datagram in self.channel.receive() if (packet := self._taken(datagram, now))]

    def _is_meant(self, frame: Frame) -> bool:
        """False of what was sent to an earlier run of this side, or by one of the other side."""
        if frame.to == self._run or (frame.to == 0 and self._other == 0):
            self._other = frame.run
        return frame.to in (0, self._run) and frame.run == self._other

    def _taken(self, datagram: bytes, now: float) -> Packet | None:
        frame = Frame.from_bytes(datagram)
        if frame is not None and not self._is_meant(frame):
            self._foreign += 1
            return None
        if frame is not None and not frame.values:
            self._called = True
            return None
        packet = _packet(frame)
        if frame is None or packet is None:
            self._foreign += 1
            return None
        if frame.number in self._seen or frame.number <= self._newest - WINDOW:
            self._doubled += 1
            return None
        self._seen.add(frame.number)
        if frame.number < self._newest:
            self._late += 1
        else:
            self._newest = frame.number
            if len(self._seen) > 2 * WINDOW:
                self._seen = {n for n in self._seen if n > frame.number - WINDOW}
            self._came = (frame.sent, now)
            if math.isfinite(frame.echo):
                self._trips.append(now - frame.echo - frame.held)
        if self._first < 0:
            self._first, self._began = frame.number, now
        self._received += 1
        self._in = max(self._in, packet.energy)
        return packet

    def report(self) -> LinkReport:
        """What was seen so far."""
        now = self._clock()
        trips = sorted(self._trips)
        at = [trips[min(int(q * len(trips)), len(trips) - 1)] if trips else math.nan for q in (0.5, 0.99, 1)]
        span = self._newest - self._first + 1 if self._first >= 0 else 0
        return LinkReport(
            sent=self._sent,
            received=self._received,
            lost=max(span - self._received, 0),
            doubled=self._doubled,
            late=self._late,
            foreign=self._foreign,
            rate=self._received / (now - self._began) if now > self._began else 0.0,
            round_trip=(at[0], at[1], at[2]),
            energy_sent=self._out,
            energy_received=self._in,
            silent=now - self._came[1] if self._came else math.inf,
        )


def _packet(frame: Frame | None) -> Packet | None:
    """The packet of a port that a frame holds, or None."""
    if frame is None or len(frame.values) != 3:
        return None
    try:
        return Packet(frame.number, *frame.values)
    except InputError:
        return None
