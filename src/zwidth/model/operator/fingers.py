"""Fingers and hands that approach, touch and press: on a handle, on a knob, on a wheel.

The muscles move the position that the finger wants, the anchor; the finger follows it as a mass on a spring
and a damper.  Pressing is wanting to be inside the wall (the equilibrium-point view of movement).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from zwidth.model.operator.operator import (
    SPEED,
    STIFFNESS,
    LinearHand,
    ParametricOperator,
    Signals,
    hand_damping,
    hand_mass,
    start_at,
)
from zwidth.quantity.glossary import Quantity
from zwidth.quantity.parameter import parameter

if TYPE_CHECKING:
    from zwidth.model.operator.operator import Signal


_PRESS = Quantity("force", "F", "N", "N*m", "with which the finger would press on a rigid wall")

_NO_SPRING = "the finger is moved and pressed through its spring; for a push without one take ConstantForce"
_NO_APPROACH = "the finger has to arrive; for a touch that starts in contact set start to 0"
_NO_PULL = "a finger presses on a wall and cannot pull it; 0 comes to rest at the surface"


def hand_stiffness(default: float) -> Any:
    """k > 0 as a field."""
    return parameter(STIFFNESS, default, bound="> 0", why=_NO_SPRING, kept=float)


def press(default: float) -> Any:
    """F ≥ 0 as a field."""
    return parameter(_PRESS, default, bound="≥ 0", why=_NO_PULL, kept=float)


def approach(default: float) -> Any:
    """v > 0 as a field."""
    return parameter(SPEED, default, bound="> 0", why=_NO_APPROACH, kept=float)


@dataclass(frozen=True, kw_only=True)
class Finger(ParametricOperator):
    """``f_h = k (x_a(t) − x) + c (ẋ_a(t) − ẋ) − m_h ẍ``, ``x_a(t) = min(x_0 + v t, F/k)``.

    The anchor x_a comes from x_0 at constant speed and stops where the finger would press with F on a rigid
    wall. A wall of stiffness K yields: it is pressed with F K/(K + k), to within friction.

    Mass and stiffness are those of Gillespie & Cutkosky (1996) for a finger on a manipulandum, 0.006 kg and
    500 N/m; theirs has no damping. The damping here is chosen, not measured: a damping ratio c/(2√(k m_h)) of
    one half. Hajian & Howe (J. Biomech. Eng. 119, 1997, 109–114) identified mass, damping and stiffness at
    the fingertip; their figures could not be consulted and none is quoted. Give your own where you have them.

    Parameters
    ----------
    mass
        m_h ≥ 0, moves with the handle [kg; kg·m²].
    stiffness
        k > 0, to the anchor [N/m; N·m/rad].
    damping
        c ≥ 0, to the anchor [N·s/m; N·m·s/rad].
    force
        F ≥ 0, with which it would press on a rigid wall at x = 0 [N; N·m].
    speed
        v > 0, of the approach [m/s; rad/s].
    start
        x_0 ≤ 0, where anchor and handle start [m; rad].
    """

    called = "finger"

    mass: float = hand_mass(0.006)
    stiffness: float = hand_stiffness(500.0)
    damping: float = hand_damping(1.7)
    force: float = press(2.0)
    speed: float = approach(0.1)
    start: float = start_at(-0.02)

    @property
    def hand(self) -> LinearHand:
        return LinearHand(self.mass, self.stiffness, self.damping)

    def signals(self, times: Signal) -> Signals:
        return Signals(anchor=np.minimum(self.start + self.speed * times, self.force / self.stiffness))


EDGE = 0.015
"""Radius of a knob [m]: chosen, of the size that knobs have."""

RIM = 0.15
"""Radius of the rim of a wheel [m]: chosen, of the size that wheels have."""


@dataclass(frozen=True, kw_only=True)
class _OnARim(Finger):
    """Two fingers or hands at a radius r; about the axis J_h = 2 m r², k = 2 K r², c = 2 B r², τ = 2 F r."""

    motion: ClassVar[str] = "rotary"

    speed: float = approach(3.0)
    start: float = start_at(-0.3)


@dataclass(frozen=True, kw_only=True)
class FingersOn(_OnARim):
    """``τ_h = k (θ_a(t) − θ) + c (θ̇_a(t) − θ̇) − J_h θ̈``, ``θ_a(t) = min(θ_0 + ω t, τ/k)``.

    Thumb and finger on the edge of a knob; they move and press as a `Finger`, with other numbers: those of
    a finger, twice, at 15 mm from the axis, a radius that is chosen.  Speed and start are chosen too.

    Parameters
    ----------
    mass, stiffness, damping, force, speed, start
        J_h, k, c, τ, ω and θ_0 as for `Finger` [kg·m²; N·m/rad; N·m·s/rad; N·m; rad/s; rad].
    """

    called = "fingers on a knob"

    mass: float = hand_mass(round(2 * 0.006 * EDGE**2, 9))
    stiffness: float = hand_stiffness(round(2 * 500.0 * EDGE**2, 5))
    damping: float = hand_damping(round(2 * 1.7 * EDGE**2, 6))
    force: float = press(round(2 * 2.0 * EDGE, 3))


@dataclass(frozen=True, kw_only=True)
class HandsOn(_OnARim):
    """``τ_h = k (θ_a(t) − θ) + c (θ̇_a(t) − θ̇) − J_h θ̈``, ``θ_a(t) = min(θ_0 + ω t, τ/k)``.

    Two hands on a rim; they move and press as a `Finger`, with other numbers.  Mass, stiffness and damping
    are those of one arm in one trial of one person, 0.554 kg, 135 N/m, 6.45 N·s/m (Haptic perception of force
    magnitude and its relation to postural arm dynamics in 3D, Scientific Reports 5:18004, 2015, figure 3),
    twice, at 0.15 m from the axis.  Others are published of arms on a wheel (Pick & Cole, 2006); their
    figures could not be consulted.  Arms that hang loose are taken to have a quarter of this stiffness,
    stiffened ones ten times as much: a range that is stated, not measured.  The others are chosen.

    Parameters
    ----------
    mass, stiffness, damping, force, speed, start
        J_h, k, c, τ, ω and θ_0 as for `Finger` [kg·m²; N·m/rad; N·m·s/rad; N·m; rad/s; rad].
    """

    called = "hands on"

    mass: float = hand_mass(round(2 * 0.554 * RIM**2, 5))
    stiffness: float = hand_stiffness(round(2 * 135.0 * RIM**2, 5))
    damping: float = hand_damping(round(2 * 6.45 * RIM**2, 5))
    force: float = press(4.0)


@dataclass(frozen=True, kw_only=True)
class HandsOff(ParametricOperator):
    """``τ_h = 0``: the wheel is let go, and moves as it was thrown or bent aside.

    How it begins is said by `initial_position` and `initial_velocity` of the simulation.
    """

    called = "hands off"

    def signals(self, times: Signal) -> Signals:
        return Signals(force=np.zeros(len(times) - 1))

    def describe(self, motion: str = "linear") -> str:
        return self.called
