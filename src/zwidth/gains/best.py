"""The gains of a joint that are still passive: how stiff, with which damping, or for how much friction.

M(θ) is affine in K, B and D (of drives the diagonal is concave in them, a parallel sum), and friction for the
steps of the encoders goes with |B| and |B + D|.  So the gains that are passive make a convex set: the largest K
over a multiple of the damping is concave in it, and a golden section finds its top.  What is found is rounded
inward, and then proved by itself: no more is said than was proved.
"""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from math import floor, log10, sqrt
from typing import Any

from zwidth.errors import InputError
from zwidth.pairs import Pair
from zwidth.passivity.linear.boundary import COARSER, largest_holding, smallest_holding
from zwidth.passivity.pairs import check_pair
from zwidth.passivity.pairs.limits import is_passive
from zwidth.quantity.exact import Exact

DIGITS = 3
"""Significant digits of the gains that are told."""

_DAMPINGS = ("damping", "follower_damping", "local_damping", "follower_local_damping")
_STEPS = 14
"""Of the golden section: a thousandth of its range."""

_TRIES = 6
_WORTH = 1.02
"""With less than 2 % more stiffness the damping is left out."""


def stiffest(pair: Pair) -> Pair | None:
    """The stiffest pair with the damping as it is, both springs in proportion, rounded down and proved."""
    found = _largest(pair)
    return None if found is None else _proved(pair, found)


def best(pair: Pair) -> Pair | None:
    """The stiffest pair over multiples of the damping, rounded and proved; None where no spring is passive.

    Where the pair has no damping, over B on both sides.
    """
    direction = [Fraction(getattr(pair, key).fraction if getattr(pair, key) else 0) for key in _DAMPINGS]
    if not any(direction):
        direction[0] = Fraction(1)
    top = max(map(abs, direction))
    high = 2 * max(float(side.damping) for side in pair.sides) / float(top)

    def damped(times: float) -> Pair:
        return pair.replace(**_scaled(pair, direction, times))

    none = _largest(damped(0))
    if none is None or not high:
        return None
    times = _top(lambda x: _largest(damped(x)) or 0.0, high)
    candidates = [damped(times), damped(0)]
    stiffness = [_largest(candidate) or 0.0 for candidate in candidates]
    if stiffness[0] < _WORTH * stiffness[1]:
        candidates.reverse()
        stiffness.reverse()
    for candidate, largest in zip(candidates, stiffness, strict=True):
        found = _proved(candidate, largest) if largest else None
        if found is not None:
            return found
    return None


def required_damping(pair: Pair) -> float | None:
    """The least b of both arms with the gains as they are, where an arm has less; rounded up and proved."""

    def raised(b: Fraction) -> Pair:
        return pair.replace(
            leader=pair.leader.replace(damping=max(Exact(b), pair.leader.exact("damping"))),
            follower=pair.follower.replace(damping=max(Exact(b), pair.follower.exact("damping"))),
        )

    guess = max(float(side.damping) for side in pair.sides) or 1.0
    found = smallest_holding(lambda b: _holds(raised(b)), guess, COARSER)
    if found is None:
        return None
    value = _rounded(found, up=True)
    for _ in range(_TRIES):
        if _is_proved(raised(value)):
            return float(value)
        value += _unit(value)
    return None


def _scaled(pair: Pair, direction: list[Fraction], times: float) -> dict[str, Any]:
    """Damping in the file's proportion, of a few digits; what the follower takes from the leader it still takes."""
    found: dict[str, Any] = {}
    for key, share in zip(_DAMPINGS, direction, strict=True):
        leaders = not key.startswith("follower_")
        if leaders or getattr(pair, key) is not None:
            found[key] = Exact(_near(times * float(share)))
    return found


def _largest(pair: Pair) -> float | None:
    """The largest K, both sides in proportion, to a thousandth."""
    ratio = 1 / pair.power_ratio

    def holds(k: Fraction) -> bool:
        return k > 0 and _holds(_with_stiffness(pair, k, k * ratio))

    guess = float(min(side.damping for side in pair.sides) / pair.sample_period) or float(pair.stiffness)
    if not holds(Exact(guess / 10**6).fraction):
        return None
    return largest_holding(lambda k: not k or holds(k), guess, COARSER) or None


def _proved(pair: Pair, largest: float) -> Pair | None:
    """With both springs rounded down, and lower until the checker accepts the proof."""
    stiffness = _rounded(largest)
    for _ in range(_TRIES):
        if stiffness <= 0:
            return None
        candidate = _with_stiffness(pair, stiffness, _rounded(float(stiffness / pair.power_ratio)))
        if _is_proved(candidate):
            return candidate
        stiffness -= _unit(stiffness)
    return None


def _with_stiffness(pair: Pair, leader: Fraction, follower: Fraction) -> Pair:
    other = None if pair.follower_stiffness is None else Exact(follower)
    return pair.replace(stiffness=Exact(leader), follower_stiffness=other)


def _holds(pair: Pair) -> bool:
    try:
        return is_passive(pair)
    except (InputError, ZeroDivisionError):
        return False


def _is_proved(pair: Pair) -> bool:
    try:
        return check_pair(pair).passive
    except InputError:
        return False


def _top(value: Callable[[float], float], high: float) -> float:
    """Where a concave function on [0, high], 0 beyond some place, is largest."""
    golden = (sqrt(5) - 1) / 2
    low = 0.0
    left, right = high - golden * (high - low), low + golden * (high - low)
    at_left, at_right = value(left), value(right)
    for _ in range(_STEPS):
        if at_left >= at_right:
            high, right, at_right = right, left, at_left
            left = high - golden * (high - low)
            at_left = value(left)
        else:
            low, left, at_left = left, right, at_right
            right = low + golden * (high - low)
            at_right = value(right)
    return left if at_left >= at_right else right


def _unit(value: Fraction) -> Fraction:
    """One in the last digit that is told."""
    return Fraction(10) ** (floor(log10(value)) - DIGITS + 1)


def _rounded(value: float, up: bool = False) -> Fraction:
    exact = Fraction(value)
    if exact <= 0:
        return Fraction(0)
    unit = _unit(exact)
    return -(-exact // unit) * unit if up else exact // unit * unit


def _near(value: float) -> Fraction:
    """To the digits that are told."""
    return Fraction(f"{value:.{DIGITS}g}")
