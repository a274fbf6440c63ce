"""What was served: a loop, a pair, a device at the end of a line; and why the force ended."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from zwidth.machine.servo import cycle
from zwidth.machine.servo.connection import STATUS, Connection
from zwidth.machine.servo.loop import Shared
from zwidth.machine.servo.priority import Granted
from zwidth.machine.servo.proving import Measured
from zwidth.machine.servo.ring import quantile
from zwidth.machine.servo.safety import ASKED, BAD_ANSWER, DONE, REASONS, RUNNING
from zwidth.passivity.verdict import Verdict
from zwidth.quantity.text import shown
from zwidth.showing import Part, Shown, Table

if TYPE_CHECKING:
    from zwidth.machine.servo.recording.recorder import Recorded
    from zwidth.passivity.pairs import PairVerdict


@dataclass(frozen=True, repr=False)
class ServoReport(Shown):
    """What a served loop did.

    Parameters
    ----------
    title
        The law that began last, and the device.
    verdict, measured
        What was claimed of it, and with what.
    granted
        What the system granted to the loop's thread.
    ended
        Why the force ended; "" while the loop runs.
    samples, missed, later, held, cut
        Samples taken; deadlines missed; samples later than the verdict supposes, or whose force was;
        samples without a good answer, the force held; samples whose force the safety cut, of which no
        verdict speaks.
    laws
        How often a law began.
    lateness
        Median, 99 %, 99.9 % and largest, 4.4 % too long at most [s].
    energy_out
        W_a, given to the handle by the actuator, as the encoder saw it [J].
    friction_loss
        What the device's friction took of it at least [J].
    least
        The least that friction_loss − energy_out was: as far as encoder and friction are known, the hand
        has always put in so much at least, but for what the handle had in its motion [J].
    met_hardware
        False where only an emulator of this device has been met.
    recorded
        What became of the recording; None where there was none.
    """

    title: str
    verdict: Verdict | None
    measured: Measured | None
    granted: Granted | None
    ended: str
    samples: int
    missed: int
    later: int
    held: int
    cut: int
    laws: int
    lateness: tuple[float, float, float, float]
    energy_out: float
    friction_loss: float
    least: float
    met_hardware: bool
    recorded: Recorded | None = None

    @property
    def failed(self) -> bool:
        """True where the force ended by itself, before its time, or the recording did."""
        lost = self.recorded is not None and (self.recorded.failure is not None or self.recorded.rows_lost)
        return bool(lost or (self.ended and self.ended not in (ending(ASKED), ending(DONE))))

    def to_dict(self) -> dict[str, Any]:
        """The same with a unit in every key."""
        names = ("median", "of_99_percent", "of_99_9_percent", "largest")
        return {
            "format": "zwidth served 1",
            "title": self.title,
            "outcome": None if self.verdict is None else self.verdict.outcome,
            "verdict": None if self.verdict is None else self.verdict.claim,
            "measured": None if self.measured is None else self.measured.to_dict(),
            "granted": None if self.granted is None else self.granted.to_dict(),
            "ended": self.ended,
            "samples": self.samples,
            "missed_samples": self.missed,
            "later_than_supposed_samples": self.later,
            "held_samples": self.held,
            "cut_samples": self.cut,
            "laws_begun": self.laws,
            "lateness_s": dict(zip(names, self.lateness, strict=True)),
            "energy_out_J": self.energy_out,
            "friction_loss_at_least_J": self.friction_loss,
            "hand_put_in_at_least_J": self.least,
            "recorded": None if self.recorded is None else self.recorded.to_dict(),
        }

    def report(self) -> Iterable[Part]:
        """The answer first."""
        yield f"{self.title}: {self.ended or 'runs'}"
        if self.verdict is not None:
            yield self.verdict.claim
        late = [f"{1e6 * t:.3g} µs" for t in self.lateness]
        rows = [
            ("samples taken", f"{self.samples}"),
            ("missed: the loop came a period late", f"{self.missed}"),
            ("later than the verdict supposes", f"{self.later}"),
            ("without a good answer, force held", f"{self.held}"),
            ("force cut by the safety, not in the verdict", f"{self.cut}"),
            ("late by, in half of them", late[0]),
            ("late by, in 99 %", late[1]),
            ("late by, in 99.9 %", late[2]),
            ("late by, at most", late[3]),
            ("the actuator gave the handle", shown(self.energy_out, "J")),
            ("friction took at least", shown(self.friction_loss, "J")),
            ("least that the hand had put in, as the encoder saw it", shown(self.least, "J")),
        ]
        yield Table(rows=rows, lefts=1)
        if self.recorded is not None:
            yield self.recorded.describe()
        if self.granted is not None:
            refused = [answer for answer in self.granted.answers if not answer.granted]
            yield from (f"{answer.wish}: not granted: {answer.told}" for answer in refused)
        if not self.met_hardware:
            yield "Tried against an emulator or a simulation of this device only, not against the device."


def report_of(
    loop: Shared,
    title: str,
    connection: Connection,
    measured: Measured | None,
    verdict: Verdict | None,
    granted: Granted | None,
) -> ServoReport:
    """From what the loop counted."""
    control, n = loop.control, loop.numbers
    reason = int(control[cycle.REASON])
    return ServoReport(
        title=title,
        verdict=verdict,
        measured=measured,
        granted=granted,
        ended=ending(reason),
        samples=int(loop.spread.sum()),
        missed=int(control[cycle.MISSED]),
        later=int(control[cycle.LATER]),
        held=int(control[cycle.HELD]),
        cut=int(control[cycle.CUT]),
        laws=int(control[cycle.CHANGES]),
        lateness=_quantiles(loop),
        energy_out=float(n[cycle.WORK]),
        friction_loss=float(n[cycle.LOSS]),
        least=float(n[cycle.LEAST]),
        met_hardware=connection.met_hardware,
    )


def _quantiles(loop: Shared) -> tuple[float, float, float, float]:
    p50, p99, p999, most = (quantile(loop.spread, share) for share in (0.5, 0.99, 0.999, 1.0))
    return p50, p99, p999, most


def ending(reason: int) -> str:
    """Why the force ended, in words; "" while it has not."""
    if reason == RUNNING:
        return ""
    if reason >= BAD_ANSWER:
        return f"ended, since of the device there was {STATUS[reason - BAD_ANSWER]}"
    return f"ended, since {REASONS[reason]}"


@dataclass(frozen=True, repr=False)
class PairServoReport(Shown):
    """What a served pair did; of two numbers the first is the leader's."""

    title: str
    verdict: PairVerdict | None
    measured: Measured | None
    granted: Granted | None
    ended: str
    """Why the force of both ended; "" before that."""
    samples: int
    missed: int
    held: int
    """Samples at which an arm gave no good answer, the force of both held."""
    cut: int
    """Samples at which the safety cut a force, of which no verdict speaks."""
    lateness: tuple[float, float, float]
    """Median, 99 % and largest [s]."""
    energy_out: tuple[float, float]
    """Given to the handles by the actuators, as the encoders saw it [J]."""
    friction_loss: tuple[float, float]
    """What the friction of each took of it at least [J]."""
    met_hardware: bool

    @property
    def failed(self) -> bool:
        """True where the force ended by itself, before its time."""
        return bool(self.ended) and self.ended not in (ending(ASKED), ending(DONE))

    def to_dict(self) -> dict[str, Any]:
        """The same with a unit in every key."""
        arms = ("leader", "follower")
        late = ("median", "of_99_percent", "largest")
        return {
            "format": "zwidth served pair 1",
            "title": self.title,
            "outcome": None if self.verdict is None else self.verdict.outcome,
            "verdict": None if self.verdict is None else self.verdict.claim,
            "measured": None if self.measured is None else self.measured.to_dict(),
            "granted": None if self.granted is None else self.granted.to_dict(),
            "ended": self.ended,
            "samples": self.samples,
            "missed_samples": self.missed,
            "held_samples": self.held,
            "cut_samples": self.cut,
            "lateness_s": dict(zip(late, self.lateness, strict=True)),
            "energy_out_J": dict(zip(arms, self.energy_out, strict=True)),
            "friction_loss_at_least_J": dict(zip(arms, self.friction_loss, strict=True)),
        }

    def report(self) -> Iterable[Part]:
        """The answer first."""
        yield f"{self.title}: {self.ended or 'not served yet'}"
        if self.verdict is not None:
            yield self.verdict.claim
        p50, p99, most = (f"{1e6 * t:.3g} µs" for t in self.lateness)
        rows = [
            ("samples taken, missed", f"{self.samples}, {self.missed}"),
            ("without a good answer, forces held", f"{self.held}"),
            ("a force cut by the safety, not in the verdict", f"{self.cut}"),
            ("late by: half of them, 99 %, at most", f"{p50}, {p99}, {most}"),
            ("the actuators gave leader, follower", _two(self.energy_out)),
            ("friction took at least, leader, follower", _two(self.friction_loss)),
        ]
        yield Table(rows=rows, lefts=1)
        if not self.met_hardware:
            yield "Tried against emulators or simulations of these devices only, not against the devices."


def _two(energies: tuple[float, float]) -> str:
    return ", ".join(f"{energy:.4g} J" for energy in energies)


@dataclass(frozen=True, repr=False)
class PortReport(Shown):
    """What a device at the end of a line did."""

    device: str
    ended: str
    """Why the force ended; "" while it has not."""
    samples: int
    held: int
    """Samples without a good answer, the force held."""
    later: int
    """Periods that were longer than the port supposes: in them its promise does not hold."""
    met_hardware: bool

    def to_dict(self) -> dict[str, Any]:
        """The same as plain data."""
        return {
            "device": self.device,
            "ended": self.ended,
            "samples": self.samples,
            "held_samples": self.held,
            "later_than_supposed_samples": self.later,
        }

    def report(self) -> Iterable[Part]:
        """Two lines, three of a device that was never met."""
        yield f"{self.device}: {self.ended or 'runs'}"
        yield (
            f"{self.samples} samples, {self.held} without a good answer, {self.later} later than the port "
            "supposes"
        )
        if not self.met_hardware:
            yield "Tried against an emulator or a simulation of this device only, not against the device."
