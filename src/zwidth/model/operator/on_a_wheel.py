"""Hands on a steering wheel, and a wheel that is let go.

Two hands hold the rim at a radius r, each a mass, a spring and a damper at the end of an arm; about the axis

    J_h = 2 m r²      k = 2 K r²      c = 2 B r²
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from zwidth.model.operator.finger import NO_APPROACH, NO_PULL, NO_SPRING, PRESS, Finger
from zwidth.model.operator.operator import Signals
from zwidth.model.operator.parameter import ParametricOperator
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

if TYPE_CHECKING:
    from zwidth.model.operator.operator import Signal

RIM = 0.15
"""Radius of the rim [m]: chosen, of the size that wheels have."""

_ARM_MASS, _ARM_STIFFNESS, _ARM_DAMPING = 0.554, 135.0, 6.45
"""Of one arm that holds its place against small pushes, at the hand [kg], [N/m], [N·s/m]; see `HandsOn`."""


@dataclass(frozen=True, kw_only=True)
class HandsOn(Finger):
    """``τ_h = k (θ_a(t) − θ) + c (θ̇_a(t) − θ̇) − J_h θ̈``, ``θ_a(t) = min(θ_0 + ω t, τ/k)``.

    Two hands on a rim; they move and press as a `Finger`, with other numbers.  Mass, stiffness and damping
    are those of one arm in one trial of one person, 0.554 kg, 135 N/m, 6.45 N·s/m (Haptic perception of force
    magnitude and its relation to postural arm dynamics in 3D, Scientific Reports 5:18004, 2015, figure 3),
    twice, at 0.15 m from the axis.  Others are published of arms on a wheel (Pick & Cole, 2006); their
    figures could not be consulted.  Arms that hang loose are taken to have a quarter of this stiffness,
    stiffened ones ten times as much: a range that is stated, not measured.  The others are chosen.

    Parameters
    ----------
    mass
        J_h ≥ 0 of both hands, moves with the wheel [kg·m²].
    stiffness
        k > 0, to the angle that they want [N·m/rad].
    damping
        c ≥ 0, to the same [N·m·s/rad].
    force
        τ ≥ 0, with which they would turn against a rigid stop [N·m].
    speed
        ω > 0, of the approach [rad/s].
    start
        θ_0 ≤ 0, where anchor and wheel start [rad].
    """

    called = "hands on"
    motion: ClassVar[str] = "rotary"

    mass: float = parameter(
        MASS, round(2 * _ARM_MASS * RIM**2, 5), bound="≥ 0", why=NO_NEGATIVE_MASS, kept=float
    )
    stiffness: float = parameter(
        STIFFNESS, round(2 * _ARM_STIFFNESS * RIM**2, 5), bound="> 0", why=NO_SPRING, kept=float
    )
    damping: float = parameter(
        DAMPING, round(2 * _ARM_DAMPING * RIM**2, 5), bound="≥ 0", why=NO_NEGATIVE_DAMPING, kept=float
    )
    force: float = parameter(PRESS, 4.0, bound="≥ 0", why=NO_PULL, kept=float)
    speed: float = parameter(SPEED, 3.0, bound="> 0", why=NO_APPROACH, kept=float)
    start: float = parameter(START, -0.3, bound="≤ 0", why=OUTSIDE, kept=float)


@dataclass(frozen=True, kw_only=True)
class HandsOff(ParametricOperator):
    """``τ_h = 0``: the wheel is let go, and moves as it was thrown or bent aside.

    How it begins is said by `initial_position` and `initial_velocity` of the simulation.
    """

    called = "hands off"

    def signals(self, times: Signal) -> Signals:
        """Nothing."""
        return Signals(force=np.zeros(len(times) - 1))

    def describe(self, motion: str = "linear") -> str:
        """That there is none."""
        return self.called
