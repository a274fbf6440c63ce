"""A touch so soft that the position straddles an encoder pulse.

With a coarse encoder the wall is a staircase: at an edge its force jumps by K Δ.  A push F beyond what the
steps before it balance crosses the edge if F > f_c, and is thrown back if K Δ − F > f_c.  Both hold for some
F when K Δ > 2 f_c, which is the bound of Abbott & Okamura (2005), equation (17).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from zwidth.model.operator.fingers import Finger, approach, hand_stiffness
from zwidth.model.operator.operator import (
    FORCE,
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


RISE = Quantity("rise", "t_r", "s", "s", "time in which the push grows to its full force")


@dataclass(frozen=True, kw_only=True)
class SoftTouch(ParametricOperator):
    """``f_h = F min(t/t_r, 1) − c ẋ − m_h ẍ``: a push barely above the friction.

    The malicious touch for quantization: "simply touching the wall very softly" (Abbott & Okamura 2005,
    section IV-C; no number is printed). It buzzes where f_c < F < K Δ − f_c. The default 0.135 N lies in that
    window on the haptic paddle (f_c = 0.12 N) with Δ = 2.24 mm for K = 120 and 240 N/m; at 80 and 90 N/m, K <
    2 f_c/Δ = 107 N/m, there is no window. Force, rise and start are chosen; mass and damping are those of
    `Finger`.

    Parameters
    ----------
    force
        F, positive into the wall; take it a little above the device's Coulomb friction [N; N·m].
    rise
        t_r ≥ 0, time in which the push grows to F [s].
    mass
        m_h ≥ 0, moves with the handle [kg; kg·m²].
    damping
        c ≥ 0, of the finger [N·s/m; N·m·s/rad].
    start
        x_0 ≤ 0, where the handle starts [m; rad].
    """

    called = "soft touch"

    force: float = parameter(FORCE, 0.135, kept=float)
    rise: float = parameter(
        RISE, 0.5, bound="≥ 0", why="a push grows forward in time; 0 is a sudden push", kept=float
    )
    mass: float = hand_mass(0.006)
    damping: float = hand_damping(1.7)
    start: float = start_at(-0.001)

    @property
    def hand(self) -> LinearHand:
        """m_h and c; there is no spring, so that the push does not depend on the depth."""
        return LinearHand(mass=self.mass, damping=self.damping)

    def signals(self, times: Signal) -> Signals:
        """The push as it is when each interval begins; the damper holds to a hand at rest."""
        grown = times[:-1] >= self.rise
        part = np.where(grown, 1.0, times[:-1] / (self.rise or 1.0))
        anchor = np.full(len(times), self.start) if self.damping else None
        return Signals(force=self.force * part, anchor=anchor)


# The two touches of the experiments on the haptic paddle.
#
# Abbott & Okamura (2005), section IV-C, describe them in words and print no number: "typical" holds the
# device at the load cell, moves at a moderate speed toward the wall and then attempts to press with a
# constant force; "malicious" presses much lower on the device, moves very quickly toward the wall and matches
# the resonance of the finger with that of the wall.


@dataclass(frozen=True, kw_only=True)
class TypicalTouch(Finger):
    """A finger that comes at a moderate speed, 0.1 m/s, and presses with 2 N.

    ``f_h = k (x_a(t) − x) + c (ẋ_a(t) − ẋ) − m_h ẍ``, as `Finger`, with its numbers. Speed, force and start
    are chosen: Abbott & Okamura (2005, section IV-C) print none for their "typical" touch.

    Parameters
    ----------
    mass, stiffness, damping, force, speed, start
        As for `Finger`.
    """

    called = "typical touch"


@dataclass(frozen=True, kw_only=True)
class MaliciousTouch(Finger):
    """A fast, loose finger that is tuned to the wall.

    ``f_h = k (x_a(t) − x) + c (ẋ_a(t) − ẋ) − m_h ẍ``, as `Finger`, with

        √(k/m_h) = √(K/m),    c a little above K T/2 − b

    The first is the tuning: the finger then neither raises nor lowers the frequency of the device on the
    wall. The defaults are tuned to the haptic paddle on 770 N/m: √(K/m)/2π = 23.3 Hz, k = 128 N/m for 0.006
    kg. Whoever presses lower on the device is felt less at the handle, hence the low damping: just above K
    T/2 − b = 0.235 N·s/m, where at K = 770 N/m every vibration still dies out, as it did under the finger of
    the experiment. Abbott & Okamura (2005, section IV-C) print no numbers; these are chosen by that argument,
    and speed, force and start freely.

    Parameters
    ----------
    mass, stiffness, damping, force, speed, start
        As for `Finger`.
    """

    called = "malicious touch"

    stiffness: float = hand_stiffness(128.0)
    damping: float = hand_damping(0.3)
    speed: float = approach(0.5)
    start: float = start_at(-0.03)
