"""The verdict on two arms that follow each other."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any, ClassVar

from zwidth.model.device import Device
from zwidth.model.pairs import Pair
from zwidth.passivity.advice import Advice, easiest_first, with_what_to_do
from zwidth.passivity.pairs.assumed import (
    assumed_of_arms,
    assumed_of_timing,
    compensation_numbers,
    compensation_rows,
    friction_goes_on,
)
from zwidth.passivity.pairs.criterion import PairCriterion, spending
from zwidth.passivity.pairs.evidence import PairCertificate, PairViolation, PairWitness
from zwidth.passivity.pairs.limits import (
    StiffnessAt,
    advise,
    is_passive,
    largest_compensation,
    largest_stiffness,
    required_damping,
    required_friction,
    stiffness_elsewhere,
    with_share,
)
from zwidth.passivity.pairs.motions import refute_criterion, refute_friction
from zwidth.passivity.pairs.slow import refute_compensation
from zwidth.passivity.result import PassivityAnswer, share_left
from zwidth.passivity.scope import Outcome, Scope
from zwidth.passivity.wording import NOT_FOUND, UNWRITTEN, takes, takes_any, takes_none
from zwidth.quantity.answered import answers, known
from zwidth.quantity.text import shown, shown_at_least, shown_at_most
from zwidth.showing import Lines, Part

_DIGITS = (2, 3, 4, 6, 9, 13)
"""Of what a move inside a sample loses at least, where more make a proof too long."""


_HANDS = "two hands, one on each arm"
NOTHING = "nothing is violated"
COMPENSATION = "compensation of friction: it gives more than friction is proved to take"
DRIVE = "damping of an arm: its own drive feeds more energy than it takes"
DAMPING = "damping of the arms: the hold, the delay and the link feed more energy than it takes"
FRICTION = "Coulomb friction: one count of the encoders feeds more energy than it takes"

LIMITS = (NOTHING, COMPENSATION, DRIVE, DAMPING, FRICTION)
"""Whatever may bind."""


def check_pair(pair: Pair) -> PairVerdict:
    """Decide whether two hands can ever take energy out of a pair of arms.

    Passive means that ∫ (f_l v_l + w f_f v_f) dt and what the spring between the arms holds at the start are
    never less than nothing in all, for every motion of both hands, the work of the follower counted
    w = K_l/K_f times.  Exactly if M(θ) ⪰ 0 at every frequency (`PairCriterion`) and Coulomb friction of each
    arm is at least

        f_c ≥ (K + 2 |B + D| m/T) Δ/2 + (K + 2 |B|/T) Δ'/2

    for B, B + D ≥ 0, Δ' the other's encoder and m the readings of its own that an arm takes in T, 1 without
    a drive.  Equality counts as passive.  Derivation: docs/theory/pairs.md.

    With compensation of friction it is passive if for some line above it, F tanh(v/v_s) ≤ h + s v, the same
    holds with f_c − h, b − s/2 and D − C − s/2; active if a motion gains; between the two undecided.

    Raises
    ------
    InputError
        If the sign of the criterion would take too long to decide.
    """
    wide = PairCriterion(pair)
    signs = None if wide.slips else wide.signs
    if signs is None or isinstance(signs, Fraction):
        violation = PairViolation(pair, signs)
        if violation.verify():
            return PairVerdict(pair, wide, violation=violation)
        return PairVerdict(pair, wide, motion=refute_criterion(wide))
    if wide.undamped:
        return PairVerdict(pair, wide)
    criterion = spending(pair)
    if max(criterion.missing_friction) > 0:
        motion = refute_compensation(pair) or refute_friction(wide)
        return PairVerdict(pair, criterion, motion=motion)
    if criterion.undamped or isinstance(criterion.signs, Fraction):
        return PairVerdict(pair, criterion, motion=refute_compensation(pair))
    wider = spending(pair, any_mean=True)
    if any(pair.compensations) and wider.proves:
        criterion = wider
    return PairVerdict(pair, criterion, certificate=_certificate(criterion))


def _certificate(criterion: PairCriterion) -> PairCertificate | None:
    """One that the checker accepts; of many readings of a drive with numbers of fewer digits."""
    many = criterion.pair.own_readings > 1
    for digits in (0, *(_DIGITS if many else ())):
        own = criterion.with_few_digits(digits) if digits else criterion
        if own.slips or isinstance(own.signs, Fraction):
            continue
        found = PairCertificate(own.pair, own.signs, own.tangents, own.any_mean, own.losses)
        if found.verify():
            return found
    return None


def has_and_needs(device: Device, key: str, need: float | None) -> str:
    """What an arm has of a number, and what it needs of it."""
    unit = device.unit(key)
    enough = "none is enough" if need is None else f"{shown_at_least(need, unit)} needed"
    return f"{shown(getattr(device, key), unit)}, {enough}"


@dataclass(frozen=True, repr=False)
class PairVerdict(PassivityAnswer):
    """Whether two hands can take energy out of a pair of arms."""

    _FORMAT: ClassVar[str] = "zwidth pair 1"
    _PICTURE: ClassVar[str] = "plot_pair"
    _BESIDES = (
        (
            "power_ratio",
            "how often the work of the follower's hand counts, K_l/K_f; 1 where both springs are the same",
        ),
        (
            "largest_compensation",
            "only where friction is compensated: how much of it is passive, as a multiple of F and C "
            "on both sides; null if none is",
        ),
        (
            "compensation_takes",
            "only where friction is compensated: `leader` and `follower`, each with "
            "`coulomb_friction_N` and `damping_N_s_per_m` that it takes at most",
        ),
        (
            "certificate, violation, witness",
            "the proof; the violation and the motion of both hands, or one of them",
        ),
    )

    pair: Pair = known("what was asked")
    criterion: PairCriterion = known("what decided it, encoders and Coulomb friction aside")
    certificate: PairCertificate | None = None
    violation: PairViolation | None = None
    motion: PairWitness | None = None

    @cached_property
    def witness(self) -> PairWitness | None:
        """A motion of both hands that takes energy out; None where none that is short enough was found."""
        return self.motion if self.violation is None else refute_criterion(PairCriterion(self.pair))

    @property
    def outcome(self) -> Outcome:
        """ "passive", "active" or "undecided"."""
        if self.certificate is not None:
            return "passive"
        return "undecided" if self.violation is None and self.motion is None else "active"

    @property
    def found(self) -> str:
        """What was found and how much, without its point."""
        if self.outcome == "passive":
            return f"{takes_none(_HANDS, 'pair')}{friction_goes_on(self.pair)}"
        if self.outcome == "undecided":
            return NOT_FOUND
        if self.witness is None:
            return takes_any(_HANDS.capitalize(), "pair")
        return takes(f"{_HANDS},", self.witness.energy, "pair", self.witness.duration)

    @cached_property
    def claim(self) -> str:
        """What was found, how much, and what to do."""
        unwritten = f" {UNWRITTEN}" if self.outcome == "active" and self.witness is None else ""
        return f"{with_what_to_do(self.found, easiest_first(self.advice), self.outcome)}{unwritten}"

    @property
    def scope(self) -> Scope:
        """Two hands, without limit, and what of the encoders is counted."""
        steps = any(side.resolution for side in self.pair.sides)
        return Scope(
            contact="both sides", encoder="counted" if steps else "ideal", motion=self.pair.leader.motion
        )

    def _assumptions(self) -> Iterator[str]:
        pair = self.pair
        yield "two hands without limit on speed and force, one on each arm; the masses play no part"
        yield "both arms move freely: what the spring between them holds at the start may come back"
        if pair.power_ratio != 1:
            ratio = float(pair.power_ratio)
            yield (
                f"the two springs differ, so the energy of the follower's hand counts {ratio:.6g} times: "
                "with hands that are passive each by itself the whole is stable; one body that holds both "
                "arms is not covered"
            )
        yield from assumed_of_timing(self.criterion, self.passive)
        yield from assumed_of_arms(pair)

    @cached_property
    @answers(quantity="stiffness")
    def largest_stiffness(self) -> float | None:
        """The largest K, both sides in proportion and all else as it is, that is passive; None if none is."""
        return largest_stiffness(self.pair)

    @cached_property
    def required_damping(self) -> tuple[float | None, float | None]:
        """The least b of leader and follower, each with the other's as it is; None if none is enough."""
        return required_damping(self.pair, "leader"), required_damping(self.pair, "follower")

    @cached_property
    def required_friction(self) -> tuple[float | None, float | None]:
        """The least f_c of leader and follower [N; N·m], each with the other's as it is.

        For the steps of both encoders and the compensation of friction; None where none is enough.
        """
        return required_friction(self.pair, "leader"), required_friction(self.pair, "follower")

    @property
    @answers(
        "object with `leader` and `follower`, each with `damping_N_s_per_m`, the least b with the other's as "
        "it is, null if none is enough, and `coulomb_friction_N`, the least f_c for the steps of both "
        "encoders and for what compensates friction, null if none is enough",
        quantities=True,
    )
    def required(self) -> Mapping[str, Mapping[str, float | None]]:
        """The least b and f_c of either arm, by arm and quantity."""
        needs = zip(("leader", "follower"), self.required_damping, self.required_friction, strict=True)
        return {name: {"damping": damping, "coulomb_friction": dry} for name, damping, dry in needs}

    @cached_property
    def largest_compensation(self) -> float | None:
        """How much of the compensation of friction is passive, as a multiple of F and C on both sides.

        None where nothing is compensated, or where the pair is not passive without.
        """
        return largest_compensation(self.pair)

    @cached_property
    @answers(
        '`parameter` is `"leader.damping"`, `"follower.resolution"`, … where it is of one arm; `"damping"` '
        'and `"coulomb_friction"` are of both arms'
    )
    def advice(self) -> tuple[Advice, ...]:
        """The smallest single changes that would do, or the slack of each number."""
        return advise(self.pair, self.passive)

    @cached_property
    @answers("list of objects, below", key="largest_stiffness_at")
    def stiffness_elsewhere(self) -> tuple[StiffnessAt, ...]:
        """How stiff the coupling could be at half the link delay, and at twice the rate."""
        return stiffness_elsewhere(self.pair)

    @cached_property
    def _spoiled(self) -> bool:
        """Whether without compensation of friction it would be passive, and is not proved so with it."""
        return any(self.pair.compensations) and is_passive(with_share(self.pair, Fraction(0)))

    def _left(self) -> float | None:
        """Of the largest stiffness of the coupling."""
        return share_left(float(self.pair.felt_stiffness), self.largest_stiffness)

    @property
    @answers()
    def limit(self) -> str:
        """What binds."""
        if self.outcome == "passive":
            return NOTHING
        if self._spoiled:
            return COMPENSATION
        if self.criterion.slips:
            return DRIVE
        if not self.criterion.holds:
            return DAMPING
        if max(self.criterion.missing_friction) > 0:
            return FRICTION
        return NOTHING

    def rows(self) -> Iterator[tuple[str, str]]:
        """The main numbers."""
        pair = self.pair
        yield "coupling", pair.describe()
        yield "limit", self.limit
        largest, proved = self.largest_stiffness, "proved" if any(pair.compensations) else "passive"
        yield (
            "largest stiffness",
            f"none is {proved}"
            if largest is None
            else f"{shown_at_most(largest, pair.leader.unit('stiffness'))} with all else as it is",
        )
        for name, needs in self.required.items():
            device: Device = getattr(pair, name)
            for key, need in needs.items():
                if key == "damping" or need != 0:
                    yield f"{key.removeprefix('coulomb_')} of the {name}", has_and_needs(device, key, need)
        yield from compensation_rows(self.criterion, self.largest_compensation)
        evidence = self.witness if self.outcome == "active" else None
        if self.violation is not None:
            yield "violated", self.violation.describe()
        if evidence is not None:
            yield "motion", evidence.describe()

    def advised(self) -> Iterator[Part]:
        """What to change, or what is left."""
        found = [advice.text for advice in self.advice if advice.to is not None]
        found += [other.text for other in self.stiffness_elsewhere]
        if found:
            yield "slack:" if self.passive else "what to change, any one of:"
            yield Lines(found)

    def numbers(self) -> dict[str, Any]:
        """The main numbers as plain data, a unit in every key of a physical quantity."""
        return {
            **compensation_numbers(self.criterion, self.largest_compensation),
            "power_ratio": float(self.pair.power_ratio),
            **super().numbers(),
        }
