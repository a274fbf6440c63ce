"""Does a loop come to rest, and if its numbers are intervals, is there one in them that does not?

A certain loop is decided, in balls of growing precision.  Of a box the values on a grid are decided: one
that does not decay settles it.  If all do, "stable" is what is left to be proved; the checker does that.
"""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from itertools import product
from typing import Literal, NamedTuple

from zwidth.quantity.balls import precision
from zwidth.stability.known_hand.characteristic import PRECISIONS, decays
from zwidth.stability.known_hand.plant import Coefficients, Motion

Outcome = Literal["stable", "unstable", "undecided"]

_ON_A_SIDE = 4
"""Values that are tried along each side of a box, ends included."""

Polynomial = Callable[[Motion], Coefficients]


class Found(NamedTuple):
    """The outcome, and a point of the box that does not decay if there is one."""

    outcome: Outcome
    unstable_hand: Motion | None = None


def decided(motion: Motion, polynomial: Polynomial) -> Found:
    """Whether a certain loop decays; of a box "unstable" with a value in it, or "stable" as a conjecture."""
    answers = [_certain(point, polynomial) for point in _grid(motion)]
    worst = next((found for found in answers if found.outcome == "unstable"), None)
    return worst or next((found for found in answers if found.outcome == "undecided"), Found("stable"))


def _certain(motion: Motion, polynomial: Polynomial) -> Found:
    for bits in PRECISIONS:
        with precision(bits):
            answer = decays(polynomial(motion))
        if answer is not None:
            return Found("stable") if answer else Found("unstable", motion)
    return Found("undecided")


def corners(motion: Motion) -> list[Motion]:
    """The certain motions at the corners of the box."""
    return _points(motion, lambda low, high: [low, high])


def _grid(motion: Motion) -> list[Motion]:
    last = _ON_A_SIDE - 1
    return _points(motion, lambda low, high: [low + (high - low) * i / last for i in range(_ON_A_SIDE)])


def _points(motion: Motion, along: Callable[[Fraction, Fraction], list[Fraction]]) -> list[Motion]:
    """All combinations of values along the sides of a box."""
    sides = [dict.fromkeys(along(*ends)) for ends in motion[:3]]
    return [Motion((m, m), (d, d), (k, k), *motion[3:]) for m, d, k in product(*sides)]
