"""The verdict on a device whose motor and hand move apart, on a cable, a belt or a gear.

With the encoder at the motor, what the hand puts in is at least what the actuator takes and what rubs, and of
viscous friction that is, whatever the hand does with its own side,

    b₁ v₁² + c (v₁ − v₂)² + b₂ v₂² ≥ (b₁ + c b₂/(c + b₂)) v₁² :

a loop that is passive with this damping and the Coulomb friction of the motor's side alone is passive for
every stiffness and every mass behind the motor, of any law and however contact is made.  Where that is not
enough, a linear law on a transmission that is known is decided by the criterion of `linear.transmission`.
Of the handle's side its damping alone is in it: a mass returns what it takes, dry friction takes more, and so
does more damping, of the same motion of the handle.  So the least damping proves, and the most refutes.
A violation holds whatever Coulomb friction and encoder are: a large motion outweighs both.  A proof is of
viscous friction and an ideal encoder: Coulomb friction on the motor changes how it moves, and what that does
to a hand behind a cable is not proved.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from math import inf, pi, sqrt
from typing import Any

from zwidth.model.device import Device, Transmission
from zwidth.model.environment.environment import Environment
from zwidth.passivity import parameter_limits
from zwidth.passivity.advice import Advice
from zwidth.passivity.certificate import FORMAT, Certificate, positivity_document
from zwidth.passivity.linear.boundary import COARSE, largest_holding
from zwidth.passivity.linear.criterion import LinearRefutation, decide_linear
from zwidth.passivity.linear.loop import linear_loop
from zwidth.passivity.linear.transmission import (
    LARGEST_TURN,
    Elastic,
    ElasticProof,
    ElasticRefutation,
    decide_elastic,
)
from zwidth.passivity.result import share_left
from zwidth.passivity.scope import Contact, Outcome, scope_of
from zwidth.passivity.verdict import Verdict
from zwidth.passivity.witness.elastic import ElasticViolation, elastic_document
from zwidth.passivity.witness.witness import Setting
from zwidth.quantity.answered import answers, known
from zwidth.quantity.exact import Exact, Interval, ends
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.text import at_least, at_most, exact_text, shown

Judge = Callable[[Device], Verdict]

_TOO_CLOSE = "The criterion of motor, transmission and hand is too close to zero to tell its sign."
_UNCONFIRMED = "A proof was found, but the independent checker did not confirm it within its bounds."
_HIDDEN = (
    "Numerator and denominator of H(z) share a root on or outside the unit circle: the controller carries a "
    "mode that never dies out. Cancel it and check again."
)
_DEPENDS = (
    "With the least damping of transmission.handle_damping a hand takes energy out; that it does so "
    "with the most is not shown: give a smaller interval."
)
_IF_IDEAL = (
    "With viscous friction alone and an ideal encoder this loop is passive. With the Coulomb friction of the "
    "motor's side, or the encoder's steps, it is proved only as far as what the motor feels of friction "
    "whatever the hand does pays for all."
)


@dataclass(frozen=True, repr=False, kw_only=True)
class TransmissionVerdict(Verdict):
    """A verdict on a device with a transmission."""

    side: Verdict | None = known(
        "the verdict on the motor's side alone; None where it says nothing", default=None
    )
    elastic: Elastic | None = known("the loop with its transmission, where it is known", default=None)
    asked: Contact = known("of which contact", default="made and broken")
    open: str = known("why it is undecided, in a sentence", default="")

    @property
    def claim(self) -> str:
        """The verdict in a sentence or two."""
        return self.open if self.outcome == "undecided" else super().claim

    @property
    @answers()
    def decided_by(self) -> str:
        """The road on which the outcome was found."""
        if self.outcome == "undecided":
            return "nothing"
        if self.scope.transmission == "any" and self.side is not None:
            return f"{self.side.decided_by}, by the friction that the motor feels whatever the hand does"
        return "the linear criterion of motor, transmission and hand"

    @property
    def _with(self) -> str:
        """What the criterion of motor, transmission and hand leaves out of what is asked, in words."""
        kept = self.environment.unilateral and self.asked != "kept"
        parts = ("contact kept" if kept else "", "" if is_ideal(self.device) else "friction viscous alone")
        return ", ".join(part for part in parts if part)

    @cached_property
    @answers(
        "largest stiffness that is passive whatever stiffness and mass stand behind the motor; null if none "
        "is, or that is not known",
        quantity="stiffness",
    )
    def max_stiffness_any_transmission(self) -> float | None:
        """Largest K for every stiffness between motor and hand [N/m; N·m/rad]."""
        found: float | None = getattr(self.side, "max_stiffness", None)
        return found

    @cached_property
    @answers(
        "largest passive stiffness with this transmission, where friction is viscous alone and the encoder "
        "ideal; null if none is, or the transmission is not known",
        quantity="stiffness",
    )
    def max_stiffness_viscous(self) -> float | None:
        """Largest K by the criterion of motor, transmission and hand [N/m; N·m/rad]."""
        if self.elastic is None or not parameter_limits.has_stiffness(self.environment):
            return None
        return _largest(self.device, self.environment)

    @property
    @answers("largest passive stiffness that is proved; null if none is", quantity="stiffness")
    def max_stiffness(self) -> float | None:
        """Largest K that is proved [N/m; N·m/rad]."""
        own = None if self._with else self.max_stiffness_viscous
        proved = [self.max_stiffness_any_transmission, own]
        return max((k for k in proved if k is not None), default=None)

    @property
    def stiffest(self) -> float | None:
        """The largest K that `check` calls passive, of contact as it was asked [N/m; N·m/rad]."""
        return self.max_stiffness

    def _left(self) -> float | None:
        """Of the largest stiffness that is proved."""
        if not parameter_limits.has_stiffness(self.environment):
            return None
        return share_left(float(ends(parameter_limits.stiffness_of(self.environment))[1]), self.max_stiffness)

    @property
    @answers(
        "where the motor swings on its transmission while the hand holds still; null where not known",
        unit="Hz",
    )
    def resonance(self) -> float | None:
        """√(k/m)/2π of the motor's side [Hz]."""
        if self.elastic is None:
            return None
        return sqrt(self.elastic.stiffness / self.elastic.mass) / (2 * pi)

    @property
    def advice(self) -> tuple[Advice, ...]:
        """How stiff the law may be; how much damping the motor's side needs."""
        return tuple(self._advised())

    def _advised(self) -> Iterator[Advice]:
        proved, in_contact = self.is_proved, self.outcome == "passive in contact"
        unit = {name: self.device.unit(name) for name in ("stiffness", "damping")}
        most = self.max_stiffness_viscous if in_contact else self.max_stiffness
        to = at_most(most, unit["stiffness"])
        if to and to != inf and parameter_limits.has_stiffness(self.environment):
            now = float(ends(parameter_limits.stiffness_of(self.environment))[1])
            here, there = (shown(value, unit["stiffness"], 6) for value in (now, to))
            text = (
                f"stiffness may go up to {there} (now {here})"
                if proved
                else f"lower the stiffness from {here} to {there}"
            )
            yield Advice("stiffness", now, to, unit["stiffness"], "slack" if proved else "change", text)
        if not proved:
            yield from self._of_the_motor(unit["damping"])

    def _of_the_motor(self, unit: str) -> Iterator[Advice]:
        """What more friction on the motor's side would do alone."""
        need, decision = getattr(self.side, "required_damping", None), getattr(self.side, "decision", None)
        if need is None or decision is None:
            return
        has = float(ends(self.device.damping)[0])
        short = need - float(ends(seen_at_motor(self.device).damping)[0])
        dry, enough = float(ends(self.device.coulomb_friction)[0]), decision.sufficient_friction
        if short > 0 and enough is not None and enough <= dry:
            yield _raised("damping", "damping", has, at_least(has + short, unit), unit)
        elif short <= 0 and enough is not None and enough > dry:
            unit = self.device.unit("coulomb_friction")
            yield _raised("coulomb_friction", "Coulomb friction", dry, at_least(float(enough), unit), unit)

    def rows(self) -> list[tuple[str, str]]:
        """The main numbers as (name, text) for a report."""
        unit = GLOSSARY["stiffness"].unit_for(self.device.motion)
        rows = [("decided by", self.decided_by)]
        if self.max_stiffness_any_transmission is not None:
            most = shown(at_most(self.max_stiffness_any_transmission, unit), unit, 6)
            rows.append(("largest stiffness, however it gives way", most))
        if self.max_stiffness_viscous is not None:
            most = shown(at_most(self.max_stiffness_viscous, unit), unit, 6)
            rows.append((", ".join(("largest stiffness, this one", *filter(None, (self._with,)))), most))
        if self.resonance is not None:
            rows.append(("the motor swings on it at", shown(self.resonance, "Hz", 6)))
        return rows


