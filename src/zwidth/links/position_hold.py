"""Position to position: a spring to the last position that was heard.

    f = K (x_other − x)

What comes late pulls the wrong way: with any delay it gives out energy (`zwidth.Pair` says how much a device
can take).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from zwidth.links.memory import apply
from zwidth.links.springs import Springs, move_on, pull
from zwidth.native.compiled import Array, compiled

POSITION_HOLD = 4.0


@compiled
def force(p: Array, s: Array) -> float:
    """K (x_other − x), the last position heard held."""
    return apply(p, s, pull(p, s))


@compiled
def send(p: Array, s: Array, moved: float) -> None:
    """The position."""
    move_on(s, moved)


@dataclass(frozen=True)
class PositionHold(Springs):
    """A spring to the last position that was heard, ``f = K (x_other − x)``: not passive over a late link.

    Parameters
    ----------
    device
        What the port drives.
    stiffness
        K > 0 [N/m; N·m/rad].

    Raises
    ------
    InputError
        If a number is missing or out of its bounds.
    """

    title: ClassVar[str] = "positions, the last one held"
    code: ClassVar[float] = POSITION_HOLD
    steps: ClassVar = (force, send)
