"""What the ports that send positions share: a spring to where the other end was."""

from __future__ import annotations

from dataclasses import dataclass

from zwidth.links.memory import HEARD_NUMBER, HEARD_POSITION, NUMBER, OWN_NUMBERS, OWN_STATE, POSITION
from zwidth.links.port import Port
from zwidth.native.compiled import Array, compiled
from zwidth.quantity.exact import Exact
from zwidth.quantity.parameter import Certain, parameter

STIFFNESS = OWN_NUMBERS
MOVED = OWN_STATE
"""Displacement of the last period."""
OWN = OWN_STATE + 1
"""Where the next law's state begins."""


@dataclass(frozen=True)
class Springs(Port):
    """A port that sends its position and pulls with K to the newest it has heard of the other.

    Both ends count from where they start.
    """

    stiffness: Certain = parameter(
        "stiffness", kept=Exact, bound="> 0", why="without a spring the ends do not follow each other"
    )


@compiled
def pull(p: Array, s: Array) -> float:
    """K (x_other − x) [N; N·m]; 0 before anything is heard."""
    if s[HEARD_NUMBER] < 0.0:
        return 0.0
    f: float = p[STIFFNESS] * (s[HEARD_POSITION] - s[POSITION])
    return f


@compiled
def move_on(s: Array, moved: float) -> None:
    """The own position is what is sent."""
    s[MOVED] = moved
    s[POSITION] += moved
    s[NUMBER] += 1.0
