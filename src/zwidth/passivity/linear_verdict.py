"""The verdict on a law with H(z): where the damping goes, how far each parameter may go, what to change."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from math import cos, pi
from typing import Any

from zwidth.model.device.amplifier import ActuatorCheck, actuator_checks
from zwidth.passivity import parameter_limits
from zwidth.passivity.advice import Advice
from zwidth.passivity.budget import CONTACT, QUANTIZATION, Budget, binding_limit, budget
from zwidth.passivity.corners import Loop
from zwidth.passivity.criterion_choice import Decision
from zwidth.passivity.formulas.diolaiti import admissible_speed
from zwidth.passivity.loop_advice import Advised, Asked, advise
from zwidth.passivity.scope import Contact
from zwidth.passivity.verdict import Verdict
from zwidth.passivity.witness.violation import Violation
from zwidth.passivity.witness.witness import Witness
from zwidth.quantity.answered import answers, known
from zwidth.quantity.text import in_words, shown, shown_at_least, shown_at_most


@dataclass(frozen=True, repr=False, kw_only=True)
class LinearVerdict(Verdict):
    """A verdict on a law that is H(z) inside, with its numbers."""

    _BESIDES = (
        (
            "outcome",
            '`"passive"`, `"passive in contact"`, `"passive without encoder steps"`, `"theorem"`, '
            '`"active"` or `"undecided"`',
        ),
        ("claim", "in a sentence"),
        ("scope, assumptions", "what the outcome is about; what it covers and takes for granted, in words"),
        ("max_gain", "only for a law without a stiffness of its own: the largest passive factor on H(z)"),
        (
            "actuator",
            "how close it is to the ideal: list of `name`, which check; `ok`, null where a number is "
            "not known; `text`",
        ),
        ("certificate", "the proof, if passive"),
        (
            "violation",
            "if active, or at the worst corner of an interval: the proof that the linear criterion is"
            " violated",
        ),
        (
            "witness",
            "likewise the motion that takes energy out; missing where there is a `violation` and no "
            "motion that was found is short enough to be written down",
        ),
        (
            "best_corner",
            "of intervals of which every value is active: `outcome`, and the `violation` or `witness` at the "
            "values that ask for least",
        ),
        (
            "hand_motion",
            "of a device with a transmission: `positions_m` at the ends of the `pieces` of each "
            "sample, and `energy_J`, found in the simulator; no evidence, the checker lists it as "
            "told",
        ),
        (
            "worst_hand",
            "where the available storage settled something: `format`, `outcome`, `claim`, "
            "`assumptions`, in a saved file the `certificate`",
        ),
    )

    decision: Decision = known("what is known of the loop, at the worst corner where intervals were given")
    box: Loop | None = known("the loop with its intervals; None where it was not kept", default=None)
    asked: Contact = known("of which contact", default="made and broken")
    best_corner: Violation | Witness | None = known(
        "what shows that the best values of the intervals are active, and so all are; None for single values",
        default=None,
    )

    @cached_property
    def budget(self) -> Budget:
        """Leaks against dissipation at the tightest frequency."""
        return budget(self.decision)

    @cached_property
    @answers('the mechanism that binds, such as `"sampling against viscous damping"`')
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
    def _with_contact_broken(self) -> bool:
        """True where the numbers are those of contact made and broken, as the outcome is."""
        proved = self.outcome == "passive" and self.scope.contact == "made and broken"
        return self._in_contact_only or (proved and not self.decision.is_spring)

    @property
    @answers('how a violation shows itself: `"active tactile"`, `"closed-loop instability"`; null if passive')
    def mode(self) -> str | None:
        """How a violation shows itself (Abbott & Okamura 2005, section IV-C).

        None when passive, and for a motion that has to touch and leave.
        """
        if self.is_proved or self._in_contact_only:
            return None
        return "active tactile" if self.limit == QUANTIZATION else "closed-loop instability"

    @cached_property
    @answers(
        "largest passive stiffness, all else as given; null if none is, if any is, or if the law has none",
        quantity="stiffness",
    )
    def max_stiffness(self) -> float | None:
        """Largest passive stiffness K, all else as given [N/m; N·m/rad].

        inf if every stiffness is passive; None if none is, or the law has none (see `max_gain`).
        """
        return parameter_limits.max_stiffness(self.device, self.environment, self._with_contact_broken)

    @cached_property
    def stiffest(self) -> float | None:
        """The largest K that `check` calls passive, of contact as it was asked [N/m; N·m/rad]."""
        contact = self.environment.unilateral and self.asked != "kept"
        if self.decision.is_spring or contact == self._with_contact_broken:
            return self.max_stiffness
        return parameter_limits.max_stiffness(self.device, self.environment, contact)

    @cached_property
    def max_gain(self) -> float | None:
        """Largest passive factor on H(z), for a law without a stiffness of its own."""
        return parameter_limits.max_gain(self.device, self.environment, self._with_contact_broken)

    @cached_property
    @answers(quantity="damping")
    def required_damping(self) -> float | None:
        """Smallest device damping b that hold, delay and law need [N·s/m; N·m·s/rad].

        None if no damping would do.  Coulomb friction is a need of its own: see `margins`.
        """
        return parameter_limits.required_damping(self.decision, self._with_contact_broken)

    @property
    @answers(unit="Hz")
    def critical_frequency(self) -> float:
        """Frequency at which the linear criterion is tightest [Hz]."""
        return self.budget.frequency

    @cached_property
    @answers(
        "only for an active spring wall without delay: the speed of the hand up to which Coulomb friction "
        "still outweighs the leak of the hold, (2f_c − K Δ)/(K T − 2b)",
        quantity="velocity",
        optional=True,
    )
    def admissible_speed(self) -> float | None:
        """Hand speed up to which an active spring wall still gives out no energy [m/s; rad/s].

        v = (2f_c − K Δ)/(K T − 2b), for mean speeds over a sample: Coulomb friction outweighs the hold's leak
        of slow motions.  None where it does not apply: a passive loop, another law, a delay.
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
        friction = self.decision.contact_friction if self._with_contact_broken else friction
        b, setting = self.decision.loop.damping, self.decision.setting
        return {
            "damping": None if need is None else float(b - Fraction(repr(need))),  # exactly 0 at the limit
            "coulomb_friction": None if friction is None else float(setting.coulomb_friction - friction),
        }

    @cached_property
    def advice(self) -> tuple[Advice, ...]:
        """The smallest single changes that would do, or the slack of each parameter."""
        turning = self._advised()
        while True:
            try:
                next(turning)
            except StopIteration as end:
                return end.value  # type: ignore[no-any-return]

    def _easiest_first(self) -> Iterator[Advice]:
        if "advice" in vars(self):
            yield from super()._easiest_first()
        else:
            vars(self)["advice"] = yield from self._advised()  # where none would do, all were looked for

    def _advised(self) -> Advised:
        at, law = (self.device, self.environment), self.environment
        one_sided = law.unilateral and self.asked != "kept"
        proved = self.outcome == "passive"
        contact = self.scope.contact == "made and broken" if proved else one_sided and not self.is_proved
        or_kept = one_sided and not (proved or self._in_contact_only or self.decision.is_clamped)
        same = contact == self._with_contact_broken or self.decision.is_spring
        stiffest = (lambda: self.max_stiffness) if same else (lambda: None)
        return advise(Asked(at, self.box or at, contact), self.is_proved, or_kept, stiffest)

    @cached_property
    def actuator(self) -> tuple[ActuatorCheck, ...]:
        """Is the actuator close to the ideal that the claim assumes?"""
        stiffness = self.decision.loop.static_stiffness
        positive = stiffness is not None and stiffness > 0
        return actuator_checks(self.device, stiffness if positive else None)

    def curve(self, points: int = 400) -> tuple[list[float], list[float]]:
        """(frequency [Hz], damping the criterion asks for there [N·s/m]), for plotting only."""
        loop = self.decision.loop
        turns = [(k + 0.5) / points / 2 for k in range(points)]
        needs = loop.required_dampings_at([cos(2 * pi * t) for t in turns])
        return [t / float(loop.period) for t in turns], needs

    def evidence(self) -> dict[str, Any]:
        """Proofs and motions as plain data; of intervals those at the best corner too."""
        best = self.best_corner
        if best is None:
            return super().evidence()
        name = "violation" if isinstance(best, Violation) else "witness"
        return {**super().evidence(), "best_corner": {"outcome": "active", name: best.saved()}}

    def numbers(self) -> dict[str, Any]:
        """Limits, margins and advice as plain data, a unit in every key of a physical quantity."""
        gain = {} if parameter_limits.has_stiffness(self.environment) else {"max_gain": self.max_gain}
        checks = [{"name": c.name, "ok": c.ok, "text": c.text} for c in self.actuator]
        return {**super().numbers(), **gain, "actuator": checks}

    def rows(self) -> list[tuple[str, str]]:
        """The main numbers as (name, text) for a report."""
        unit, need = self.device.unit, self.required_damping
        if parameter_limits.has_stiffness(self.environment):
            most = ("largest passive stiffness", shown_at_most(self.max_stiffness, unit("stiffness"), 6))
        else:
            most = ("largest passive gain", shown_at_most(self.max_gain, "times this law", 6))
        enough = "no amount is proved enough" if need is None else shown_at_least(need, unit("damping"), 6)
        rows = [("limit", self.limit), most, ("required device damping", enough)]
        rows.append(("critical frequency", shown(self.critical_frequency, "Hz", 6)))
        for name, value in self.margins.items():
            rows.append((f"margin of {in_words(name)}", shown(value, unit(name), 6)))
        if self.admissible_speed is not None:
            rows.append(("slower hands are safe up to", shown(self.admissible_speed, unit("velocity"), 6)))
        return [*rows, *super().rows()]
