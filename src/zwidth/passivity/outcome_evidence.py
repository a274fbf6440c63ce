"""What was found of a loop: the outcome, the evidence for it, and the sentences that are made from both."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, Literal, NamedTuple, TypeAlias

from zwidth.model.device import Device
from zwidth.model.environment.environment import Environment
from zwidth.passivity.certificate import Certificate
from zwidth.passivity.criterion_choice import Decision
from zwidth.passivity.linear.criterion import LinearRefutation
from zwidth.passivity.result import PassivityAnswer
from zwidth.passivity.scope import Outcome, Scope
from zwidth.passivity.witness.violation import Violation, within_force
from zwidth.passivity.witness.witness import Witness
from zwidth.passivity.wording import claim_of_passivity, describe_hands, intervals, lines
from zwidth.quantity.answered import known
from zwidth.quantity.exact import Exact, Interval, ends
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.parameter import Parametric, parameters_of
from zwidth.quantity.text import enough, in_unit, in_words, shown

if TYPE_CHECKING:
    from zwidth.passivity.formulas.nonlinear_spring import EndlessPull
    from zwidth.passivity.storage import AvailableStorage
    from zwidth.passivity.storage.gain import Gain
    from zwidth.passivity.witness.elastic import ElasticViolation
    from zwidth.passivity.witness.replayed import ReplayedMotion

Moves: TypeAlias = "Witness | Gain | ReplayedMotion"
"""A motion that takes energy out: checked, or replayed in the simulator alone."""


Finding = Literal[
    "open",
    "unconfirmed",
    "between corners",
    "depends on values",
    "no lowest energy",
    "no coupling",
    "no coupling is enough",
]
"""Why a loop is undecided: neither shown; a proof that the checker did not confirm; proved at the corners of
intervals and not between them; active at one corner and not at others; a spring that pulls away for ever, but
no more than Coulomb friction holds; a scene without a coupling; one behind a coupling that loses nothing."""


class Need(NamedTuple):
    """What is enough of "damping" [N·s/m; N·m·s/rad] or "coulomb_friction" [N; N·m], and what there is."""

    name: str
    needed: float
    has: float


@dataclass(frozen=True, repr=False)
class Found(PassivityAnswer):
    """What was found of a sampled loop: the outcome, what it is about, and the evidence."""

    outcome: Outcome = known(
        '"passive", "passive in contact", "passive without encoder steps", "theorem", "active" or "undecided"'
    )
    scope: Scope = known("what it is about: hands, contact, encoder, actuator")
    device: Device = known("the one decided: of the worst corner where intervals were given")
    environment: Environment = known("likewise")
    certificate: Certificate | None = known('the proof of "passive"; else None', default=None)
    violation: Violation | EndlessPull | ElasticViolation | None = known(
        'what of the linear criterion is violated, a proof of "active"; or so at the worst corner of an '
        "interval; None for a loop that is active by its encoder, or by contact made and broken",
        default=None,
    )
    motion: Witness | Gain | None = known("where it was needed to decide; see `witness`", default=None)
    available_storage: AvailableStorage | None = known(
        "what value iteration adds, where the closed forms leave a gap: a motion, then also the `witness`; "
        "or a proof for hands within bounds",
        default=None,
    )
    finding: Finding = known("why it is undecided", default="open")
    at_limit: bool = known("True where the least less of b or f_c would lose the proof", default=False)
    theorem: str = known('what is proved on paper, where the outcome is "theorem"', default="")
    needs: tuple[Need, ...] = known("what of the device is proved enough, where that is known", default=())

    @property
    def is_proved(self) -> bool:
        """True for "passive" and for "passive in contact"."""
        return self.outcome in ("passive", "passive in contact")

    @cached_property
    def witness(self) -> Moves | None:
        """The motion that takes energy out, made when it is first asked for.

        None where the loop is not active, or no motion that was found is short enough to be written down.
        Where it asks for more than the force limit of the device, one that does not is tried first.
        """
        if self.motion is not None or self.violation is None:
            return self.motion
        found, limit = self.violation.witness, self.device.force_limit
        if limit is None or not isinstance(found, Witness) or found.peak_force <= (most := ends(limit)[0]):
            return found
        return within_force(found.setting, most) or found


def claim(verdict: Found) -> str:
    """The verdict in a sentence or two."""
    if verdict.outcome == "active":
        where = (
            f", at every value of its intervals; at {where_active(verdict)}" if active_at(verdict) else ":"
        )
        if verdict.violation is not None:
            gains = verdict.violation.describe()
            return f"The hand can take any amount of energy out of this loop{where} {gains}."
        assert verdict.witness is not None
        return f"A motion of the hand takes energy out of this loop{where} {verdict.witness.describe()}."
    if verdict.outcome == "theorem":
        return f"By a proof on paper, without a certificate: {verdict.theorem}."
    if verdict.outcome == "undecided":
        return " ".join([_undecided(verdict), *_by_bounded_hands(verdict)])
    proved = claim_of_passivity(verdict.scope, verdict.at_limit)
    if verdict.outcome == "passive without encoder steps":
        return (
            f"Read without encoder steps: {proved} With steps no Coulomb friction is enough for every scene, "
            "and of this one nothing is known."
        )
    if verdict.outcome == "passive":
        return proved
    open_still = ["Of one that touches and leaves nothing is proved or refuted."]
    return " ".join([proved, *(list(_by_bounded_hands(verdict)) or open_still)])


def assumptions(verdict: Found) -> tuple[str, ...]:
    """What the claim covers and takes for granted, line by line."""
    between = intervals(verdict.scope, verdict.outcome)
    return (*lines(verdict.scope, verdict.outcome), *([] if between is None else [between]))


def active_at(verdict: Found) -> dict[str, float]:
    """Of the parameters that are intervals the values at which energy was shown to come out, in SI."""
    if verdict.violation is None and verdict.motion is None:
        return {}
    own = {name: getattr(verdict.device, name, None) for name, *_ in verdict.scope.bounds}
    box = getattr(verdict, "box", None)  # of laws with H(z)
    law = {} if box is None else dict(_chosen(box[1], verdict.environment))
    return {name: float(value) for name, value in {**own, **law}.items() if isinstance(value, Exact)}


def where_active(verdict: Found) -> str:
    """The same in words."""
    motion = verdict.scope.motion
    return ", ".join(
        f"{in_words(name)} {shown(value, GLOSSARY[name].unit_for(motion))}"
        for name, value in active_at(verdict).items()
    )


def _chosen(given: Any, at: Any) -> Iterator[tuple[str, Any]]:
    """By the names of the glossary, what stands in the place of intervals at any depth."""
    for name, one in parameters_of(type(given)).items():
        value = getattr(given, name)
        if isinstance(value, Interval):
            yield one.quantity.name, getattr(at, name)
        elif isinstance(value, Parametric):
            yield from _chosen(value, getattr(at, name))


_ROADS = {
    "spring": "the closed conditions of a spring",
    "contact": "the closed conditions of a damped wall, contact made and broken",
    "relaxing contact": "the closed conditions of a law that relaxes, contact made and broken",
    "multiplier contact": "a multiplier, contact made and broken",
    "linear": "the linear criterion",
    "quantized": "the linear criterion, and a bound on the force error of the encoder",
    "delays": "the linear criterion, for every delay of the interval",
    "nonlinear spring": "the slopes of the spring",
    "force bounding": "force bounding, the last law in the row",
}
"""By kind of certificate."""


def decided_by(verdict: Found) -> str:
    """The road on which the outcome was found."""
    if "behind a coupling" in verdict.scope.law:
        return "the condition on the coupling, whatever passive scene stands behind it"
    if verdict.certificate is not None:
        documents = verdict.certificate.documents
        return "; ".join(dict.fromkeys(_ROADS.get(d["kind"], d["kind"]) for d in documents))
    if verdict.outcome == "theorem":
        return "a proof on paper"
    if verdict.outcome == "undecided":
        return "nothing"
    if verdict.violation is not None:
        return "the linear criterion" if hasattr(verdict, "decision") else "the ends of the spring"
    return "a motion" if verdict.available_storage is None else "a motion found by value iteration"


def _by_bounded_hands(verdict: Found) -> Iterator[str]:
    """What is proved of hands within bounds, contact made and broken."""
    found = verdict.available_storage
    if found is not None and found.outcome == "passive":
        hands = describe_hands(found.scope.hands, found.scope.motion)
        yield f"Contact made and broken: proved passive for {hands}."


def _undecided(verdict: Found) -> str:
    if verdict.finding == "unconfirmed":
        return "A proof was found, but the independent checker did not confirm it within its bounds."
    if verdict.finding == "between corners":
        return (
            "Passive at every corner of the intervals; that every value between them is too is not proved "
            "for intervals of these parameters together."
        )
    if verdict.finding == "depends on values":
        found = verdict.violation or verdict.motion
        assert found is not None
        return (
            f"Active for some values of its intervals: at {where_active(verdict)} {found.describe()}. Of "
            "other values in them that is not known."
        )
    if verdict.finding == "no lowest energy":
        return (
            "Beyond an end the spring pulls away, with no more than Coulomb friction holds: its potential "
            "has no lowest value, and no proof for that is known."
        )
    if verdict.finding == "no coupling":
        return (
            "Of a scene that is not linear, or of many elements, a proof is known only behind a virtual "
            "coupling: zwidth.VirtualCoupling(stiffness, damping, scene)."
        )
    if verdict.finding == "no coupling is enough":
        return (
            "The coupling's damping takes away as much as its stiffness holds, K T + 2 B ≤ 0: no damping of "
            "the device is enough for every scene behind it."
        )
    decision: Decision | None = getattr(verdict, "decision", None)  # of laws with H(z)
    return _not_found(verdict) if decision is None else _open(decision)


def _not_found(verdict: Found) -> str:
    """What is known of a law without H(z)."""
    found = "Neither a proof for every hand nor a motion that takes energy out was found"
    unit = verdict.device.unit
    lacking = [
        f"{in_words(need.name)} of {enough(need.needed, unit(need.name))} is proved enough, and there is "
        f"{in_unit(need.has, unit(need.name))}"
        for need in verdict.needs
        if need.has < need.needed
    ]
    return f"{'; '.join([found, *lacking])}."


def _open(decision: Decision) -> str:
    """What is proved on both sides where the loop itself is neither proved nor refuted."""
    if decision.is_clamped:
        return _clamped(decision)
    if isinstance(decision.viscous, LinearRefutation):
        if decision.viscous.reason == "too close to zero":
            return (
                "The linear criterion comes so close to zero that to tell its sign would take more work than "
                "is spent on it. Give the law with fewer digits or of a lower order, or change the damping: "
                "the damping that is required is known, and is given with what is proved."
            )
        return (
            f"Passivity cannot be proved ({decision.viscous.reason}); that energy comes out was not "
            "confirmed by the independent checker within its bounds."
        )
    if not decision.loop.hidden_modes_decay:
        return (
            "Numerator and denominator of H(z) share a root on or outside the unit circle. The port does not "
            "see it, but the controller as written carries a mode that never dies out: cancel it and check "
            "again."
        )
    need, least = decision.sufficient_friction, decision.necessary_friction
    has = float(decision.setting.coulomb_friction)
    unit = GLOSSARY["coulomb_friction"].unit_for(decision.setting.motion)
    does = "no amount is proved enough" if need is None else f"{enough(float(need), unit)} is enough"
    edge = in_unit(least, unit)
    below = (
        f"straddling an encoder edge should gain below {edge}, yet no such motion was found short enough"
        if has < least
        else f"straddling an encoder edge gains only below {edge}"
    )
    return (
        "Viscous damping is enough, but for an encoder with this law no exact condition on Coulomb friction "
        f"is proved: {does}, {below}, and the device has {in_unit(has, unit)}."
    )


def _clamped(decision: Decision) -> str:
    """What is known of a clamped law that is not proved."""
    damping, friction = decision.contact_damping, decision.contact_friction
    if damping is None or friction is None:
        known = "and no other condition is known for this law and delay."
    else:
        loop, has, motion = decision.loop, float(decision.setting.coulomb_friction), decision.setting.motion
        b, f = (GLOSSARY[name].unit_for(motion) for name in ("damping", "coulomb_friction"))
        known = (
            f"and what is proved enough is not there: damping of {enough(float(damping), b)}, the device "
            f"has {in_unit(float(loop.damping), b)}; Coulomb friction of {enough(float(friction), f)}, it "
            f"has {in_unit(has, f)}."
        )
    return f"The linear criterion does not cover a law whose force is clamped, {known}"
