"""What was found of a loop: the outcome, the evidence for it, and the sentences that are made from both."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Literal, NamedTuple, TypeAlias

from zwidth.model.device import Device
from zwidth.model.environment.environment import Environment
from zwidth.passivity.advice import Advice, with_what_to_do
from zwidth.passivity.certificate import Certificate
from zwidth.passivity.criterion_choice import Decision
from zwidth.passivity.linear.criterion import LinearRefutation
from zwidth.passivity.result import PassivityAnswer
from zwidth.passivity.scope import Outcome, Scope, in_intervals
from zwidth.passivity.witness.violation import Violation, within_force
from zwidth.passivity.witness.witness import Witness
from zwidth.passivity.wording import (
    NOT_FOUND,
    UNWRITTEN,
    claim_of_a_motion,
    claim_of_passivity,
    describe_hands,
    intervals,
    lines,
    takes_any,
)
from zwidth.quantity.answered import known
from zwidth.quantity.exact import Exact, ends
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.text import in_words, shown, shown_at_least

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


def claim(verdict: Found, advice: Iterable[Advice] = ()) -> str:
    """What was found, how much and, of advice, what to do: the sentence of every report."""
    if verdict.outcome == "active":
        return _active(verdict, advice)
    proved = claim_of_passivity(verdict.scope, verdict.at_limit)
    if verdict.outcome == "passive":
        return with_what_to_do(proved, () if verdict.at_limit else advice, "passive")
    if verdict.outcome == "theorem":
        return f"By a proof on paper, without a certificate: {verdict.theorem}."
    if verdict.outcome == "undecided":
        known = " ".join([_undecided(verdict), *_by_bounded_hands(verdict)])
        return with_what_to_do(known.removesuffix("."), advice, "undecided")
    if verdict.outcome == "passive without encoder steps":
        return (
            f"Read without encoder steps: {proved}. With steps no Coulomb friction is enough for every "
            "scene, and of this one nothing is known."
        )
    return f"{proved}. {_of_one_that_leaves(verdict)}"


def _active(verdict: Found, advice: Iterable[Advice]) -> str:
    is_replayed = verdict.scope.transmission == "as given"  # no motion of two bodies is more than that
    if verdict.witness is not None and not is_replayed:
        return with_what_to_do(f"{taken(verdict.witness)}{_at(verdict)}", advice, "active")
    assert verdict.violation is not None
    any_amount = f"{takes_any('A hand', 'loop')} ({verdict.violation.describe()})"
    return with_what_to_do(f"{any_amount}{_at(verdict)}", advice, "active") + (
        "" if is_replayed else f" {UNWRITTEN}"
    )


def taken(moved: Moves) -> str:
    """What a motion takes out and how long it is, without its point."""
    lasts = moved.motion.samples * moved.sample_period
    return claim_of_a_motion(moved.energy, lasts, moved.depth, moved.peak_speed, moved.unit)


def _at(verdict: Found) -> str:
    """Of intervals, every value of which is active: at which the motion is."""
    where = where_active(verdict)
    return f" (at {where}; others do at every other value of its intervals)" if where else ""


def _of_one_that_leaves(verdict: Found) -> str:
    """What is known of a hand that touches and leaves, and how much damping would do for each of them."""
    known = next(_by_bounded_hands(verdict), "Of one that touches and leaves nothing is proved or refuted.")
    decision: Decision | None = getattr(verdict, "decision", None)  # of laws with H(z)
    if decision is None or decision.contact_damping is None or decision.contact_friction is None:
        return known
    if decision.contact_friction > decision.setting.coulomb_friction:
        return known
    needed = shown_at_least(float(decision.contact_damping), verdict.device.unit("damping"))
    return f"{known} With a device damping of {needed} every hand would be covered."


def assumptions(verdict: Found) -> tuple[str, ...]:
    """What the claim covers and takes for granted, line by line."""
    between = intervals(verdict.scope, verdict.outcome)
    return (*lines(verdict.scope, verdict.outcome), *([] if between is None else [between]))


def active_at(verdict: Found) -> dict[str, float]:
    """Of the parameters that are intervals the values at which energy was shown to come out, in SI."""
    if verdict.violation is None and verdict.motion is None:
        return {}
    own = {name: getattr(verdict.device, name, None) for name in verdict.scope.intervals}
    box = getattr(verdict, "box", None)  # of laws with H(z)
    law = {} if box is None else dict(in_intervals(box[1], verdict.environment))
    return {name: float(value) for name, value in {**own, **law}.items() if isinstance(value, Exact)}


def where_active(verdict: Found) -> str:
    """The same in words."""
    motion = verdict.scope.motion
    return ", ".join(
        f"{in_words(name)} {shown(value, GLOSSARY[name].unit_for(motion))}"
        for name, value in active_at(verdict).items()
    )


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
        found, moved = verdict.violation or verdict.motion, verdict.witness
        assert found is not None
        gains = found.describe() if moved is None else taken(moved).replace("A ", "a ", 1)
        return (
            f"Active for some values of its intervals: at {where_active(verdict)} {gains}. Of other values "
            "in them that is not known."
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
    unit = verdict.device.unit
    lacking = [
        f"{in_words(need.name)} of {shown_at_least(need.needed, unit(need.name))} is proved enough, and "
        f"there is {shown(need.has, unit(need.name))}"
        for need in verdict.needs
        if need.has < need.needed
    ]
    return f"{'; '.join([NOT_FOUND, *lacking])}."


def _open(decision: Decision) -> str:
    """What is proved on both sides where the loop itself is neither proved nor refuted."""
    if decision.is_clamped:
        return _clamped(decision)
    if isinstance(decision.viscous, LinearRefutation):
        if decision.viscous.reason == "too close to zero":
            return (
                "This loop is so close to its limit that to tell on which side would take more work than is "
                "spent on it. Give the law with fewer digits or of a lower order, or change the damping: "
                "the damping that is required is known, and is given with what is proved."
            )
        return (
            "No proof was found, and that energy comes out was not confirmed by the independent checker "
            "within its bounds."
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
    does = "no amount is proved enough" if need is None else f"{shown_at_least(float(need), unit)} is enough"
    edge = shown(least, unit)
    below = (
        f"straddling an encoder edge should gain below {edge}, yet no such motion was found short enough"
        if has < least
        else f"straddling an encoder edge gains only below {edge}"
    )
    return (
        "Viscous damping is enough, but for an encoder with this law no exact condition on Coulomb friction "
        f"is proved: {does}, {below}, and the device has {shown(has, unit)}."
    )


def _clamped(decision: Decision) -> str:
    """What is known of a clamped law that is not proved."""
    damping, friction = decision.contact_damping, decision.contact_friction
    if damping is None or friction is None:
        known = "and for this law and delay none that is enough."
    else:
        setting = decision.setting
        b, f = (GLOSSARY[name].unit_for(setting.motion) for name in ("damping", "coulomb_friction"))
        viscous, dry = shown_at_least(float(damping), b), shown_at_least(float(friction), f)
        known = (
            f"and what is proved enough is not there: damping of {viscous}, the device has "
            f"{shown(float(decision.loop.damping), b)}; Coulomb friction of {dry}, it has "
            f"{shown(float(setting.coulomb_friction), f)}."
        )
    return f"Of a law whose force is clamped no exact condition is known, {known}"
