"""How far a number of a pair may go, all else as it is."""

from __future__ import annotations

from fractions import Fraction

from zwidth.errors import InputError
from zwidth.pairs import Pair
from zwidth.passivity.linear.boundary import COARSE, COARSER, largest_holding
from zwidth.passivity.linear.loop import HIGH_DEGREE
from zwidth.passivity.pairs.criterion import PairCriterion, largest_spring, spending
from zwidth.quantity.exact import Exact


def is_passive(pair: Pair) -> bool:
    """True where the criterion holds and friction covers the steps of both encoders."""
    criterion = spending(pair)
    return max(criterion.missing_friction) <= 0 and criterion.holds


def grain_of(pair: Pair) -> int:
    """How near a limit is looked for: less near where old readings make every decision take long."""
    return COARSE if samples_around(pair) <= HIGH_DEGREE else COARSER


def samples_around(pair: Pair) -> int:
    """The delays of both arms and of the link there and back, in samples."""
    return sum(arm.whole + arm.age for arm in PairCriterion(pair).arms)


def largest_stiffness(pair: Pair) -> float | None:
    """The largest K, both sides in proportion and all else as it is, that is passive; None if none is."""
    ratio = 1 / pair.power_ratio

    def holds(k: Fraction) -> bool:
        if k <= 0:
            return False
        try:
            return is_passive(pair.replace(stiffness=Exact(k), follower_stiffness=Exact(k * ratio)))
        except InputError:
            return False

    closed = largest_spring(pair)
    guess = float(closed) if closed else float(pair.stiffness)
    if not (holds(Exact(guess / 10**6).fraction) or is_passive(pair)):
        return None
    found = largest_holding(lambda k: not k or holds(k), guess, grain_of(pair))
    return found or None
