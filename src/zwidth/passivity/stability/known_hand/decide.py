"""Does a loop come to rest, and if its numbers are intervals, is there one in them that does not?

A certain loop is decided, in balls of growing precision.  Of a box the values on a grid are decided: one
that does not decay settles it.  If all do, "stable" is what is left to be proved; the checker does that.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal, NamedTuple

from zwidth.loop.sampled_plant import Coefficients, Motion
from zwidth.passivity.stability.known_hand.characteristic import PRECISIONS, decays
from zwidth.quantity.balls import precision

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
    answers = [_certain(point, polynomial) for point in motion.grid(_ON_A_SIDE)]
    worst = next((found for found in answers if found.outcome == "unstable"), None)
    return worst or next((found for found in answers if found.outcome == "undecided"), Found("stable"))


def _certain(motion: Motion, polynomial: Polynomial) -> Found:
    for bits in PRECISIONS:
        with precision(bits):
            answer = decays(polynomial(motion))
        if answer is not None:
            return Found("stable") if answer else Found("unstable", motion)
    return Found("undecided")
