"""A real device at one end of a line: measured, moved by the waves that have come, and let go at a fault.

Each step takes a reading, books the way since the last one with the force that acted over it, hears, and has
the port's next force.  What the port promises rests on three things that are kept here:

    a force acts from a reading to the next: the force of a step is given at the reading that it is to act
    from, `delay` samples later, right after that reading has come;
    a period is no longer than the port supposes: its T is `longest_period`, and steps that took longer are
    counted, for in them friction may have taken less than the port has booked;
    the force given is the force booked: the limit of the force is the port's own.

At a fault the force ends for good, as in a served loop, and nothing is sent any more: the other end feels a
line that fell silent.
"""

from __future__ import annotations

import atexit
from collections import deque
from collections.abc import Iterable, Mapping
from dataclasses import replace
from math import nan

from zwidth.errors import InputError
from zwidth.links import Packet
from zwidth.links.port import Port
from zwidth.machine.servo.connection import (
    CLOSED,
    GOOD,
    REFUSED,
    Axis,
    CompiledConnection,
    LibraryConnection,
    Placement,
)
from zwidth.machine.servo.posix import ANSWERED, check_supported, now
from zwidth.machine.servo.report import PortReport, ending
from zwidth.machine.servo.safety import (
    ASKED,
    BAD_ANSWER,
    DONE,
    NO_NUMBER,
    RUNNING,
    Limits,
    Safety,
    bad_in_a_row,
    find_judging,
    judged_answer,
    judged_gap,
    judged_reading,
    limits_of,
)
from zwidth.quantity.exact import Exact, RealLike
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.parameter import read_number
from zwidth.quantity.text import shown

_LONGER = Exact("1.2")
"""By default a period may be longer than T so many times."""

_NO_LIMIT = 1e300
"""Of `Limits`."""


