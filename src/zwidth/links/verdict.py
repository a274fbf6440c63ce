"""Is a port passive whatever the link does?  A certificate, a theorem on paper, or a motion against it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, ClassVar

from zwidth.links import memory
from zwidth.links.attack import LinkWitness, most_taken
from zwidth.links.memory import LATE
from zwidth.links.port import Port
from zwidth.links.schedule import Schedule
from zwidth.links.wave_port import MARGIN, ROUNDING
from zwidth.model.device.amplifier import current_rise
from zwidth.passivity.bounding import ROUNDOFF
from zwidth.passivity.certificate import FORMAT, Certificate
from zwidth.passivity.result import PassivityAnswer
from zwidth.passivity.scope import Outcome, Scope, unit_key
from zwidth.passivity.wording import NOT_FOUND, TRANSMISSION, takes_none
from zwidth.quantity.exact import ends
from zwidth.quantity.glossary import GLOSSARY, unit_suffix
from zwidth.quantity.text import exact_text, told_quantity


def check(port: Port, schedule: Schedule | None = None) -> PortVerdict:
    """Decide whether two hands can take energy out of two such ports, one at each end of a link.

    Passive means for every link that makes up no packets: Σ over both ends of ∫ f_h v dt is never below 0 for
    devices that start at rest, whenever and as often as either port starts anew.  For waves with a ledger it
    comes with a certificate.  For waves without one it is so exactly if w ≤ b and the displacement is read
    without steps, a theorem on paper.  Of other laws a motion is looked for that takes energy out.
    Derivation: docs/theory/pairs.md.

    Parameters
    ----------
    port
        One end; the other is the same.
    schedule
        The link over which a motion is looked for; None: no delay.
    """
    link = Schedule() if schedule is None else schedule
    certificate = certificate_of(port)
    known = certificate is not None or port.theorem or slow_actuator(port)
    return PortVerdict(port, link, certificate, None if known else most_taken(port, port, link))


@dataclass(frozen=True, repr=False)
class PortVerdict(PassivityAnswer):
    """Whether two hands can take energy out of two ports and the link between them.

    It has no `margin`: a ledger gives as much force as was paid for, and no more.

    Attributes
    ----------
    port
        What was asked.
    schedule
        The link of the motion, where there is one.
    certificate
        The proof; None where there is none.
    witness
        The motion that takes energy out; None where none was found.
    """

    _FORMAT: ClassVar[str] = "zwidth port 1"

    port: Port
    schedule: Schedule
    certificate: Certificate | None
    witness: LinkWitness | None

    @property
    def outcome(self) -> Outcome:
        """ "passive", "theorem", "active" or "undecided"."""
        if self.certificate is not None:
            return "passive"
        if self.port.theorem and not slow_actuator(self.port):
            return "theorem"
        return "undecided" if self.witness is None else "active"

    @property
    def claim(self) -> str:
        """The outcome in a sentence."""
        if self.outcome in ("passive", "theorem"):
            why = (
                self.port.theorem or "its ledger pays for every force, from what came and what friction took"
            )
            return (
                f"{takes_none('two hands, one on each device', 'pair')}, over a link that delays, loses, "
                f"repeats or reorders packets as it likes: {why}."
            )
        if self.witness is not None:
            return f"{self.witness.describe()}, over a link with {self.schedule.describe()}."
        slow = slow_actuator(self.port)
        if slow:
            return f"Not proved: a force is taken as instant, and it is not: {slow}."
        return f"{NOT_FOUND}."

    @property
    def scope(self) -> Scope:
        """Every hand, and whether the encoder's steps are counted."""
        steps = ends(self.port.device.resolution)[1] > 0
        return Scope(
            contact="both sides",
            encoder="counted" if steps else "ideal",
            motion=self.port.device.motion,
            assumed=self.port.device.assumed,
        )

    def _assumptions(self) -> Iterator[str]:
        device = self.port.device
        yield "two hands without limit on speed and force, one on each device; both start at rest"
        yield "the link makes up no packets; one with a wrong checksum counts as lost"
        yield "either port may start anew, one at a time on a device; no two runs draw one number of 64 bits"
        late = int(self.port.numbers[LATE])
        when = f"{late} sample{'' if late == 1 else 's'} after its reading" if late else "at once"
        yield f"the force is applied {when} and held for the period, by an actuator without a lag of its own"
        yield "no period is longer than the sample period: in a longer one friction takes less"
        yield "friction is b and f_c of the device at least, at every speed and in every period"
        if device.friction_speed is not None:
            seen = told_quantity(ends(device.friction_speed)[0], "friction_speed", device.motion)
            yield f"they were measured up to {seen}"
        if self.scope.encoder == "counted":
            yield "encoder counts, their phase unknown; none is lost"
        else:
            yield "an ideal position sensor: the displacement is read without error"
        yield TRANSMISSION
        if device.assumed:
            yield f"{', '.join(device.assumed)} not given, taken as 0"
        if self.outcome == "theorem":
            yield "a proof on paper, of exact numbers: docs/theory/pairs.md; no certificate"

    def rows(self) -> Iterator[tuple[str, str]]:
        """The port."""
        yield "port", self.port.describe()

    def numbers(self) -> dict[str, Any]:
        """The port and the motion as plain data, units in the keys."""
        found: dict[str, Any] = {"port": self.port.describe(), "link": self.schedule.describe()}
        if self.witness is not None:
            found["motion"] = self.witness.to_dict()
        return found

    def evidence(self) -> dict[str, Any]:
        """The certificate; a motion runs the port itself, which `zwidth verify` does not know."""
        return {} if self.certificate is None else {"certificate": self.certificate.saved()}


def slow_actuator(port: Port) -> str:
    """Why a force is not there at once, where the device's record says so; "" where it does not."""
    rise = current_rise(port.device)
    return rise.text if rise.ok is False else ""


def certificate_of(port: Port) -> Certificate | None:
    """That the independent checker accepts; None where the port keeps no ledger, or its actuator is slow."""
    if not port.has_ledger or slow_actuator(port):
        return None
    found = Certificate((_document(port),))
    return found if found.verify() else None


def _document(port: Port) -> dict[str, object]:
    """The doubles that the port reckons with, each as the rational that it is."""
    device, motion = port.device, port.device.motion
    loop = {
        "damping": ends(device.damping)[0],
        "coulomb_friction": ends(device.coulomb_friction)[0],
        "resolution": device.exact("resolution"),
        "sample_period": device.exact("sample_period"),
        "delay": device.exact("delay"),
    }
    damping, force, length = (
        unit_suffix(GLOSSARY[name].unit_for(motion)) for name in ("damping", "force", "position")
    )
    law = {
        f"damping_{damping}": port.numbers[memory.DAMPING],
        f"friction_{force}": port.numbers[memory.COULOMB],
        f"count_{length}": port.numbers[memory.RESOLUTION],
        "period_s": port.numbers[memory.PERIOD],
        "hair": ROUNDING,
        "margin": 1.0 - MARGIN,
    }
    return {
        "format": FORMAT,
        "kind": "wave port",
        "loop": {unit_key(name, motion): exact_text(value) for name, value in loop.items()},
        "law": {
            **{name: exact_text(Fraction(float(value))) for name, value in law.items()},
            "roundoff": exact_text(ROUNDOFF),
        },
    }
