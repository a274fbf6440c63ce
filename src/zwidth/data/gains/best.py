"""The gains of a joint that are passive: how stiff, how damped, for how much friction or compensation.

M(θ) is affine in K, B and D (of drives the diagonal is concave in them, a parallel sum), and friction for
the steps of the encoders goes with |B| and |B + D|; what compensation may spend makes a convex set too.  So
the gains that are passive do: the largest K over a multiple of the damping is concave in it, and a golden
section finds its top.  What is found is rounded inward and proved by itself: no more is said than was proved.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from math import floor, log10, sqrt

from zwidth.data.gains.joint import CoupledJoint, Gains
from zwidth.errors import InputError
from zwidth.passivity.linear.boundary import COARSER, asked_seldom, largest_holding, smallest_holding
from zwidth.passivity.pairs import check_pair
from zwidth.passivity.pairs.limits import is_passive
from zwidth.quantity.exact import Exact

DIGITS = 3
"""Significant digits of the gains that are told."""

_TRIES = 6
_WORTH = 1.02
"""With less than 2 % more stiffness the damping is left out."""

_BESIDE = Fraction(1, 512), Fraction(1, 32), Fraction(1, 2)
"""How far beside the place where it probably is the largest stiffness is looked at first."""

_GRID = 8
"""Places at which gains that are passive are looked for; without compensation the first of all is one."""

Both = tuple[Gains, Gains]


def stiffest(joint: CoupledJoint) -> CoupledJoint | None:
    """The stiffest joint with the damping as it is, both springs in proportion, rounded down and proved."""
    found = _largest(joint)
    return None if found is None else _proved(joint, found)


def best(joint: CoupledJoint) -> CoupledJoint | None:
    """The stiffest joint over multiples of the damping, rounded and proved; None where none was found. Where
    the gains have no damping, over B on both sides. Up to twice b, or twice the damping that the gains have;
    no more than the drive takes."""
    one = _direction(joint)
    top = max(abs(v) for gains in one for v in (gains.damping, gains.local_damping))
    own = max(abs(v) for gains in joint.gains for v in (gains.damping, gains.local_damping))
    room = 2 * max(*joint.damping, own)
    if joint.largest_damping is not None:
        room = min(room, joint.largest_damping)
    high = float(room / top)

    found: dict[float, float] = {}

    def value(times: float) -> float:
        if times not in found:
            near = found[min(found, key=lambda x: abs(x - times))] if found else None
            found[times] = _largest(_damped(joint, one, times), near) or 0.0
        return found[times]

    start = next((x for x in (0.0, *(high * n / _GRID for n in range(1, _GRID + 1))) if value(x)), None)
    if start is None:
        return None
    times = peak(value, high, start)
    candidates = [_damped(joint, one, x) for x in (times, start)]
    stiffness = [value(x) for x in (times, start)]
    if stiffness[0] < _WORTH * stiffness[1]:
        candidates.reverse()
        stiffness.reverse()
    for candidate, largest in zip(candidates, stiffness, strict=True):
        stiff = _proved(candidate, largest) if largest else None
        if stiff is not None:
            return stiff
    return None


def required_damping(joint: CoupledJoint) -> float | None:
    """The least b, the same of both arms, with the gains as they are [N·m·s/rad]; rounded up and proved."""

    def with_b(b: Fraction) -> CoupledJoint:
        return joint.with_damping(b, b)

    guess = float(max(joint.damping)) or 1.0
    found = smallest_holding(lambda b: _holds(with_b(b)), guess, COARSER)
    if not found:
        return found
    value = _rounded(found, up=True)
    for _ in range(_TRIES):
        if _is_proved(with_b(value)):
            return float(value)
        value += _unit(value)
    return None


def passive_compensation(joint: CoupledJoint) -> float | None:
    """How much of its compensation of friction is passive with the gains as they are, at most 1, and proved.
    In hundredths, rounded down; None where none is passive, or there is no compensation."""
    if not joint.is_compensated or not _holds(replace(joint, compensation=Fraction(0))):
        return None
    low, high = 0, 100
    while low < high:
        middle = (low + high + 1) // 2
        if _is_proved(replace(joint, compensation=Fraction(middle, 100))):
            low = middle
        else:
            high = middle - 1
    return low / 100


def _direction(joint: CoupledJoint) -> Both:
    if any(gains.damping or gains.local_damping for gains in joint.gains):
        return joint.gains
    leader, follower = (replace(gains, damping=Fraction(1)) for gains in joint.gains)
    return leader, follower


def _damped(joint: CoupledJoint, one: Both, times: float) -> CoupledJoint:
    """With the damping of `one` so many times, in few digits."""
    leader, follower = (
        replace(
            gains,
            damping=_near(times * float(gains.damping)),
            local_damping=_near(times * float(gains.local_damping)),
        )
        for gains in one
    )
    return replace(joint, gains=(leader, follower))


def _stiff(joint: CoupledJoint, leader: Fraction, follower: Fraction) -> CoupledJoint:
    first, second = (
        replace(gains, stiffness=k) for gains, k in zip(joint.gains, (leader, follower), strict=True)
    )
    return replace(joint, gains=(first, second))


def _ratio(joint: CoupledJoint) -> Fraction:
    leader, follower = joint.gains
    return follower.stiffness / leader.stiffness


def _largest(joint: CoupledJoint, near: float | None = None) -> float | None:
    """The largest K of the leader, both sides in proportion, to a thousandth. Where it is probably, `near`,
    is looked at first; it is the same without."""
    ratio = _ratio(joint)
    try:
        base = joint.pair()
    except (InputError, ZeroDivisionError):
        return None

    def holds(k: Fraction) -> bool:
        alike = {} if ratio == 1 else {"follower_stiffness": Exact(k * ratio)}
        try:
            return is_passive(base.replace(stiffness=Exact(k), **alike))
        except (InputError, ZeroDivisionError):
            return False

    period = joint.devices[0].exact("sample_period")
    guess = float(min(joint.damping) / period) or float(joint.gains[0].stiffness)
    least = Exact(guess / 10**6).fraction
    if not holds(least):
        return None
    seldom = asked_seldom(lambda k: k <= least or holds(k), near, _BESIDE)
    return largest_holding(seldom, guess, COARSER) or None


def _proved(joint: CoupledJoint, largest: float) -> CoupledJoint | None:
    """With both springs rounded down, and lower until the checker accepts the proof."""
    ratio = _ratio(joint)
    if joint.largest_stiffness is not None:
        largest = min(largest, float(joint.largest_stiffness / max(Fraction(1), ratio)))
    stiffness = _rounded(largest)
    for _ in range(_TRIES):
        if stiffness <= 0:
            return None
        candidate = _stiff(joint, stiffness, _rounded(stiffness * ratio))
        if _is_proved(candidate):
            return candidate
        stiffness -= _unit(stiffness)
    return None


def _holds(joint: CoupledJoint) -> bool:
    try:
        return is_passive(joint.pair())
    except (InputError, ZeroDivisionError):
        return False


def _is_proved(joint: CoupledJoint) -> bool:
    try:
        return check_pair(joint.pair()).passive
    except InputError:
        return False


def _unit(value: Fraction) -> Fraction:
    """One in the last digit that is told."""
    return Fraction(10) ** (floor(log10(value)) - DIGITS + 1)


def _rounded(value: float | Fraction, up: bool = False) -> Fraction:
    exact = Fraction(value)
    if exact <= 0:
        return Fraction(0)
    unit = _unit(exact)
    return -(-exact // unit) * unit if up else exact // unit * unit


def _near(value: float) -> Fraction:
    """To the digits that are told."""
    return Fraction(f"{value:.{DIGITS}g}")


_STEPS = 14
"""Of the golden section: a thousandth of its range."""


def peak(value: Callable[[float], float], high: float, start: float) -> float:
    """Where a function on [0, high] is largest that is concave around `start` and 0 elsewhere."""

    def at(x: float) -> tuple[float, float, float]:
        return value(x), -abs(x - start), x

    golden = (sqrt(5) - 1) / 2
    low = 0.0
    left, right = at(high - golden * (high - low)), at(low + golden * (high - low))
    for _ in range(_STEPS):
        if left[:2] >= right[:2]:
            high, right = right[2], left
            left = at(high - golden * (high - low))
        else:
            low, left = left[2], right
            right = at(low + golden * (high - low))
    return max(left, right)[2]