class PortRun:
    """A device that a person holds and a port drives; what `zwidth.network.Peer` steps.

    Parameters
    ----------
    port
        Of `zwidth.links`, with the device; its delay is the whole samples that a force waits, at least one.
    connection
        How the device is reached, see `servo.devices`.
    line
        The name of the line that ends here.
    safety
        Limits; `slew` cannot be one of them, for the port books the force that it asks for.
    placement
        Which way along the device's axis x goes.
    longest_period
        Of which the port keeps account [s]; None: 1.2 T.

    Raises
    ------
    InputError
        If these do not go together.
    """

    def __init__(
        self,
        port: Port,
        connection: CompiledConnection | LibraryConnection,
        line: str,
        *,
        safety: Safety | None = None,
        placement: Placement | None = None,
        longest_period: RealLike | None = None,
    ) -> None:
        check_supported()
        device = port.device
        period = device.exact("sample_period")
        if connection.motion != device.motion:
            raise InputError(
                f"the port drives a {device.motion} device, and the connection is {connection.motion}; "
                "describe the device as its connection measures it"
            )
        waits = int(device.exact("delay") / period)  # whole periods: the port has seen to that
        simulated = connection.samples is not None
        if not simulated and waits < max(connection.late, 1):
            raise InputError(
                f"delay must be ≥ {shown(Exact(max(connection.late, 1) * period), 's')}, got "
                f"{shown(device.delay, 's')}: between a reading and the force computed of it the device "
                "moves; a force that is kept until the next reading acts over whole periods"
            )
        longest = _longest(longest_period, Exact(period))
        self.safety = safety or Safety()
        if self.safety.slew is not None:
            raise InputError(
                "a port's force has no limit of its change: it books the force that it asks for; leave out "
                "slew, and give the port smoothing"
            )
        limits = limits_of(self.safety, device, float(period))
        supposed = device.replace(
            sample_period=longest,
            delay=waits * longest.fraction,
            force_limit=Exact(limits.force) if limits.force < _NO_LIMIT else None,
        )
        self.port, self.line = replace(port, device=supposed), line
        self._limits: Limits = limits
        self._longest = float(longest)
        self._kept: deque[float] = deque([0.0] * (0 if simulated else waits - connection.late))
        self.port.warm()
        find_judging()
        self.connection, self.placement = connection, placement or Placement()
        self._period = float(period)
        self._axis: Axis | None = None
        self._reason = RUNNING
        self._message = ""
        self._k = self._samples = self._held = self._later = 0
        self._bad = 0.0
        self._before: tuple[int, int, float] | None = None
        self._moving = False

    @property
    def lines(self) -> tuple[str, ...]:
        """The one that ends here."""
        return (self.line,)

    @property
    def forces(self) -> dict[str, float]:
        """What the line gives the device in the last sample [N; N·m]."""
        return {self.line: self.port.force if self._reason == RUNNING and self._moving else 0.0}

    @property
    def ended(self) -> str:
        """Why the force ended; "" while it has not."""
        return self._message or ending(self._reason)

    @property
    def failed(self) -> bool:
        """True where the force ended by itself, not because somebody asked."""
        return self._reason not in (RUNNING, ASKED, DONE)

    def reach(self) -> None:
        """Reach the device, force 0; the first step does, where nobody has before.

        Raises
        ------
        InputError
            If there is no such port or device, or it does not answer as it should.
        """
        if self._axis is None:
            self._axis = Axis(self.connection, self.placement, self._period)
            atexit.register(self.close)

    def step(self, heard: Mapping[str, Iterable[Packet]] | None = None) -> dict[str, Packet]:
        """Measure, book and send what the last period was, hear, and give the force that is due.

        Nothing is sent at the first step, at one without a good answer, and after the end.

        Raises
        ------
        InputError
            As `reach`.
        """
        if self._reason != RUNNING:
            return {}
        self.reach()
        assert self._axis is not None
        k, at = self._k, now()
        self._k += 1
        status, x = self._axis.measure(k, at + int(ANSWERED * 1e9 * self._period))
        self._look(status, x, k, at)
        if self._reason != RUNNING:
            self.end(self._reason)
            return {}
        if status != GOOD:
            self._held += 1
            return {}
        return self._go_on(self._axis, (heard or {}).get(self.line, ()), x, k, at)

    def _go_on(self, axis: Axis, packets: Iterable[Packet], x: float, k: int, at: int) -> dict[str, Packet]:
        """Of a good reading."""
        sent: dict[str, Packet] = {}
        try:
            if self._before is not None:
                _, began, there = self._before
                self._later += (at - began) * 1e-9 > self._longest
                sent = {self.line: self.port.send(x - there)}
            wish = self.port.receive(packets)
        except InputError as error:  # a reading that the port has no law for
            self._message = f"ended, since {error}"
            self.end(NO_NUMBER)
            return {}
        self._moving = True
        self._kept.append(wish)
        given = axis.give(self._kept.popleft())
        if given in (CLOSED, REFUSED):
            self.end(BAD_ANSWER + given)
        self._before = k, at, x
        self._samples += 1
        return sent

    def _look(self, status: int, x: float, k: int, at: int) -> None:
        """Whether the force has to end: as in a served loop, see `servo.safety`."""
        limits, there, periods = self._limits, nan, 1.0
        if self._before is not None:
            number, began, there = self._before
            since = (at - began) * 1e-9
            self._reason = judged_gap(since, limits.gap)
            periods = max(float(k - number), since / self._period)  # late steps follow at once
        self._bad = bad_in_a_row(status, self._bad)
        self._reason = self._reason or judged_answer(status, self._bad, limits.bad_answers)
        if status == GOOD:
            self._reason = self._reason or judged_reading(x, there, limits.jump * periods)

    def end(self, reason: int = ASKED) -> None:
        """Force 0 for good, and no packet after it."""
        if self._reason == RUNNING:
            self._reason = reason
        if self._axis is not None:
            self._axis.let_go()

    def close(self) -> None:
        """Force 0, then the device is let go; may be called again."""
        atexit.unregister(self.close)
        if self._axis is None:
            return
        if self._reason == RUNNING:
            self.end()
        self._axis.close()

    def report(self) -> PortReport:
        """What happened so far."""
        connection = self.connection
        return PortReport(
            connection.describe(), self.ended, self._samples, self._held, self._later, connection.met_hardware
        )


def _longest(given: RealLike | None, period: Exact) -> Exact:
    if given is None:
        return Exact(_LONGER.fraction * period.fraction)
    longest: Exact = read_number(
        given, GLOSSARY["sample_period"], "longest_period", bound="> 0", why="a step takes time"
    )
    if longest.fraction < period.fraction:
        raise InputError(
            f"longest_period must be ≥ {shown(period, 's')}, the sample period, got {shown(longest, 's')}: "
            "friction takes less in a longer period, and the port may count on no more than it takes"
        )
    return longest
