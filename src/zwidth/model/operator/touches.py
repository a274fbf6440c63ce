"""The two touches of the experiments on the haptic paddle.

Abbott & Okamura (2005), section IV-C, describe them in words and print no
number: "typical" holds the device at the load cell, moves at a moderate speed
toward the wall and then attempts to press with a constant force; "malicious"
presses much lower on the device, moves very quickly toward the wall and
matches the resonance of the finger with that of the wall.
"""

from __future__ import annotations

from dataclasses import dataclass

from zwidth.model.operator.finger import NO_APPROACH, NO_SPRING, Finger
from zwidth.model.operator.quantities import (
    DAMPING,
    NO_NEGATIVE_DAMPING,
    OUTSIDE,
    SPEED,
    START,
    STIFFNESS,
)
from zwidth.quantity.parameter import parameter


@dataclass(frozen=True, kw_only=True)
class TypicalTouch(Finger):
    """A finger that comes at a moderate speed, 0.1 m/s, and presses with 2 N.

    ``f_h = k (x_a(t) − x) + c (ẋ_a(t) − ẋ) − m_h ẍ``, as `Finger`, with its
    numbers. Speed, force and start are chosen: Abbott & Okamura (2005, section
    IV-C) print none for their "typical" touch.

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

    The first is the tuning: the finger then neither raises nor lowers the
    frequency of the device on the wall. The defaults are tuned to the haptic
    paddle on 770 N/m: √(K/m)/2π = 23.3 Hz, k = 128 N/m for 0.006 kg. Whoever
    presses lower on the device is felt less at the handle, hence the low
    damping: just above K T/2 − b = 0.235 N·s/m, where at K = 770 N/m every
    vibration still dies out, as it did under the finger of the experiment.
    Abbott & Okamura (2005, section IV-C) print no numbers; these are chosen
    by that argument, and speed, force and start freely.

    Parameters
    ----------
    mass, stiffness, damping, force, speed, start
        As for `Finger`.
    """

    called = "malicious touch"

    stiffness: float = parameter(STIFFNESS, 128.0, bound="> 0", why=NO_SPRING, kept=float)
    damping: float = parameter(DAMPING, 0.3, bound="≥ 0", why=NO_NEGATIVE_DAMPING, kept=float)
    speed: float = parameter(SPEED, 0.5, bound="> 0", why=NO_APPROACH, kept=float)
    start: float = parameter(START, -0.03, bound="≤ 0", why=OUTSIDE, kept=float)
