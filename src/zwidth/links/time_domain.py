"""Time-domain passivity at both ends of a spring between positions.

Each end counts what its hand puts into the link, E_in, and what comes out there, E_out.  It hears the other's
E_in, late; where E_out is more, it damps the difference away:

    f = K (x_other − x) − α v,    α = (E_out − E_in,other)/(T v²),  at most `largest_damping`

(Ryu, Artigas and Preusche 2010.)  What comes out is known only when the device has moved, and is damped in
the next period, if the device still moves then: it is not passive.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from zwidth.links.memory import (
    ACTING,
    ENERGY,
    HEARD_ENERGY,
    PERIOD,
    apply,
)
from zwidth.links.springs import MOVED, OWN, STIFFNESS, Springs, move_on, pull
from zwidth.native.compiled import Array, compiled
from zwidth.quantity.exact import Exact
from zwidth.quantity.parameter import Certain, parameter

TIME_DOMAIN = 5.0

_LARGEST = STIFFNESS + 1
_OUT = OWN


@compiled
def force(p: Array, s: Array) -> float:
    """The spring's force and, where more has come out than was put in, a damper's."""
    f = pull(p, s)
    excess = s[_OUT] - s[HEARD_ENERGY]
    moved = s[MOVED]
    if excess > 0.0 and moved != 0.0:
        f -= min(excess / (moved * moved), p[_LARGEST] / p[PERIOD]) * moved
    return apply(p, s, f)


@compiled
def send(p: Array, s: Array, moved: float) -> None:
    """The position, and the energy put in; what came out is kept."""
    work = s[ACTING] * moved
    if work > 0.0:
        s[_OUT] += work
    else:
        s[ENERGY] -= work
    move_on(s, moved)


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

    Raises
    ------
    InputError
        If a number is missing or out of its bounds.
    """

    title: ClassVar[str] = "time-domain passivity"
    code: ClassVar[float] = TIME_DOMAIN
    steps: ClassVar = (force, send)

    largest_damping: Certain = parameter(
        "virtual_damping",
        kept=Exact,
        bound="≥ 0",
        why="a negative damper drives the hand",
        meaning="largest damping of the passivity controller",
    )