def _raised(parameter: str, name: str, now: float, to: float | None, unit: str) -> Advice:
    assert to is not None
    here, there = (shown(value, unit, 6) for value in (now, to))
    text = f"raise the {name} of the motor's side from {here} to {there}"
    return Advice(parameter, now, to, unit, "change", text)


def is_ideal(device: Device) -> bool:
    """True where the motor's side has no Coulomb friction and the encoder no steps."""
    return ends(device.coulomb_friction)[1] == ends(device.resolution)[1] == 0


def seen_at_motor(device: Device) -> Device:
    """The motor's side with the damping that is there whatever the hand does: b₁ + c b₂/(c + b₂).

    A device without a transmission as it is.
    """
    given, motor = device.transmission, device.motor_side
    if given is None:
        return device
    sums = [
        b + (c * h / (c + h) if c else c)
        for b, c, h in zip(*map(ends, (motor.damping, given.damping, given.handle_damping)), strict=True)
    ]
    return motor.replace(damping=Exact(sums[0]) if sums[0] == sums[1] else Interval(*sums))


def as_one_body(device: Device) -> Device:
    """What proves for every transmission: what is seen at the motor; with the encoder elsewhere nothing."""
    if device.transmission is None:
        return device
    if device.transmission.encoder == "motor":
        return seen_at_motor(device)
    return device.motor_side.replace(damping=0, coulomb_friction=0)


