"""What decides a pair of which a known hand holds one arm, as the prover reckons; and how far its numbers go.

The law that the free arm's hand feels is linear where no arm compensates friction, none reads itself more
often than it sends, and the held one is without Coulomb friction.  Then the criterion of one arm decides, at
every corner of the hand's intervals; what lies between them is for the checker.  Whatever the criterion of
two hands covers, with the hand's damping in the held arm, needs none of this.
"""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from functools import cached_property

from zwidth.errors import InputError
from zwidth.loop.sampled_plant import Motion
from zwidth.passivity.linear.boundary import largest_holding, smallest_holding
from zwidth.passivity.linear.criterion import LinearProof, decide_linear
from zwidth.passivity.linear.loop import LinearLoop
from zwidth.passivity.linear.one_norm import bound_one_norm
from zwidth.passivity.pairs.held.evidence import HeldViolation
from zwidth.passivity.pairs.held.law import HeldPair, felt_loop
from zwidth.passivity.pairs.limits import grain_of, is_passive


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
