"""The touches that every law is given.

press      a finger comes at 0.1 m/s and presses: what a user does
tap        a fast, loose finger tuned to the wall: what makes walls bounce and buzz
dowel      a wooden stick that is pushed: no damping of its own
free air   a prescribed stroke outside the wall, where nothing should be felt
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi, sin

from zwidth.model.device.device import Device
from zwidth.model.operator import Dowel, MaliciousTouch, PrescribedMotion, TypicalTouch
from zwidth.model.operator.operator import Operator

PRESSING = 2.0
"""Force with which a finger presses, where the actuator can bear it [N]."""

STROKE, STROKE_TIME = 0.01, 0.25
"""Amplitude and period of the stroke in free air [m], [s]."""


@dataclass(frozen=True)
class Touch:
    """A hand and how long it is watched [s]."""

    hand: Operator
    duration: float


def standard_touches(device: Device, stiffness: float) -> dict[str, Touch]:
    """The touches for a wall of a stiffness [N/m] on a device.

    The push is that of a finger, or half the actuator's force limit where that is less.
    The fast finger is tuned to the wall, √(k/m_h) = √(K/m), as a malicious one would be.
    """
    limit = device.force_limit
    push = PRESSING if limit is None else min(PRESSING, float(device.exact("force_limit")) / 2)
    loose = MaliciousTouch(force=push)
    mass = float(device.exact("mass"))
    tuned = max(loose.mass * stiffness / mass, 1.0)
    stroke = PrescribedMotion(lambda t: -2 * STROKE + STROKE * sin(2 * pi * t / STROKE_TIME))
    return {
        "press": Touch(TypicalTouch(force=push), 1.5),
        "tap": Touch(MaliciousTouch(force=push, stiffness=tuned), 1.5),
        "dowel": Touch(Dowel(force=push), 1.5),
        "free air": Touch(stroke, 4 * STROKE_TIME),
    }
