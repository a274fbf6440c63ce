"""The verdict on a pair of which a known hand, or nobody, holds one arm: does the other hand gain?

Only what the independent checker accepts makes it "passive" or "active".
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any, ClassVar

from zwidth.errors import InputError
from zwidth.loop.sampled_plant import Motion
from zwidth.model.pairs import Pair
from zwidth.passivity.advice import Advice
from zwidth.passivity.linear.boundary import largest_holding, smallest_holding
from zwidth.passivity.linear.criterion import LinearProof, decide_linear
from zwidth.passivity.linear.loop import LinearLoop
from zwidth.passivity.linear.one_norm import bound_one_norm
from zwidth.passivity.pairs.assumed import assumed_of_arms, assumed_of_timing, friction_goes_on
from zwidth.passivity.pairs.criterion import PairCriterion
from zwidth.passivity.pairs.evidence import PairCertificate
from zwidth.passivity.pairs.held.evidence import HeldCertificate, HeldViolation, HeldWitness, gaining_wave
from zwidth.passivity.pairs.held.law import ANY, HeldPair, felt_loop, held_pair
from zwidth.passivity.pairs.limits import StiffnessAt, grain_of, is_passive, largest_stiffness
from zwidth.passivity.pairs.verdict import check_pair, has_and_needs
from zwidth.passivity.result import PassivityAnswer, share_left
from zwidth.passivity.scope import Hands, Outcome, Scope
from zwidth.passivity.wording import NOT_FOUND, UNWRITTEN, takes, takes_any, takes_none
from zwidth.quantity.answered import answers, known
from zwidth.quantity.exact import ends
from zwidth.quantity.text import shown, shown_at_most


def check_held_pair(pair: Pair, leader: Any = ANY, follower: Any = ANY) -> HeldVerdict:
    """Decide whether the hand on one arm can take energy out while a known hand holds the other.

    From rest, linear and computed once a sample, the free arm's hand feels one law H(z), with the held arm
    behind it; so exactly if that arm comes to rest in its hand and

        b ≥ (T/2) Re{(1 − e^{−jωT}) H(e^{jωT})}/(1 − cos ωT),  0 < ω ≤ π/T,

    and Coulomb friction of the free arm covers the steps of both encoders; at equality it is undecided.
    Where two hands that do what they like gain nothing although the held arm has but the hand's damping
    more, it is passive with whatever else is in that hand.  Derivation: docs/theory/pairs.md.

    Parameters
    ----------
    pair
        The held arm with its mass.
    leader, follower
        What holds the arm, on one of them: None for nobody; a `HandImpedance`, whose numbers may be
        intervals; or a linear operator, whose push is left out.  "any" on the other.

    Raises
    ------
    InputError
        If not just one arm is held, or the hand is none.
    """
    question = held_pair(pair, leader, follower)
    damped = check_pair(question.damped)
    if damped.passive:
        return HeldVerdict(question, damped.certificate)
    criterion = HeldCriterion(question)
    found = HeldCertificate(question)
    if criterion.holds and found.verify():
        return HeldVerdict(question, found)
    violation = criterion.violation
    return HeldVerdict(question, violation=violation if violation and violation.verify() else None)


@dataclass(frozen=True, repr=False)
class HeldVerdict(PassivityAnswer):
    """Whether the hand on one arm of a pair can take energy out while a known hand holds the other."""

    _FORMAT: ClassVar[str] = "zwidth held pair 1"
    _PICTURE: ClassVar[str] = "plot_held_pair"
    _BESIDES = (
        ("held", "object with `arm` and `hand`, in words"),
        (
            "largest_stiffness_N_per_m_with_any_such_hand",
            "with anything passive beside a damper as large as the hand's",
        ),
        ("largest_stiffness_N_per_m_with_two_hands", "with a hand that does what it likes"),
        (
            "required",
            "object with the free arm: its `damping_N_s_per_m`, null if none is known to be enough, "
            "and `coulomb_friction_N` for the steps of both encoders, null if none is",
        ),
        (
            "certificate, violation, witness",
            "the proof, of kind `held pair`, or `pair` of the arms with the hand's damping; the "
            "frequency at which a motion gains, and one that does, if it is short enough",
        ),
    )

    question: HeldPair = known("the pair, which arm is held, and by what")
    certificate: PairCertificate | HeldCertificate | None = None
    violation: HeldViolation | None = None
    advice: tuple[Advice, ...] = ()
    stiffness_elsewhere: tuple[StiffnessAt, ...] = ()

    @property
    def pair(self) -> Pair:
        """The two arms."""
        return self.question.pair

    @property
    def outcome(self) -> Outcome:
        """ "passive", "active" or "undecided"."""
        if self.certificate is not None:
            return "passive"
        return "undecided" if self.violation is None else "active"

    @cached_property
    def witness(self) -> HeldWitness | None:
        """A motion of the free arm that takes energy out; None where none that is short enough was found."""
        return None if self.violation is None else gaining_wave(self.violation)

    @property
    def with_any_such_hand(self) -> bool:
        """True where it is passive with whatever else is in the hand, so it damps as much."""
        return isinstance(self.certificate, PairCertificate)

    @property
    def claim(self) -> str:
        """The outcome in a sentence."""
        free = self.question.free
        if self.outcome == "passive":
            goes_on = friction_goes_on(self.pair)
            return f"{takes_none(f'a hand on the {free}', 'pair')} {self._while}{goes_on}."
        if self.outcome == "active":
            hand = "this hand" if self.question.motion.is_certain else "one of these hands"
            by = "nobody" if self.question.hand.is_nobody else hand
            held = f"while {by} holds the {self.question.held}"
            if self.witness is None:
                return f"{takes_any(f'A hand on the {free}', 'pair')}, {held}. {UNWRITTEN}"
            taken = takes(f"a hand on the {free}", self.witness.energy, "pair", self.witness.duration)
            return f"{taken}, {held}."
        return f"{NOT_FOUND}."

    @property
    def _hand(self) -> str:
        return self.question.hand.describe(self.pair.motion)

    @property
    def _while(self) -> str:
        held = self.question.held
        if not self.with_any_such_hand:
            by = "nobody" if self.question.hand.is_nobody else f"just this hand ({self._hand})"
            return f"while {by} holds the {held}"
        least = ends(self.question.hand.damping)[0]
        if not least:
            return f"whatever holds the {held}, if that is passive"
        damps = shown(float(least), self.pair.leader.unit("damping"))
        return f"whatever holds the {held}, if that is passive beside a damper of {damps} or more"

    @property
    def scope(self) -> Scope:
        """One hand without limit, the other known."""
        steps = any(side.resolution for side in self.pair.sides)
        return Scope(
            hands=Hands() if self.with_any_such_hand else Hands(impedance=self._hand),
            contact="both sides",
            encoder="counted" if steps else "ideal",
            motion=self.pair.motion,
        )

    def _assumptions(self) -> Iterator[str]:
        free, held = self.question.free, self.question.held
        yield f"a hand on the {free} without limit on speed and force; its mass plays no part"
        if self.with_any_such_hand:
            yield f"what holds the {held} gives out no energy of its own"
        else:
            yield (
                f"nobody holds the {held}"
                if self.question.hand.is_nobody
                else (
                    f"the {held} is held by {self._hand}, fixed to the arm and to a place, which pushes with "
                    "nothing of its own"
                )
            )
            yield f"mass and damping of the {held} are just those given, and both arms start at rest"
            if self.outcome == "active":
                yield f"friction and encoders do not help against large motions of the {free}"
            else:
                yield f"no Coulomb friction in the {held}"
                if self.scope.encoder == "counted":
                    yield "what the springs hold at the start for half a count of each reading may come back"
        yield from assumed_of_timing(PairCriterion(self.pair), self.with_any_such_hand)
        yield from assumed_of_arms(self.pair)

    @cached_property
    @answers(quantity="stiffness")
    def largest_stiffness(self) -> float | None:
        """The largest K, both sides in proportion and all else as it is, that is passive; None if none is.

        With intervals at each of their corners.
        """
        return largest_held_stiffness(self.question)

    @cached_property
    def largest_stiffness_of_any_such_hand(self) -> float | None:
        """The same where the hand is anything passive that damps as much."""
        return largest_stiffness(self.question.damped)

    @cached_property
    def largest_stiffness_of_two_hands(self) -> float | None:
        """The same where both hands do what they like."""
        return largest_stiffness(self.pair)

    @cached_property
    def required_damping(self) -> float | None:
        """The least b of the free arm, encoders aside; None if none is enough, or none is known to be."""
        return required_free_damping(self.question)

    @cached_property
    def required_friction(self) -> float | None:
        """The least f_c of the free arm for both encoders; None if none is known to be enough."""
        criterion = HeldCriterion(self.question)
        if criterion.bends or not criterion.holds:
            return None
        need = criterion.required_friction
        return None if need is None else float(need)

    def _left(self) -> float | None:
        """Of the largest stiffness of the coupling."""
        return share_left(float(self.pair.felt_stiffness), self.largest_stiffness)

    @property
    @answers()
    def limit(self) -> str:
        """What binds."""
        criterion, free = HeldCriterion(self.question), self.question.free
        if self.passive:
            return "nothing is violated"
        if self.violation is not None:
            return f"damping of the {free}: hold, delays and the {self.question.held} feed more than it takes"
        if criterion.bends:
            return f"{criterion.bends}: only what two hands gain is proved"
        if not criterion.holds:
            return f"the {self.question.held} may not come to rest by itself, or this is too near the limit"
        return "Coulomb friction: the steps of the encoders may feed more energy than it takes"

    def rows(self) -> Iterator[tuple[str, str]]:
        """The main numbers."""
        unit = self.pair.leader.unit("stiffness")
        free = self.question.free
        yield "coupling", self.pair.describe()
        yield f"on the {self.question.held}", "nobody" if self.question.hand.is_nobody else self._hand
        yield "limit", self.limit
        for name, value in (
            ("largest stiffness", self.largest_stiffness),
            ("with anything that damps as much", self.largest_stiffness_of_any_such_hand),
            ("with two hands that do anything", self.largest_stiffness_of_two_hands),
        ):
            yield name, "none is passive" if value is None else shown_at_most(value, unit)
        device = getattr(self.pair, free)
        for name, key, need in (
            (f"damping of the {free}", "damping", self.required_damping),
            (f"friction of the {free}", "coulomb_friction", self.required_friction),
        ):
            if need:
                yield name, has_and_needs(device, key, need)
        if self.violation is not None:
            yield "violated", self.violation.describe()
        if self.witness is not None:
            yield "motion", self.witness.describe()

    def numbers(self) -> dict[str, Any]:
        """The main numbers as plain data, a unit in every key of a physical quantity."""
        key, hand = self.pair.leader.key, self.question.hand
        stiffness = f"largest_{key('stiffness')}"
        need = {key("damping"): self.required_damping, key("coulomb_friction"): self.required_friction}
        return {
            **super().numbers(),
            "held": {"arm": self.question.held, "hand": "nobody" if hand.is_nobody else self._hand},
            f"{stiffness}_with_any_such_hand": self.largest_stiffness_of_any_such_hand,
            f"{stiffness}_with_two_hands": self.largest_stiffness_of_two_hands,
            "required": {self.question.free: need},
        }


# The law that the free arm's hand feels is linear where no arm compensates friction, none reads itself more
# often than it sends, and the held one is without Coulomb friction.  Then the criterion of one arm decides,
# at every corner of the hand's intervals; what lies between them is for the checker.  Whatever the criterion
# of two hands covers, with the hand's damping in the held arm, needs none of this.


class HeldCriterion:
    """The criterion of one arm before the law that it feels, at the corners of the hand's intervals."""

    def __init__(self, question: HeldPair) -> None:
        self.question = question

    @cached_property
    def bends(self) -> str:
        """Why the law that is felt is not linear, or not felt once a sample; "" where it is."""
        pair, held = self.question.pair, self.question.held
        if pair.own_readings > 1:
            return "an arm reads itself more often than it sends"
        if any(pair.compensations):
            return "friction is compensated, and not in proportion to anything"
        if self.question.arms[1].side.coulomb_friction:
            return f"with Coulomb friction of the {held} what is felt depends on how far it moves"
        return ""

    @cached_property
    def corners(self) -> list[tuple[Motion, LinearLoop, LinearLoop]]:
        """Arm and hand, the law that is felt, and what half counts of the held arm's encoder do."""
        return [(motion, *felt_loop(self.question, motion)) for motion in self.question.motion.grid(2)]

    @property
    def violation(self) -> HeldViolation | None:
        """A frequency at which a motion gains, with one of the hands; whatever friction there is."""
        if self.question.pair.own_readings > 1 or any(self.question.pair.compensations):
            return None
        for motion, law, _ in self.corners:
            found = decide_linear(law)
            if not isinstance(found, LinearProof) and found.cosine is not None:
                return HeldViolation(self.question, motion, found.cosine)
        return None

    @property
    def holds(self) -> bool:
        """True where the law is passive at every corner, encoders aside."""
        return not self.bends and all(
            law.hidden_modes_decay and isinstance(decide_linear(law), LinearProof)
            for _, law, _ in self.corners
        )

    @cached_property
    def required_friction(self) -> Fraction | None:
        """Coulomb friction of the free arm for both encoders, at the corners; None where none is enough."""
        free, held = (arm.side for arm in self.question.arms)
        most = Fraction(0)
        for _, law, stray in self.corners:
            total = Fraction(0)
            for loop, resolution in ((law, free.resolution), (stray, held.resolution)):
                bound = bound_one_norm(loop) if resolution else None
                if resolution and bound is None:
                    return None
                total += bound.bound * resolution / 2 if bound else 0
            most = max(most, total)
        return most

    @property
    def covers_encoders(self) -> bool:
        """True where the free arm's friction is enough for them."""
        need = self.required_friction
        return need is not None and need <= self.question.arms[0].side.coulomb_friction


def is_held_passive(question: HeldPair) -> bool:
    """True where two hands may do what they like, the hand's damping counted; or this one is held."""
    if is_passive(question.damped):
        return True
    criterion = HeldCriterion(question)
    return criterion.holds and criterion.covers_encoders


def largest_held_stiffness(question: HeldPair) -> float | None:
    """The largest K, both sides in proportion, up from which it is no longer passive; None if none is."""

    def holds(k: Fraction) -> bool:
        return not k or _or_false(lambda: is_held_passive(question.stiffened(k)))

    return largest_holding(holds, float(question.pair.felt_stiffness), grain_of(question.pair)) or None


def required_free_damping(question: HeldPair) -> float | None:
    """The least b of the free arm, encoders aside; None if none is enough."""
    if HeldCriterion(question).bends:
        return None
    name = question.free
    guess = max(float(question.arms[0].side.damping), float(question.pair.felt_stiffness / 1000))
    return smallest_holding(
        lambda b: _or_false(lambda: HeldCriterion(question.with_damping(name, b)).holds),
        guess,
        grain_of(question.pair),
    )


def _or_false(answer: Callable[[], bool]) -> bool:
    """False where it is refused: too many digits, or an order too high."""
    try:
        return answer()
    except InputError:
        return False
