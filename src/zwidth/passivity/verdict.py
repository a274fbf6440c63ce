"""The verdict: what is claimed of a loop, on what evidence, and what follows from it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from math import cos, pi
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from zwidth.device import Device
from zwidth.device.actuator import ActuatorCheck, actuator_checks
from zwidth.environment.environment import Environment
from zwidth.passivity import limits
from zwidth.passivity.actuator_demand import actuator_demand
from zwidth.passivity.advice import Advice, advise
from zwidth.passivity.budget import CONTACT, QUANTIZATION, Budget, binding_limit, budget
from zwidth.passivity.certificate import Certificate
from zwidth.passivity.decision import Decision
from zwidth.passivity.document import save_json, to_json, unit_suffix
from zwidth.passivity.stability_plane import admissible_speed
from zwidth.passivity.violation import Violation
from zwidth.passivity.witness import Witness, rounded_energy
from zwidth.quantity.glossary import GLOSSARY

if TYPE_CHECKING:
    from zwidth.passivity.worst_hand import WorstHand
    from zwidth.passivity.worst_hand.gain import Gain

Outcome = Literal["passive", "active", "undecided"]


@dataclass(frozen=True)
class Verdict:
    """Whether a hand can take energy out of a sampled loop.

    "passive" stands on a `certificate` that the independent checker accepted, "active" on
    a `violation` that it accepted or on a motion, the `witness`, that it recomputed;
    "undecided" says what is known.
    For parameters given as intervals the verdict holds for every value; the
    numbers below then speak of the worst case (`device`, `environment`).

    Attributes
    ----------
    outcome
        "passive", "active" or "undecided".
    claim
        The claim in a sentence.
    assumptions
        What the claim covers and takes for granted.
    device, environment
        The loop decided: the worst corner where intervals were given.
    certificate
        The proof of "passive"; else None.
    violation
        What of the linear criterion is violated, a proof of "active"; or so at the worst corner
        of an interval.  None for a loop that is active by its encoder, or by contact made and broken.
    motion
        The motion, where it was needed to decide; see `witness`.
    worst_hand
        What the game of the worst hand adds, where the closed forms leave a gap: a motion,
        then also the `witness`; or a proof for hands within bounds.
    """

    outcome: Outcome
    claim: str
    assumptions: tuple[str, ...]
    device: Device
    environment: Environment
    decision: Decision
    certificate: Certificate | None = None
    violation: Violation | None = None
    motion: Witness | Gain | None = None
    worst_hand: WorstHand | None = None

    @cached_property
    def witness(self) -> Witness | Gain | None:
        """The motion that takes energy out, made when it is first asked for.

        None where the loop is not active, or no motion that was found is short enough to be written down.
        """
        if self.motion is not None or self.violation is None:
            return self.motion
        return self.violation.witness

    @cached_property
    def budget(self) -> Budget:
        """Leaks against dissipation at the tightest frequency."""
        return budget(self.decision)

    @cached_property
    def limit(self) -> str:
        """The mechanism that binds: what is violated, or would be first."""
        if self._in_contact_only:
            return CONTACT
        return binding_limit(self.decision, self.budget, self.environment)

    @property
    def _in_contact_only(self) -> bool:
        """True when a hand that stays inside gains nothing, and one that touches and leaves does.

        What is required is then what is proved enough with contact made and broken.
        """
        return self.outcome == "active" and self.decision.is_provable

    @property
    def mode(self) -> str | None:
        """How a violation shows itself (Abbott & Okamura 2005, section IV-C).

        None when passive, and for a motion that has to touch and leave.
        """
        if self.outcome == "passive" or self._in_contact_only:
            return None
        return "active tactile" if self.limit == QUANTIZATION else "closed-loop instability"

    @cached_property
    def max_stiffness(self) -> float | None:
        """Largest passive stiffness K, all else as given [N/m; N·m/rad].

        inf if every stiffness is passive; None if none is, or the law has none
        (see `max_gain`).
        """
        return limits.max_stiffness(self.device, self.environment, self._in_contact_only)

    @cached_property
    def max_gain(self) -> float | None:
        """Largest passive factor on H(z), for a law without a stiffness of its own."""
        return limits.max_gain(self.device, self.environment, self._in_contact_only)

    @cached_property
    def required_damping(self) -> float | None:
        """Smallest device damping b that hold, delay and law need [N·s/m; N·m·s/rad].

        None if no damping would do.  Coulomb friction is a need of its own: see `margins`.
        """
        return limits.required_damping(self.decision, self._in_contact_only)

    @property
    def critical_frequency(self) -> float:
        """Frequency at which the linear criterion is tightest [Hz]."""
        return self.budget.frequency

    @cached_property
    def admissible_speed(self) -> float | None:
        """Hand speed up to which an active spring wall still gives out no energy [m/s; rad/s].

        v = (2f_c − K Δ)/(K T − 2b), for mean speeds over a sample: Coulomb
        friction outweighs the hold's leak of slow motions.  None where it does
        not apply: a passive loop, another law, a delay.
        """
        spring, loop = self.decision.is_spring, self.decision.loop
        if self.outcome != "active" or not spring or loop.whole_delay or loop.part_delay:
            return None
        stiffness = loop.static_stiffness
        assert stiffness is not None
        speed = float(admissible_speed(self.device, stiffness))
        return speed if 0 < speed < float("inf") else None

    @cached_property
    def margins(self) -> Mapping[str, float | None]:
        """What is left of damping and of Coulomb friction over what is needed; < 0 if too little.

        Keys "damping" [N·s/m; N·m·s/rad] and "coulomb_friction" [N; N·m]; None where the need is unbounded.
        """
        need, friction = self.required_damping, self.decision.sufficient_friction
        friction = self.decision.contact_friction if self._in_contact_only else friction
        b, setting = self.decision.loop.damping, self.decision.setting
        return {
            "damping": None if need is None else _difference(b, need),
            "coulomb_friction": None if friction is None else float(setting.coulomb_friction - friction),
        }

    @cached_property
    def advice(self) -> tuple[Advice, ...]:
        """The smallest single changes that would do, or the slack of each parameter."""
        return advise(self.device, self.environment, self.outcome == "passive", self._in_contact_only)

    @cached_property
    def actuator(self) -> tuple[ActuatorCheck, ...]:
        """Is the actuator close to the ideal that the claim assumes?"""
        stiffness = self.decision.loop.static_stiffness
        positive = stiffness is not None and stiffness > 0
        return actuator_checks(self.device, stiffness if positive else None)

    @cached_property
    def demand(self) -> tuple[str, ...]:
        """What the motion asks of the actuator, where there is one and the actuator's limit is known."""
        if self.device.force_limit is None or self.witness is None:
            return ()
        return (actuator_demand(self.device, self.device.force_limit, self.witness),)

    def curve(self, points: int = 400) -> tuple[list[float], list[float]]:
        """(frequency [Hz], damping the criterion asks for there [N·s/m]), for plotting only."""
        loop = self.decision.loop
        turns = [(k + 0.5) / points / 2 for k in range(points)]
        cosines = [Fraction(cos(2 * pi * t)) for t in turns]
        return [t / float(loop.period) for t in turns], [loop.required_damping_at(c) for c in cosines]

    def to_dict(self) -> dict[str, Any]:
        """The whole verdict as plain data, a unit in every key of a physical quantity."""
        motion = self.device.motion

        def key(prefix: str, quantity: str) -> str:
            return f"{prefix}_{unit_suffix(GLOSSARY[quantity].unit_for(motion))}"

        document: dict[str, Any] = {
            "format": "zwidth verdict 1",
            "outcome": self.outcome,
            "claim": self.claim,
            "assumptions": [*self.assumptions, *self.demand],
            "limit": self.limit,
            "mode": self.mode,
        }
        document[key("max_stiffness", "stiffness")] = self.max_stiffness
        if not limits.has_stiffness(self.environment):
            document["max_gain"] = self.max_gain
        document[key("required_damping", "damping")] = self.required_damping
        document["critical_frequency_Hz"] = self.critical_frequency
        if self.admissible_speed is not None:
            speed_unit = "rad_per_s" if motion == "rotary" else "m_per_s"
            document[f"admissible_speed_{speed_unit}"] = self.admissible_speed
        document["margins"] = {key(name, name): value for name, value in self.margins.items()}
        document["advice"] = [advice.to_dict() for advice in self.advice]
        document["actuator"] = [{"name": c.name, "ok": c.ok, "text": c.text} for c in self.actuator]
        if self.certificate is not None:
            document["certificate"] = self.certificate.to_dict()
        if self.violation is not None:
            document["violation"] = self.violation.to_dict()
        if self.witness is not None:
            document["witness"] = rounded_energy(self.witness.to_dict())
        if self.worst_hand is not None:
            document["worst_hand"] = self.worst_hand.to_dict(evidence=False)
        return document

    def to_json(self) -> str:
        """`to_dict` as JSON text, every exact number digit for digit."""
        return to_json(self.to_dict())

    def save(self, path: str | Path, reports: Mapping[str, Any] | None = None) -> None:
        """Write verdict and evidence as JSON for `zwidth verify`, and `reports` under their names."""
        document = {**self.to_dict(), **(reports or {})}
        if self.worst_hand is not None and self.witness is None:
            document["worst_hand"] = self.worst_hand.to_dict()
        save_json(path, document)

    def __repr__(self) -> str:
        return f"<Verdict {self.outcome}: {self.claim}>"

    def _repr_html_(self) -> str:
        colour = {"passive": "#2a7d4f", "active": "#b3261e", "undecided": "#8a6d00"}[self.outcome]
        rows = "".join(f"<tr><th align='left'>{k}</th><td align='left'>{v}</td></tr>" for k, v in self.rows())
        assumed = "".join(f"<li>{a}</li>" for a in (*self.assumptions, *self.demand))
        return (
            f"<div><b style='color:{colour}'>{self.outcome}</b> {self.claim}"
            f"<table>{rows}</table><details><summary>assumptions</summary><ul>{assumed}</ul></details></div>"
        )

    def rows(self) -> list[tuple[str, str]]:
        """The main numbers as (name, text) for a report."""
        unit = {name: GLOSSARY[name].unit_for(self.device.motion) for name in ("stiffness", "damping")}
        rows = [("limit", self.limit)]
        if limits.has_stiffness(self.environment):
            rows.append(("largest passive stiffness", _text(self.max_stiffness, unit["stiffness"])))
        else:
            rows.append(("largest passive gain", _text(self.max_gain, "times this law")))
        rows.append(("required device damping", _text(self.required_damping, unit["damping"])))
        rows.append(("critical frequency", _text(self.critical_frequency, "Hz")))
        for name, value in self.margins.items():
            margin_unit = GLOSSARY[name].unit_for(self.device.motion)
            rows.append((f"margin of {name.replace('_', ' ')}", _text(value, margin_unit)))
        if self.admissible_speed is not None:
            per_second = "rad/s" if self.device.motion == "rotary" else "m/s"
            rows.append(("slower hands are safe up to", _text(self.admissible_speed, per_second)))
        if self.witness is not None:
            rows.append(("motion", self.witness.describe()))
        return rows


def _difference(b: Fraction, need: float) -> float:
    """b − need exactly: 0 at the limit, whatever the rounding of either."""
    return float(b - Fraction(repr(need)))


def _text(value: float | None, unit: str) -> str:
    if value is None:
        return "none"
    if value == float("inf"):
        return "any"
    return f"{value:.6g} {unit}"
