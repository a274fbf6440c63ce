"""What was served: a loop, a pair, a device at the end of a line; and why the force ended."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, cast

from zwidth.machine.servo import cycle
from zwidth.machine.servo.connection import STATUS, Connection
from zwidth.machine.servo.loop import Shared
from zwidth.machine.servo.priority import Granted
from zwidth.machine.servo.proving import Measured, claimed
from zwidth.machine.servo.ring import quantile
from zwidth.machine.servo.safety import ASKED, BAD_ANSWER, DONE, REASONS, RUNNING
from zwidth.passivity.verdict import Verdict
from zwidth.quantity.answered import answered, finite, rows_of
from zwidth.quantity.documented import Documented
from zwidth.quantity.text import shown
from zwidth.showing import Part, Table

if TYPE_CHECKING:
    from zwidth.machine.servo.recording.recorder import Recorded
    from zwidth.passivity.pairs import PairVerdict


@dataclass(frozen=True, repr=False)
class Served(Documented):
    """What is known of a loop and of a pair of loops alike."""

    title: str = answered("the law that began last, and the device; of a pair, both devices")
    verdict: Verdict | PairVerdict | None = answered(
        "what is claimed of it, as measured here", stands_as={"outcome": "outcome", "verdict": "claim"}
    )
    measured: Measured | None = answered("with what was measured of the loop before")
    granted: Granted | None = answered("what the system granted to the loop's thread")
    ended: str = answered('why the force ended; "" while the loop runs')
    samples: int = answered("samples taken", row="samples taken")
    missed: int = answered(
        "deadlines missed", key="missed_samples", row="missed: the loop came a period late"
    )
    held: int = answered(
        "samples without a good answer, the force held",
        key="held_samples",
        row="without a good answer, force held",
    )
    cut: int = answered(
        "samples whose force the safety cut, of which no verdict speaks",
        key="cut_samples",
        row="force cut by the safety, not in the verdict",
    )

    @property
    def failed(self) -> bool:
        """True where the force ended by itself, before its time."""
        return bool(self.ended) and self.ended not in (ending(ASKED), ending(DONE))


@dataclass(frozen=True, repr=False)
class ServoReport(Served):
    """What a served loop did."""

    _FORMAT = "zwidth served 1"

    later: int = answered(
        "samples later than 99 % of those measured before, or whose force was: the verdict leaves them out",
        key="later_than_supposed_samples",
        row="later than the verdict supposes",
    )
    laws: int = answered("how often a law began", key="laws_begun")
    lateness: tuple[float, float, float, float] = answered(
        "how late samples were, 4.4 % too long at most",
        unit="s",
        names=("median", "of_99_percent", "of_99_9_percent", "largest"),
        row=("late by, in half of them", "late by, in 99 %", "late by, in 99.9 %", "late by, at most"),
        digits=3,
    )
    energy_out: float | None = answered(
        "W_a, given to the handle by the actuator, as the encoder saw it; null, as the two below, of an "
        "encoder that does not see the motor",
        unit="J",
        row="the actuator gave the handle",
    )
    friction_loss: float | None = answered(
        "what the device's friction took of it at least",
        key="friction_loss_at_least",
        unit="J",
        row="friction took at least",
    )
    least: float | None = answered(
        "the least that friction_loss − energy_out was: as far as encoder and friction are known, the hand "
        "has always put in so much at least, but for what the handle had in its motion",
        key="hand_put_in_at_least",
        unit="J",
    )
    met_hardware: bool = answered("False where only an emulator of this device was met", only_shown=True)
    recorded: Recorded | None = answered("what became of the recording", default=None)

    @property
    def failed(self) -> bool:
        """True where the force ended by itself, before its time, or the recording did."""
        lost = self.recorded is not None and (self.recorded.failure is not None or self.recorded.rows_lost)
        return super().failed or bool(lost)

    def report(self) -> Iterable[Part]:
        """The answer first."""
        yield f"{self.title}: {self.ended or 'runs'}"
        if self.verdict is not None:
            yield claimed(cast("Verdict", self.verdict))
        yield Table(rows=[row for row in rows_of(self) if row[1] != "none"], lefts=1)
        yield _balance(self.least)
        if self.recorded is not None:
            yield self.recorded.describe()
        if self.granted is not None:
            refused = [answer for answer in self.granted.answers if not answer.granted]
            yield from (f"{answer.wish}: not granted: {answer.told}" for answer in refused)
        if not self.met_hardware:
            yield "Tried against an emulator or a simulation of this device only, not against the device."


def _balance(least: float | None) -> str:
    """What the least that the hand had put in [J] says, in words."""
    if least is None:
        return "The encoder does not see the motor: what energy the actuator gave is not known."
    most = "the handle's own motion aside, as the encoder saw it."
    if least >= 0:
        return f"At no time had the hand got more energy out than it had put in, {most}"
    return f"At some time the hand may have got {shown(-least, 'J')} more out than it had put in, {most}"


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
        energy_out=finite(float(n[cycle.WORK])),
        friction_loss=finite(float(n[cycle.LOSS])),
        least=finite(float(n[cycle.LEAST])),
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


_BOTH = ("leader", "follower")


@dataclass(frozen=True, repr=False)
class PairServoReport(Served):
    """What a served pair did; of two numbers the first is the leader's."""

    _FORMAT = "zwidth served pair 1"

    lateness: tuple[float, float, float] = answered(
        "how late samples were",
        unit="s",
        names=("median", "of_99_percent", "largest"),
        row=("late by, in half of them", "late by, in 99 %", "late by, at most"),
        digits=3,
    )
    energy_out: tuple[float, float] = answered(
        "given to the handles by the actuators, as the encoders saw it",
        unit="J",
        names=_BOTH,
        row=("the actuator gave the leader", "the actuator gave the follower"),
    )
    friction_loss: tuple[float, float] = answered(
        "what the friction of each took of it at least",
        key="friction_loss_at_least",
        unit="J",
        names=_BOTH,
        row=("the leader's friction took at least", "the follower's friction took at least"),
    )
    met_hardware: bool = answered("False where only emulators of these devices were met", only_shown=True)

    def report(self) -> Iterable[Part]:
        """The answer first."""
        yield f"{self.title}: {self.ended or 'not served yet'}"
        if self.verdict is not None:
            yield self.verdict.claim
        yield Table(rows=[*rows_of(self)], lefts=1)
        if not self.met_hardware:
            yield "Tried against emulators or simulations of these devices only, not against the devices."


@dataclass(frozen=True, repr=False)
class PortReport(Documented):
    """What a device at the end of a line did."""

    device: str = answered("its description")
    ended: str = answered('why the force ended; "" while it has not')
    samples: int = answered("samples taken")
    held: int = answered("samples without a good answer, the force held", key="held_samples")
    later: int = answered(
        "periods that were longer than the port supposes: in them its promise does not hold",
        key="later_than_supposed_samples",
    )
    met_hardware: bool = answered("False where only an emulator of this device was met", only_shown=True)

    def report(self) -> Iterable[Part]:
        """Two lines, three of a device that was never met."""
        yield f"{self.device}: {self.ended or 'runs'}"
        yield (
            f"{self.samples} samples, {self.held} without a good answer, {self.later} later than the port "
            "supposes"
        )
        if not self.met_hardware:
            yield "Tried against an emulator or a simulation of this device only, not against the device."
