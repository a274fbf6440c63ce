"""The law that a hand feels on one arm of a pair while a known hand holds the other.

With x_h = −G f_h of the held arm in its hand, G the exact hold, and fᵢ = Aᵢ xᵢ + Cᵢ xⱼ of each side,

    H = A − C G C_h/(1 + G A_h) = (A D − C C_h g)/D,    G = g/a,  D = a + g A_h

The exponentials in G are rounded to 192 bits; the static stiffness stays S k/(k + S_h), 0 with nobody there.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any, Literal

import flint

from zwidth.errors import InputError
from zwidth.loop.sampled_plant import Motion, sampled, times
from zwidth.model.environment.environment import RationalFunction
from zwidth.model.environment.transfer_function import PulseTransferFunction
from zwidth.model.operator.hand_impedance import HandImpedance, as_hand
from zwidth.model.pairs import Pair
from zwidth.passivity.linear.loop import LinearLoop, loop_from
from zwidth.passivity.pairs.arm import Arm
from zwidth.passivity.pairs.criterion import PairCriterion
from zwidth.passivity.stability.known_hand import motion_of
from zwidth.quantity import balls
from zwidth.quantity.exact import Exact, ends
from zwidth.quantity.text import in_words

ArmName = Literal["leader", "follower"]

ANY = "any"
"""What holds an arm if nothing is said: a hand that does what it likes."""

_BITS = 192

Ascending = list[Fraction]
"""A polynomial in ζ = z⁻¹."""


@dataclass(frozen=True)
class HeldPair:
    """A pair, one arm of which a known hand holds; the hand on the other is free.

    Numbers of the hand may be intervals.
    """

    pair: Pair
    held: ArmName
    hand: HandImpedance

    @property
    def free(self) -> ArmName:
        """The arm whose hand does what it likes."""
        return "leader" if self.held == "follower" else "follower"

    @property
    def arms(self) -> tuple[Arm, Arm]:
        """The free one and the held one, in samples."""
        leader, follower = PairCriterion(self.pair).arms
        return (leader, follower) if self.held == "follower" else (follower, leader)

    @property
    def motion(self) -> Motion:
        """What moves there, arm and hand together."""
        device = getattr(self.pair, self.held)
        if device.mass is None:
            own = in_words("mass", device.motion)
            raise InputError(
                f"how the {self.held} moves in a hand depends on its {own}, which is unknown: give it"
            )
        delay = self.arms[1].side.delay
        return motion_of(device, self.hand)._replace(period=self.pair.sample_period, delay=delay)

    @property
    def damped(self) -> Pair:
        """The pair with the least damping of the hand in the held arm: no hand is left but what damps so."""
        device = getattr(self.pair, self.held)
        more = device.exact("damping") + ends(self.hand.damping)[0]
        return self.pair.replace(**{self.held: device.replace(damping=Exact(more))})

    def stiffened(self, felt: Fraction) -> HeldPair:
        """With another spring between the arms."""
        return replace(self, pair=self.pair.stiffened(felt))

    def with_damping(self, name: str, damping: Fraction) -> HeldPair:
        """With another damping of the leader or the follower."""
        device = getattr(self.pair, name).replace(damping=Exact(damping))
        return replace(self, pair=self.pair.replace(**{name: device}))


def held_pair(pair: Pair, leader: Any = ANY, follower: Any = ANY) -> HeldPair:
    """What holds which arm, as `check_held_pair` is asked."""
    given = {
        name: hand
        for name, hand in (("leader", leader), ("follower", follower))
        if not (isinstance(hand, str) and hand == ANY)
    }
    if len(given) != 1:
        raise InputError(
            "one arm is held by a known hand and the other by any: with both known nobody is left who could "
            "take energy out; leave leader or follower out"
        )
    held: ArmName = "leader" if "leader" in given else "follower"
    return HeldPair(pair, held, as_hand(given[held]))


def felt_law(pair: Pair, leader: Any = ANY, follower: Any = ANY) -> PulseTransferFunction:
    """The law H(z) that the hand on one arm feels while a known hand, or nobody, holds the other.

    As an environment of that arm, for `zwidth.check`, `limit`, `simulate` and `compare`: its coefficients are
    those of an arm and hand whose sampled motion is the given one to 50 digits.  It is linear:
    Coulomb friction and encoder of the held arm are left out.

    Parameters
    ----------
    pair, leader, follower
        As of `check_held_pair`; no number of the hand is an interval.

    Raises
    ------
    InputError
        If it is not linear, or a number of arm or hand is uncertain.
    """
    question = held_pair(pair, leader, follower)
    if pair.own_readings > 1 or any(pair.compensations):
        raise InputError(
            "no one law is felt where an arm reads itself more often than it sends, or friction is "
            "compensated: give a pair without drives and without compensation"
        )
    if not question.motion.is_certain:
        raise InputError("the law is of one hand: give single numbers for it and for the mass of the arm")
    law, _ = felt(question, question.motion)
    first = law.denominator[0]
    top, bottom = ([Exact(c / first) for c in part] for part in law)
    return PulseTransferFunction(top, bottom, sample_period=Exact(pair.sample_period))


def felt(pair: HeldPair, motion: Motion) -> tuple[RationalFunction, RationalFunction]:
    """H(z), and C/(1 + G A_h) by which the held arm's readings come through, of a certain hand."""
    free, arm = pair.arms
    with balls.precision(_BITS):
        plant = sampled(motion)
    push, a = (_in_zeta([_rounded(c) for c in part]) for part in (plant.numerator, plant.denominator))
    g = [*[Fraction(0)] * (plant.late + len(a) - len(push)), *push]
    own, other, its_own, its_other = (
        [row.get(k, Fraction(0)) for k in range(max(row, default=0) + 1)]
        for row in (free.own_row, free.other_row, arm.own_row, arm.other_row)
    )
    below = _sum(a, times(g, its_own))
    above = _sum(times(below, own), [-c for c in times(times(g, other), its_other)])
    return _descending(above, below), _descending(times(a, other), below)


def felt_loop(pair: HeldPair, motion: Motion) -> tuple[LinearLoop, LinearLoop]:
    """The free arm before that law; and the same before what comes through of the held arm's encoder."""
    side = pair.arms[0].side
    law, stray = (loop_from(h, side.damping, pair.pair.sample_period, side.delay) for h in felt(pair, motion))
    return law, stray


def _rounded(value: Any) -> Fraction:
    return value if isinstance(value, Fraction) else balls.middle(flint.arb(value))


def _in_zeta(descending: Ascending) -> Ascending:
    """A polynomial in z − 1 in descending powers of z, which are ascending ones of ζ."""
    out: Ascending = []
    for c in descending:
        out = [x - y for x, y in zip([*out, Fraction(0)], [Fraction(0), *out], strict=True)]
        out[-1] += c
    return out


def _sum(a: Ascending, b: Ascending) -> Ascending:
    size = max(len(a), len(b))
    return [x + y for x, y in zip(*([*p, *[Fraction(0)] * (size - len(p))] for p in (a, b)), strict=True)]


def _descending(above: Ascending, below: Ascending) -> RationalFunction:
    """In powers of z, of one length."""
    size = max(len(above), len(below))
    top, bottom = ((*p, *[Fraction(0)] * (size - len(p))) for p in (above, below))
    return RationalFunction(top, bottom)
