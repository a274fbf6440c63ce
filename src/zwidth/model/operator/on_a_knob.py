"""Two fingers on a knob.

Each is a finger at a radius r, a mass, a spring and a damper; about the axis

    J_h = 2 m r²      k = 2 K r²      c = 2 B r²      τ = 2 F r
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from zwidth.model.operator.finger import NO_APPROACH, NO_PULL, NO_SPRING, PRESS, Finger
from zwidth.model.operator.quantities import (
    DAMPING,
    MASS,
    NO_NEGATIVE_DAMPING,
    NO_NEGATIVE_MASS,
    OUTSIDE,
    SPEED,
    START,
    STIFFNESS,
)
from zwidth.quantity.parameter import parameter

EDGE = 0.015
"""Radius of a knob [m]: chosen, of the size that knobs have."""

_MASS, _STIFFNESS, _DAMPING, _PRESS = 0.006, 500.0, 1.7, 2.0
"""Of a `Finger` [kg], [N/m], [N·s/m], [N]."""


@dataclass(frozen=True, kw_only=True)
class FingersOn(Finger):
    """``τ_h = k (θ_a(t) − θ) + c (θ̇_a(t) − θ̇) − J_h θ̈``, ``θ_a(t) = min(θ_0 + ω t, τ/k)``.

    Thumb and finger on the edge of a knob; they move and press as a `Finger`, with other numbers: those of
    a finger, twice, at 15 mm from the axis, a radius that is chosen.  Speed and start are chosen too.

    Parameters
    ----------
    mass
        J_h ≥ 0 of both fingers, moves with the knob [kg·m²].
    stiffness
        k > 0, to the angle that they want [N·m/rad].
    damping
        c ≥ 0, to the same [N·m·s/rad].
    force
        τ ≥ 0, with which they would turn against a rigid stop [N·m].
    speed
        ω > 0, of the approach [rad/s].
    start
        θ_0 ≤ 0, where anchor and knob start [rad].
    """

    called = "fingers on a knob"
    motion: ClassVar[str] = "rotary"

    mass: float = parameter(
        MASS, round(2 * _MASS * EDGE**2, 9), bound="≥ 0", why=NO_NEGATIVE_MASS, kept=float
    )
    stiffness: float = parameter(
        STIFFNESS, round(2 * _STIFFNESS * EDGE**2, 5), bound="> 0", why=NO_SPRING, kept=float
    )
    damping: float = parameter(
        DAMPING, round(2 * _DAMPING * EDGE**2, 6), bound="≥ 0", why=NO_NEGATIVE_DAMPING, kept=float
    )
    force: float = parameter(PRESS, round(2 * _PRESS * EDGE, 3), bound="≥ 0", why=NO_PULL, kept=float)
    speed: float = parameter(SPEED, 3.0, bound="> 0", why=NO_APPROACH, kept=float)
    start: float = parameter(START, -0.3, bound="≤ 0", why=OUTSIDE, kept=float)
