"""How far a number of a pair may go, all else as it is."""

from __future__ import annotations

from fractions import Fraction

from zwidth.errors import InputError
from zwidth.model.device import Device
from zwidth.model.pairs import Pair
from zwidth.passivity.linear.boundary import COARSE, COARSER, largest_holding, smallest_holding
from zwidth.passivity.linear.loop import HIGH_DEGREE
from zwidth.passivity.pairs.criterion import PairCriterion, largest_spring, spending
from zwidth.quantity.exact import Exact


def is_passive(pair: Pair) -> bool:
    """True where the criterion holds and friction covers the steps of both encoders."""
    return spending(pair).proves


def grain_of(pair: Pair) -> int:
    """How near a limit is looked for: less near where old readings make every decision take long."""
    return COARSE if samples_around(pair) <= HIGH_DEGREE else COARSER


def samples_around(pair: Pair) -> int:
    """The delays of both arms and of the link there and back, in samples."""
    return sum(arm.whole + arm.age for arm in PairCriterion(pair).arms)


def largest_stiffness(pair: Pair) -> float | None:
    """The largest K, both sides in proportion and all else as it is, that is passive; None if none is.

    As the leader feels it, what is reflected to it added.
    """

    def holds(k: Fraction) -> bool:
        if k <= 0:
            return False
        try:
            return is_passive(pair.stiffened(k))
        except InputError:
            return False

    closed = largest_spring(pair)
    guess = float(closed) if closed else float(pair.felt_stiffness)
    if not (holds(Exact(guess / 10**6).fraction) or is_passive(pair)):
        return None
    found = largest_holding(lambda k: not k or holds(k), guess, grain_of(pair))
    return found or None


def largest_compensation(pair: Pair) -> float | None:
    """The largest share of the compensation of friction, on both sides, that is passive; None if none is."""
    if not any(pair.compensations) or not is_passive(with_share(pair, Fraction(0))):
        return None
    return largest_holding(lambda share: is_passive(with_share(pair, share)), 1.0, grain_of(pair))


def with_share(pair: Pair, share: Fraction) -> Pair:
    """With so many times the compensation of friction on both sides."""
    law, other = (law.scaled(share) for law in pair.compensations)
    return pair.replace(compensation=law, follower_compensation=other)


def required_damping(pair: Pair, name: str) -> float | None:
    """The least b of the "leader" or the "follower", the other's as it is; None if none is enough."""
    device: Device = getattr(pair, name)
    guess = max(float(device.exact("damping")), float(pair.felt_stiffness * pair.sample_period))

    def holds(b: Fraction) -> bool:
        return spending(pair.replace(**{name: device.replace(damping=Exact(b))})).holds

    return smallest_holding(holds, guess, grain_of(pair))


def required_friction(pair: Pair, name: str) -> float | None:
    """The least f_c of the "leader" or the "follower", the other's as it is; None if none is enough.

    For the steps of both encoders and for its compensation: with more of it a line that takes less of damping
    is paid for.
    """
    here = ("leader", "follower").index(name)
    device: Device = getattr(pair, name)
    wide = PairCriterion(pair).arms
    most = wide[here].missing_friction(wide[1 - here]) + wide[here].side.coulomb_friction
    if not pair.compensations[here].coulomb:
        return float(most)

    def holds(f: Fraction) -> bool:
        criterion = spending(pair.replace(**{name: device.replace(coulomb_friction=Exact(f))}))
        return criterion.missing_friction[here] <= 0 and criterion.holds

    if not holds(most):
        return None
    found = smallest_holding(holds, float(most), grain_of(pair))
    return float(most) if found is None else min(found, float(most))
