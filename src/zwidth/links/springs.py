"""Ports that send positions, a spring to where the other end was: held, time-domain passivity, two layers."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from zwidth.links.memory import (
    ACTING,
    COUNTED,
    ENERGY,
    HEARD_ENERGY,
    HEARD_NUMBER,
    HEARD_POSITION,
    NUMBER,
    OWN_NUMBERS,
    OWN_STATE,
    PERIOD,
    POSITION,
    apply,
)
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
def move_on(p: Array, s: Array, moved: float) -> None:
    """The own position is what is sent."""
    s[MOVED] = moved
    s[POSITION] += moved
    s[NUMBER] += 1.0


POSITION_HOLD = 4.0


@compiled
def position_force(p: Array, s: Array) -> float:
    """K (x_other − x), the last position heard held."""
    return apply(p, s, pull(p, s))


@dataclass(frozen=True)
class PositionHold(Springs):
    """A spring to the last position that was heard, ``f = K (x_other − x)``: not passive over a late link.

    Parameters
    ----------
    device
        What the port drives.
    stiffness
        K > 0 [N/m; N·m/rad].
    """

    title: ClassVar[str] = "positions, the last one held"
    code: ClassVar[float] = POSITION_HOLD
    steps: ClassVar = (position_force, move_on)


# Each end counts what its hand puts into the link, E_in, and what comes out there, E_out.  It hears the
# other's E_in, late; where E_out is more, it damps the difference away:
#
#     f = K (x_other − x) − α v,    α = (E_out − E_in,other)/(T v²),  at most `largest_damping`
#
# (Ryu, Artigas and Preusche 2010.)  What comes out is known only when the device has moved, and is damped in
# the next period, if the device still moves then: it is not passive.


TIME_DOMAIN = 5.0

_LARGEST = STIFFNESS + 1
_OUT = OWN


@compiled
def damped_force(p: Array, s: Array) -> float:
    """The spring's force and, where more has come out than was put in, a damper's."""
    f = pull(p, s)
    excess = s[_OUT] - s[HEARD_ENERGY]
    moved = s[MOVED]
    if excess > 0.0 and moved != 0.0:
        f -= min(excess / (moved * moved), p[_LARGEST] / p[PERIOD]) * moved
    return apply(p, s, f)


@compiled
def damped_send(p: Array, s: Array, moved: float) -> None:
    """The position, and the energy put in; what came out is kept."""
    work = s[ACTING] * moved
    if work > 0.0:
        s[_OUT] += work
    else:
        s[ENERGY] -= work
    move_on(p, s, moved)


@dataclass(frozen=True)
class TimeDomain(Springs):
    """Time-domain passivity at both ends: where more has come out than the other put in, it is damped.

    Parameters
    ----------
    device
        What the port drives.
    stiffness
        K > 0 [N/m; N·m/rad].
    largest_damping
        Of the passivity controller, ≥ 0 [N·s/m; N·m·s/rad].
    """

    title: ClassVar[str] = "time-domain passivity"
    code: ClassVar[float] = TIME_DOMAIN
    steps: ClassVar = (damped_force, damped_send)

    largest_damping: Certain = parameter(
        "virtual_damping",
        kept=Exact,
        bound="≥ 0",
        why="a negative damper drives the hand",
        meaning="largest damping of the passivity controller",
    )


# Two layers:
#
#     H ← H − f Δx,  a hundredth of it goes to the other end in every period
#     f = K (x_other − x), at most H/|Δx|, 0 where H ≤ 0;  and − α (H_d − H) v where H < H_d
#
# (Franken, Stramigioli, Misra, Secchi and Macchelli 2011.)  The tank is exact, but the force is limited by
# the displacement of the last period: a hand that is faster in the next takes more than there is, f² T/(4b) a
# time.


TWO_LAYER = 6.0

_LEVEL, _FILLING = STIFFNESS + 1, STIFFNESS + 2
_TANK = OWN

_SHARE = 0.01
"""Of the tank, to the other end in each period."""


@compiled
def tank_force(p: Array, s: Array) -> float:
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
def tank_send(p: Array, s: Array, moved: float) -> None:
    """The position, and a share of the tank."""
    s[_TANK] -= s[ACTING] * moved
    share = _SHARE * max(s[_TANK], 0.0)
    s[_TANK] -= share
    s[ENERGY] += share
    move_on(p, s, moved)


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
    """

    title: ClassVar[str] = "two layers"
    code: ClassVar[float] = TWO_LAYER
    steps: ClassVar = (tank_force, tank_send)

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
