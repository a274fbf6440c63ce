"""Motor and handle between events: what does not change, and the power series of both."""

from __future__ import annotations

from math import ceil, sqrt
from typing import Any, NamedTuple

import numpy as np

from zwidth.errors import InputError
from zwidth.loop.kernel import packed_plant
from zwidth.loop.plant import DIRECTION, POSITION, STATE_SIZE, TERMS, VELOCITY, Plant
from zwidth.model.device.device import Device
from zwidth.model.operator.operator import Operator
from zwidth.native.compiled import Array, compiled
from zwidth.quantity.exact import Interval
from zwidth.quantity.text import shown


class TwoMasses(NamedTuple):
    """What does not change: the motor and its amplifier; the handle and the hand on it; what is between.

    `sensed` is 1 where the encoder reads the handle, `driven` where the motion of the handle is prescribed.
    """

    motor: Plant
    handle: Plant
    spring: float
    damper: float
    sensed: float
    driven: float


class Start(NamedTuple):
    """How a stretch begins: velocities, directions (0 of a body that sticks), forces but for the bodies' own
    damping, and the speed of the anchor."""

    v1: float
    v2: float
    side_1: float
    side_2: float
    on_1: float
    on_2: float
    speed: float


# Where the series stand: velocity and way of the handle, what fades of the actuator force, velocity and way
# of the motor, the difference of the velocities, the forces on either at rest, and room for one more.
V2, X2, FADING, V1, X1, APART, ON_1, ON_2, ROOM = (TERMS * i for i in range(9))
SERIES_OF_TWO = 9 * TERMS


# The state is that of `plant`, its position, velocity and direction those of the handle, its losses those of
# both sides; behind it the motor's.
MOTOR, MOTOR_VELOCITY, MOTOR_DIRECTION, MOTOR_VISCOUS, MOTOR_COULOMB, INSIDE_LOSS = range(
    STATE_SIZE, STATE_SIZE + 6
)
STATE_OF_TWO = STATE_SIZE + 6

_NUMBERS = (
    "mass",
    *(f"transmission.{key}" for key in ("stiffness", "damping", "handle_mass", "handle_damping")),
    "transmission.handle_coulomb_friction",
)


def numbers_of(device: Device, operator: Operator, motor: Plant, most: int) -> Array | None:
    """Of the bodies of a device, in at most so many pieces a period; None of one without a transmission.

    Raises
    ------
    InputError
        If a number is unknown or an interval, or they move too fast.
    """
    between, hand, period = device.transmission, operator.hand, float(device.exact("sample_period"))
    if between is None:
        return None
    given: dict[str, Any] = {f"transmission.{key}": value for key, value in between.parameters().items()}
    given |= device.parameters()
    for key in _NUMBERS:
        if key not in given:
            raise InputError(
                f"{key} is unknown, and two masses are simulated: give it; or leave the transmission out, as "
                "device.motor_side does"
            )
        if isinstance(given[key], Interval):
            raise InputError(f"{key} is the interval {given[key]}; a simulated motion needs one value of it")
    own, spring, damper, mass, drag, dry = (float(given[key]) for key in _NUMBERS)
    two = TwoMasses(
        motor._replace(mass=own, hand_mass=0.0, stiffness=0.0, hand_damping=0.0),
        Plant(mass, hand.mass, drag, dry, dry, hand.stiffness, hand.damping, motor.lag, motor.slew),
        spring,
        damper,
        float(between.encoder == "handle"),
        float(operator.kinematic),
    )
    if pieces_of_two(two, period) > most:
        raise InputError(
            f"motor, handle and transmission move over {most} times faster than the sample period "
            f"{shown(period, 's', 6)}: on this scale they are rigid; give the device without its transmission"
        )
    return np.array([*two.motor, *two.handle, *two[2:]])


