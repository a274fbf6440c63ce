"""A passive finger: approaches, touches, presses.

The muscles move the position that the finger wants, the anchor; the finger
follows it as a mass on a spring and a damper.  Pressing is wanting to be
inside the wall (the equilibrium-point view of movement).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from zwidth.model.operator.operator import LinearHand, Signals
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
from zwidth.quantity.glossary import Quantity
from zwidth.quantity.parameter import parameter

if TYPE_CHECKING:
    from zwidth.model.operator.operator import Signal

PRESS = Quantity("force", "F", "N", "N*m", "with which the finger would press on a rigid wall")

NO_SPRING = "the finger is moved and pressed through its spring; for a push without one take ConstantForce"
NO_APPROACH = "the finger has to arrive; for a touch that starts in contact set start to 0"
NO_PULL = "a finger presses on a wall and cannot pull it; 0 comes to rest at the surface"


@dataclass(frozen=True, kw_only=True)
class Finger(ParametricOperator):
    """``f_h = k (x_a(t) − x) + c (ẋ_a(t) − ẋ) − m_h ẍ``, ``x_a(t) = min(x_0 + v t, F/k)``.

    The anchor x_a comes from x_0 at constant speed and stops where the finger
    would press with F on a rigid wall. A wall of stiffness K yields:
    it is pressed with F K/(K + k), to within friction.

    Mass and stiffness are those of Gillespie & Cutkosky (1996) for a finger on
    a manipulandum, 0.006 kg and 500 N/m; theirs has no damping. The damping
    here is chosen, not measured: a damping ratio c/(2√(k m_h)) of one half.
    Hajian & Howe (J. Biomech. Eng. 119, 1997, 109–114) identified mass, damping
    and stiffness at the fingertip; their figures could not be consulted and
    none is quoted. Give your own where you have them.

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

    mass: float = parameter(MASS, 0.006, bound="≥ 0", why=NO_NEGATIVE_MASS, kept=float)
    stiffness: float = parameter(STIFFNESS, 500.0, bound="> 0", why=NO_SPRING, kept=float)
    damping: float = parameter(DAMPING, 1.7, bound="≥ 0", why=NO_NEGATIVE_DAMPING, kept=float)
    force: float = parameter(PRESS, 2.0, bound="≥ 0", why=NO_PULL, kept=float)
    speed: float = parameter(SPEED, 0.1, bound="> 0", why=NO_APPROACH, kept=float)
    start: float = parameter(START, -0.02, bound="≤ 0", why=OUTSIDE, kept=float)

    @property
    def hand(self) -> LinearHand:
        """m_h, k and c."""
        return LinearHand(self.mass, self.stiffness, self.damping)

    @property
    def initial_position(self) -> float:
        """x_0 [m; rad]."""
        return self.start

    def signals(self, times: Signal) -> Signals:
        """The anchor, approaching and then still."""
        return Signals(anchor=np.minimum(self.start + self.speed * times, self.force / self.stiffness))