def check_transmission(device: Device, law: Environment, asked: Contact, judge: Judge) -> TransmissionVerdict:
    """Decide a device with a transmission; `judge` has the verdict on a device without one."""
    given = device.transmission
    assert given is not None
    side = judge(seen_at_motor(device)) if given.encoder == "motor" else None
    if side is not None and side.outcome not in ("active", "undecided"):
        scope = side.scope.replace(transmission="any")
        return TransmissionVerdict(
            side.outcome, scope, device, law, side.certificate,
            available_storage=side.available_storage, at_limit=side.at_limit, theorem=side.theorem, side=side,
            elastic=elastic_of(device, law), asked=asked,
        )  # fmt: skip
    scope = scope_of(device.motor_side, law).replace(transmission="as given")
    elastic = elastic_of(device, law)
    found = TransmissionVerdict("undecided", scope, device, law, side=side, elastic=elastic, asked=asked)
    if elastic is None:
        bare = _without_friction_behind(device, law, found)
        return replace(found, open=_unknown(given, device, law)) if bare is None else bare
    decision = decide_elastic(elastic)
    setting = _setting(device, law, elastic)
    if isinstance(decision, ElasticRefutation):
        elastic = elastic_of(device, law, 1)  # more damping at the handle takes more of every motion
        most = None if elastic is None else decide_elastic(elastic)
        if elastic is None or not isinstance(most, ElasticRefutation):
            return replace(found, open=_DEPENDS)
        decision = most
        violation = ElasticViolation(elastic, setting, decision, device, law)
        if decision.reason == "too close to zero" or not violation.verify():
            return replace(found, open=_TOO_CLOSE)
        scope = scope.replace(contact=violation.contact)
        return replace(found, outcome="active", scope=scope, violation=violation)
    if not (is_ideal(device) and elastic.loop.hidden_modes_decay):
        return replace(found, open=_IF_IDEAL if elastic.loop.hidden_modes_decay else _HIDDEN)
    certificate = Certificate((_proof(elastic, setting, decision),))
    covered = certificate.covered()
    if covered is None or covered.shows != "passive":
        return replace(found, open=_UNCONFIRMED)
    outcome: Outcome = "passive in contact" if covered.contact == "kept" != asked else "passive"
    return replace(
        found, outcome=outcome, scope=scope.replace(contact=covered.contact), certificate=certificate
    )