def state_of(one: Array) -> Array:
    """The state of two masses that start together, as the one mass does."""
    behind = np.zeros(STATE_OF_TWO - STATE_SIZE)
    behind[:3] = one[[POSITION, VELOCITY, DIRECTION]]
    return np.concatenate([one, behind])


@compiled
def packed_two(p: Array) -> TwoMasses:
    """The bodies from the numbers of their array."""
    return TwoMasses(packed_plant(p[:9]), packed_plant(p[9:18]), p[18], p[19], p[20], p[21])


@compiled
def pieces_of_two(two: TwoMasses, h: float) -> float:
    """Into how many parts a stretch of h seconds is cut: q ≤ 1.43, which TERMS coefficients bear.

    The traces of stiffness and damping over the masses are no less than the largest rates.
    """
    first, hand = two.motor, two.handle
    light = 0.0 if two.driven > 0.0 else 1.0 / (hand.mass + hand.hand_mass)
    stiff = two.spring / first.mass + (two.spring + hand.stiffness) * light
    drag = (first.damping + two.damper) / first.mass
    drag += (hand.damping + hand.hand_damping + two.damper) * light
    q = max(sqrt(stiff), drag) * h
    if first.lag > 0.0:
        q = max(q, h / first.lag)
    return max(1.0, ceil(0.7 * q))


@compiled
def is_free(two: TwoMasses, side_2: float) -> bool:
    """True of a handle that its forces move."""
    return two.driven == 0.0 and side_2 != 0.0


@compiled
def expand_two(two: TwoMasses, start: Start, ramp: float, transient: float, h: float, work: Array) -> int:
    """Fill in all the series in u = t/h; returns how many coefficients of each."""
    v1, v2, free_1, free_2 = start.v1, start.v2, start.side_1 != 0.0, is_free(two, start.side_2)
    motor, handle, spring, damper = two.motor, two.handle, two.spring, two.damper
    scale_1, scale_2 = h / motor.mass, h / (handle.mass + handle.hand_mass)
    drag_1, drag_2 = motor.damping + damper, handle.damping + handle.hand_damping + damper
    work[V1], work[V2], work[APART] = v1, v2, v1 - v2
    work[X1], work[X2], work[FADING] = 0.0, 0.0, transient
    work[ON_1], work[ON_2] = start.on_1, start.on_2
    size, small = max(abs(v1), abs(v2)) * h, 0
    for n in range(TERMS - 1):
        over = 1.0 / (n + 1.0)
        a, b = work[V1 + n], work[V2 + n]
        work[V1 + n + 1] = scale_1 * (work[ON_1 + n] - drag_1 * a) * over if free_1 else 0.0
        work[V2 + n + 1] = scale_2 * (work[ON_2 + n] - drag_2 * b) * over if free_2 else 0.0
        work[X1 + n + 1], work[X2 + n + 1] = h * a * over, h * b * over
        work[FADING + n + 1] = -h * work[FADING + n] * over / motor.lag if motor.lag > 0.0 else 0.0
        given_1, given_2 = -work[FADING + n + 1], 0.0
        if n == 0:
            given_1, given_2 = given_1 - ramp * h, handle.stiffness * start.speed * h
        inner = spring * (work[X1 + n + 1] - work[X2 + n + 1])
        work[APART + n + 1] = work[V1 + n + 1] - work[V2 + n + 1]
        work[ON_1 + n + 1] = given_1 - inner + damper * work[V2 + n + 1]
        work[ON_2 + n + 1] = given_2 + inner + damper * work[V1 + n + 1] - handle.stiffness * work[X2 + n + 1]
        term = max(abs(work[V1 + n + 1]), abs(work[V2 + n + 1])) * h
        term = max(term, max(abs(work[X1 + n + 1]), abs(work[X2 + n + 1])))
        if transient != 0.0:
            term = max(term, scale_1 * h * abs(work[FADING + n + 1]))
        size = max(size, term)
        small = small + 1 if term <= 1e-19 * size else 0
        if small >= 3:
            return n + 2
    return TERMS
