"""Is this machine fit to run the loop: how late it is, what that costs in stiffness, and what to change."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from typing import Any, ClassVar

from zwidth.errors import InputError
from zwidth.machine.servo.cost import StiffnessCost, stiffness_cost
from zwidth.machine.servo.lateness import Lateness, measure_lateness
from zwidth.machine.servo.machine import Finding, Moment, findings
from zwidth.machine.servo.priority import Granted
from zwidth.model.device import Device
from zwidth.model.environment import Wall
from zwidth.model.environment.environment import Environment
from zwidth.progress import progress_bar
from zwidth.quantity.documented import Documented
from zwidth.quantity.exact import Exact, RealLike
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.parameter import read_number
from zwidth.quantity.text import shown
from zwidth.showing import Lines, Part, Table

_DEFAULT_PERIOD = Exact("0.001")
_LEAST_PERIOD = 20e-6
"""Below it the clock and the sleep alone take a good part of the period [s]."""

_FEWEST = 1000
"""Steps, so that one in a thousand is one at least."""

_SHARE = 0.999
"""Of the steps begin within the lateness whose cost is told."""


@dataclass(frozen=True, repr=False)
class Checkup(Documented):
    """How this machine does as the host of a periodic loop."""

    FORMAT: ClassVar[str] = "zwidth doctor 1"
    PICTURE: ClassVar[str] = "plot_lateness"

    sample_period: Exact
    ordinary: Lateness
    real_time: Lateness | None
    """None where real-time priority was refused."""
    asked: Granted
    """What a loop asks of the system here, and what became of it."""
    findings: tuple[Finding, ...]
    device: str | None = None
    cost: StiffnessCost | None = None
    """None where no device was given."""

    @property
    def best(self) -> Lateness:
        """Of the loop as it would be served here: with real-time priority where that is granted."""
        return self.real_time or self.ordinary

    def to_dict(self) -> dict[str, Any]:
        """Everything, a unit in every key of a physical quantity."""
        return {
            "format": self.FORMAT,
            "sample_period_s": self.sample_period,
            "ordinary": self.ordinary.to_dict(),
            "real_time": None if self.real_time is None else self.real_time.to_dict(),
            "asked": self.asked.to_dict(),
            "device": self.device,
            "cost": None if self.cost is None else self.cost.to_dict(),
            "findings": [finding.to_dict() for finding in self.findings],
        }

    def report(self) -> Iterable[Part]:
        """The lateness of both kinds of turns, what it costs, what was found, what to change."""
        yield from self._late()
        yield Lines([f"{one.about}: {one.told}" for one in self.findings])
        yield from self._to_change()

    def in_short(self) -> Iterable[Part]:
        """The same without what was found."""
        yield from self._late()
        yield from self._to_change()

    def _late(self) -> Iterator[Part]:
        kinds = {"ordinary thread": self.ordinary}
        if self.real_time is not None:
            kinds["real-time priority"] = self.real_time
        heads = [("late by [ms]", "50 %", "99 %", "99.9 %", "worst", "missed", "steps")]
        rows = [(name, *_row(lateness)) for name, lateness in kinds.items()]
        yield f"a loop at {shown(Exact(1 / self.sample_period.fraction), 'Hz')}, without a device"
        yield Table(heads=heads, rows=rows, lefts=1)
        if self.real_time is None:
            yield f"real-time priority was not granted: {self.asked['priority'].told}"
        if self.cost is not None:
            yield f"what the 99.9 % cost {self.device}:"
            yield self.cost.table()

    def _to_change(self) -> Iterator[Part]:
        advice = [f"{one.about}: {one.advice}" for one in self.findings if one.advice]
        yield f"what to change: {'nothing that was found' if not advice else ''}".rstrip()
        yield Lines(advice)


def _row(lateness: Lateness) -> tuple[str, ...]:
    values = (*(lateness.quantile(share) for share in (0.5, 0.99, _SHARE)), lateness.worst)
    return (*(f"{1e3 * value:.3g}" for value in values), str(lateness.missed), str(len(lateness.late)))


def doctor(
    device: Device | None = None,
    environment: Environment | None = None,
    *,
    duration: RealLike = 60,
    sample_period: RealLike | None = None,
    core: int | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Checkup:
    """Run a loop that does nothing but be on time, and say how late it was, what that costs, and what helps.

    Parameters
    ----------
    device, environment
        Of which to say what the lateness costs in stiffness; without an environment a spring.
    duration
        How long [s]: half of it with real-time priority, where that is granted, in turns of a few seconds.
    sample_period
        T ≥ 20e-6 [s]; by default that of the device, or 1 ms.
    core
        Number of the core that the loop keeps to; None for any.
    progress
        Is told (seconds done, in all); by default a bar on standard error.

    Raises
    ------
    InputError
        If the period is too short, the duration shorter than 1000 periods, the law has no stiffness, there is
        no such core, or the system is none of POSIX.
    """
    period = _period(sample_period, device)
    seconds = read_number(duration, GLOSSARY["sample_period"], "duration", bound="> 0", why="0 has no step")
    if seconds.fraction < _FEWEST * period.fraction:
        raise InputError(
            f"duration must be ≥ {shown(Exact(_FEWEST * period.fraction), 's')}, got {shown(seconds, 's')}: "
            f"one step in {_FEWEST} is told, and a period is {shown(period, 's')}"
        )
    law = None
    if device is not None:
        device = device.replace(sample_period=period)
        law = environment or Wall(stiffness=1)
        stiffness_cost(device, law, 0.0)  # what it cannot be told of is refused before the wait
    elif environment is not None:
        raise InputError("what lateness costs an environment depends on the device: give one as well")
    before = Moment.now()
    if progress is None:
        with progress_bar("seconds") as bar:
            measured = measure_lateness(float(period), float(seconds), core=core, progress=bar)
    else:
        measured = measure_lateness(float(period), float(seconds), core=core, progress=progress)
    best = measured.real_time or measured.ordinary
    return Checkup(
        period,
        *measured,
        findings=tuple(findings(measured.asked, before)),
        device=None if device is None else device.name,
        cost=None if law is None or device is None else stiffness_cost(device, law, best.quantile(_SHARE)),
    )


def _period(given: RealLike | None, device: Device | None) -> Exact:
    value = given if given is not None else _DEFAULT_PERIOD
    if given is None and device is not None:
        value = Exact(device.exact("sample_period"))
    period: Exact = read_number(
        value, GLOSSARY["sample_period"], "sample_period", bound="> 0", why="a step takes time"
    )
    if period < _LEAST_PERIOD:
        raise InputError(
            f"sample_period must be ≥ {shown(_LEAST_PERIOD, 's')}, got {shown(period, 's')}: to sleep and to "
            "read the clock takes a good part of a shorter one"
        )
    return period