def _without_friction_behind(
    device: Device, law: Environment, found: TransmissionVerdict
) -> TransmissionVerdict | None:
    """Where b₂ = c = 0 and the encoder is at the motor, what one mass with b₁ does not bear is active."""
    given = device.transmission
    assert given is not None
    known = given.stiffness is not None and device.mass is not None and not _intervals(given, device, law)
    rubs = ends(given.damping)[1] + ends(given.handle_damping)[1]
    if not known or rubs or given.encoder == "handle" or not law.has_transfer_function or law.clamped:
        return None
    loop = linear_loop(device.motor_side, law)
    decision = decide_linear(loop) if loop.damping else None
    if not isinstance(decision, LinearRefutation) or decision.cosine is None:
        return None
    mass, stiffness = device.motor_side.exact("mass"), _certain(given.stiffness)
    elastic = Elastic(loop, mass, stiffness, Fraction(0), Fraction(0), False)
    refutation = ElasticRefutation("criterion", decision.cosine)
    violation = ElasticViolation(elastic, _setting(device, law, elastic), refutation, device, law)
    if not violation.verify():
        return None
    scope = found.scope.replace(contact=violation.contact)
    return replace(found, outcome="active", scope=scope, violation=violation)


def _unknown(given: Transmission, device: Device, law: Environment) -> str:
    """Why the criterion of motor, transmission and hand cannot be asked."""
    if not law.has_transfer_function or (law.clamped and not law.spring):
        why = "of this law, which is not linear inside, a transmission leaves no other proof known"
    elif names := _intervals(given, device, law):
        why = f"no more is proved of an interval of {names}: give single values, zwidth sweep asks of many"
    elif given.stiffness is None:
        why = "of a transmission whose stiffness is not known no more is proved: give transmission.stiffness"
    elif device.mass is None:
        why = "give the mass of the motor's side, with which it swings on its transmission"
    elif _certain(given.damping) + ends(given.handle_damping)[0]:
        why = "of one so stiff, or with so little friction behind it, no more is decided"
    else:
        why = "friction inside the transmission or on the hand's side is needed for more: give it"
    at_motor = given.encoder == "motor"
    first = "What the motor feels of friction whatever the hand does is not enough" if at_motor else (
        "With the encoder on the hand's side the motor's friction alone proves nothing"
    )  # fmt: skip
    return f"{first}; {why}."


def _intervals(given: Transmission, device: Device, law: Environment) -> str:
    """Of what a single value is needed, in words."""
    own = {f"transmission.{key}": getattr(given, key) for key in ("stiffness", "damping")}
    known = {**device.parameters(), **own}
    names = [name for name, value in known.items() if isinstance(value, Interval)]
    return ", ".join([*names, *(() if law.is_certain else ("the environment",))])


def elastic_of(device: Device, law: Environment, end: int = 0) -> Elastic | None:
    """The loop with its transmission; None where not all of it is known, or the law is not linear.

    Of an interval of damping at the handle it has the lower end, or the upper one with `end` = 1.
    """
    given = device.transmission
    if given is None or given.stiffness is None or device.mass is None:
        return None
    if not law.has_transfer_function or _intervals(given, device, law):
        return None
    if law.clamped and not law.spring:
        return None
    loop = linear_loop(device.motor_side, law)
    inside, outside = _certain(given.damping), ends(given.handle_damping)[end]
    if not (inside + outside and loop.damping + outside):
        return None
    at_handle = given.encoder == "handle"
    mass, stiffness = device.motor_side.exact("mass"), _certain(given.stiffness)
    found = Elastic(loop, mass, stiffness, inside, outside, at_handle)
    return found if found.turn <= LARGEST_TURN else None


def _certain(value: Any) -> Fraction:
    assert isinstance(value, Exact)
    return value.fraction


def _setting(device: Device, law: Environment, elastic: Elastic) -> Setting:
    friction, resolution = (device.motor_side.exact(name) for name in ("coulomb_friction", "resolution"))
    return Setting(elastic.loop, friction, resolution, law.unilateral, device.motion)


def _proof(elastic: Elastic, setting: Setting, proof: ElasticProof) -> dict[str, Any]:
    below = {
        "below": [exact_text(c) for c in proof.below],
        "positivity": positivity_document(proof.positivity),
    }
    return {"format": FORMAT, "kind": "transmission", **elastic_document(elastic, setting), "proof": below}


def _largest(device: Device, law: Environment) -> float | None:
    """The largest K that the criterion of motor, transmission and hand allows."""

    def holds(stiffness: Fraction) -> bool:
        elastic = elastic_of(device, law.replace(stiffness=Exact(stiffness)))
        return elastic is not None and isinstance(decide_elastic(elastic), ElasticProof)

    now = float(parameter_limits.stiffness_of(law)) or 1.0
    return largest_holding(holds, now, COARSE)
