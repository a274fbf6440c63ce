"""Two layers: a tank of energy at each end allows a spring between positions what it holds.

    H ← H − f Δx,  a hundredth of it goes to the other end in every period
    f = K (x_other − x), at most H/|Δx|, 0 where H ≤ 0;  and − α (H_d − H) v where H < H_d

(Franken, Stramigioli, Misra, Secchi and Macchelli 2011.)  The tank is exact, but the force is limited by the
displacement of the last period: a hand that is faster in the next takes more than there is, f² T/(4b) a time.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from zwidth.links.memory import (
    ACTING,
    COUNTED,
    ENERGY,
    HEARD_ENERGY,
    PERIOD,
    apply,
)
from zwidth.links.springs import MOVED, OWN, STIFFNESS, Springs, move_on, pull
from zwidth.native.compiled import Array, compiled
from zwidth.quantity.exact import Exact
from zwidth.quantity.parameter import Certain, parameter

TWO_LAYER = 6.0

_LEVEL, _FILLING = STIFFNESS + 1, STIFFNESS + 2
_TANK = OWN

_SHARE = 0.01
"""Of the tank, to the other end in each period."""


@compiled
def force(p: Array, s: Array) -> float:
    """What the tank allows of the spring's force, and the damper that fills it."""
    s[_TANK] += max(s[HEARD_ENERGY] - s[COUNTED], 0.0)
    s[COUNTED] = s[HEARD_ENERGY]
    f, tank, moved = pull(p, s), s[_TANK], s[MOVED]
    most = tank / abs(moved) if moved != 0.0 else abs(f)
    most = max(most, 0.0) if tank > 0.0 else 0.0
    f = min(max(f, -most), most)
    if tank < p[_LEVEL]:
        f -= p[_FILLING] * (1.0 - max(tank, 0.0) / p[_LEVEL]) * moved / p[PERIOD]
    return apply(p, s, f)


@compiled
def send(p: Array, s: Array, moved: float) -> None:
    """The position, and a share of the tank."""
    s[_TANK] -= s[ACTING] * moved
    share = _SHARE * max(s[_TANK], 0.0)
    s[_TANK] -= share
    s[ENERGY] += share
    move_on(s, moved)


@dataclass(frozen=True)
class TwoLayer(Springs):
    """Two layers: a tank of energy at each end allows a spring between positions what it holds.

    Parameters
    ----------
    device
        What the port drives.
    stiffness
        K > 0 [N/m; N·m/rad].
    level
        H_d > 0 to which the tank is filled [J].
    filling_damping
        α H_d, the damping that fills an empty tank, ≥ 0 [N·s/m; N·m·s/rad].

    Raises
    ------
    InputError
        If a number is missing or out of its bounds.
    """

    title: ClassVar[str] = "two layers"
    code: ClassVar[float] = TWO_LAYER
    steps: ClassVar = (force, send)

    level: Certain = parameter(
        "energy", kept=Exact, bound="> 0", why="an empty tank allows no force", meaning="level of the tank"
    )
    filling_damping: Certain = parameter(
        "virtual_damping",
        kept=Exact,
        bound="≥ 0",
        why="a negative damper drives the hand",
        meaning="damping that fills an empty tank",
    )
