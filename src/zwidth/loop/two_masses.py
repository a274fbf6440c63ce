"""Motor and handle, a spring and a damper between them: their motion between events, and the sampled loop.

    m₁ v₁' = −f_a(t) − b₁ v₁ − f_c1 sgn v₁ − k w − c w'                              w = x₁ − x₂
    M₂ v₂' = F − b₂ v₂ − f_c2 sgn v₂ + k w + c w' + k_h (x_a(t) − x₂) + c_h (ẋ_a − v₂)   M₂ = m₂ + m_h

by the power series of `plant`, of both bodies at once.  Each slides or sticks by itself: one that sticks is a
body of velocity 0 until the series of the force on it passes its stiction, one that slides does so until the
series of its velocity passes 0.  A handle whose motion is prescribed is a body of constant velocity.
"""

from __future__ import annotations

from math import ceil, sqrt
from typing import Any, NamedTuple

import numpy as np

from zwidth.errors import InputError
from zwidth.loop.kernel import (
    R_COMMAND,
    R_READING,
    RECORDED,
    apply_due,
    arrival,
    first_due,
    in_interval,
    note,
    on_the_way,
    packed_plant,
    sample,
)
from zwidth.loop.plant import (
    COULOMB,
    DIRECTION,
    FAULT,
    FORCE,
    GOAL,
    HAND_WORK,
    POSITION,
    SOURCE_WORK,
    STATE_SIZE,
    STOPS,
    TERMS,
    VELOCITY,
    VISCOUS,
    Drive,
    Plant,
    first_zero,
    integral,
    product_integral,
    value,
)
from zwidth.loop.step import ROUNDING, book, slewing
from zwidth.model.device.device import Device
from zwidth.model.operator.operator import Operator
from zwidth.native.compiled import Array, compiled
from zwidth.quantity.elementary import exp
from zwidth.quantity.exact import Interval


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


# The state is that of `plant`, its position, velocity and direction those of the handle, its losses those of
# both sides; behind it the motor's.
MOTOR, MOTOR_VELOCITY, MOTOR_DIRECTION, MOTOR_VISCOUS, MOTOR_COULOMB, INSIDE_LOSS = range(
    STATE_SIZE, STATE_SIZE + 6
)
STATE_OF_TWO = STATE_SIZE + 6

R_MOTOR, R_MOTOR_VELOCITY, R_MOTOR_VISCOUS, R_MOTOR_COULOMB, R_INSIDE_LOSS = range(RECORDED, RECORDED + 5)
RECORDED_OF_TWO = RECORDED + 5

# Where the series stand: velocity and way of the handle, what fades of the actuator force, velocity and way
# of the motor, the difference of the velocities, the forces on either at rest, and room for one more.
_V2, _X2, _FADING, _V1, _X1, _APART, _ON_1, _ON_2, _ROOM = (TERMS * i for i in range(9))
WORK_OF_TWO = 9 * TERMS

_NUMBERS = (
    "mass",
    *(f"transmission.{key}" for key in ("stiffness", "damping", "handle_mass", "handle_damping")),
    "transmission.handle_coulomb_friction",
)

_MOST_EVENTS = 100_000


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
            f"motor, handle and transmission move over {most} times faster than the sample period {period:g} "
            "s: on this scale they are rigid; give the device without its transmission"
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
def advance_two(
    state: Array, two: TwoMasses, force: float, anchor: float, speed: float, h: float, work: Array
) -> None:
    """Move both bodies by h seconds; arguments as of `step.advance`, work is WORK_OF_TWO long."""
    elapsed, lag = 0.0, two.motor.lag
    for _ in range(_MOST_EVENTS):
        left = h - elapsed
        if left <= 0.0:
            return
        ramp, reach = slewing(state, two.motor)
        ending = reach <= left
        if ending:
            left = reach
        used = _stretch(state, two, force, anchor + speed * elapsed, speed, ramp, left, work)
        if lag > 0.0:
            state[FORCE] = state[GOAL] + (state[FORCE] - state[GOAL]) * exp(-used / lag)
        elif ramp != 0.0:
            state[FORCE] = state[GOAL] if ending and used == left else state[FORCE] + ramp * used
        elapsed = h if used == left and not ending else elapsed + used
    state[FAULT] = 1.0


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
def _side_of(direction: float, external: float, stiction: float, rounding: float) -> float:
    """The direction in which a body slides, 0 of one that sticks; 1 of one that never does."""
    if stiction == 0.0:
        return 1.0
    if direction != 0.0:
        return direction
    if abs(external) <= stiction + rounding:
        return 0.0
    return 1.0 if external > 0.0 else -1.0


@compiled
def _net(external: float, side: float, velocity: float, body: Plant) -> float:
    """The force on a body but for its own damping; of one that has just broken away to the last digit."""
    if body.stiction > 0.0 and side != 0.0 and velocity == 0.0 and side * external <= body.stiction:
        return side * (body.stiction - body.coulomb)
    return external - side * body.coulomb


@compiled
def _stretch(
    state: Array,
    two: TwoMasses,
    force: float,
    anchor: float,
    speed: float,
    ramp: float,
    h: float,
    work: Array,
) -> float:
    """Move by at most h seconds, up to the first stop or start of either body; returns the time used."""
    motor, handle = two.motor, two.handle
    v1, v2, twist = state[MOTOR_VELOCITY], state[VELOCITY], state[MOTOR] - state[POSITION]
    slack = anchor - state[POSITION]
    pull, drag, between = handle.stiffness * slack, handle.hand_damping * speed, two.spring * twist
    transient = state[FORCE] - state[GOAL] if motor.lag > 0.0 else 0.0
    on_1 = two.damper * v2 - between - state[FORCE]
    on_2 = force + pull + drag + between + two.damper * v1
    size = abs(force) + abs(pull) + abs(drag) + abs(between) + abs(state[FORCE]) + abs(state[GOAL])
    size = ROUNDING * (size + two.damper * (abs(v1) + abs(v2)))
    side_1 = _side_of(state[MOTOR_DIRECTION], on_1, motor.stiction, size)
    side_2 = state[DIRECTION]
    if two.driven == 0.0:
        side_2 = _side_of(side_2, on_2, handle.stiction, size)
    net_1, net_2 = _net(on_1, side_1, v1, motor), _net(on_2, side_2, v2, handle)
    length = h / pieces_of_two(two, h)
    free_2 = two.driven == 0.0 and side_2 != 0.0
    terms = _expand(two, v1, v2, net_1, net_2, side_1 != 0.0, free_2, speed, ramp, transient, length, work)

    turn_1 = _event(work, _V1, _ON_1, terms, side_1, motor.stiction)
    turn_2 = 2.0 if two.driven > 0.0 else _event(work, _V2, _ON_2, terms, side_2, handle.stiction)
    u = min(turn_1, turn_2, 1.0)
    t = length if u == 1.0 else u * length
    to_1, after_1 = _after(work, _V1, _ON_1, terms, u, turn_1, side_1, motor.stiction)
    to_2, after_2 = v2, side_2
    if two.driven == 0.0:
        to_2, after_2 = _after(work, _V2, _ON_2, terms, u, turn_2, side_2, handle.stiction)
    state[STOPS] += abs(side_1) * (1.0 - abs(after_1)) + abs(side_2) * (1.0 - abs(after_2))
    moved_1, moved_2 = value(work, _X1, terms, u), value(work, _X2, terms, u)

    way_1 = length * integral(work, _X1, terms, u) if ramp != 0.0 or two.driven > 0.0 else 0.0
    way_2 = length * integral(work, _X2, terms, u) if handle.stiffness > 0.0 or two.driven > 0.0 else 0.0
    if motor.lag > 0.0:
        taken = state[GOAL] * moved_1 + length * product_integral(work, _V1, _FADING, terms, u)
    else:
        taken = state[FORCE] * moved_1 + ramp * (t * moved_1 - way_1)
    viscous, dry, squares = 0.0, motor.coulomb * abs(moved_1), 0.0
    if motor.damping > 0.0 and side_1 != 0.0:
        viscous = motor.damping * length * product_integral(work, _V1, _V1, terms, u)
    if handle.damping + handle.hand_damping > 0.0 and side_2 != 0.0:
        squares = length * product_integral(work, _V2, _V2, terms, u)
    if two.damper > 0.0:
        state[INSIDE_LOSS] += two.damper * length * product_integral(work, _APART, _APART, terms, u)
    push = force
    if two.driven > 0.0 and t > 0.0:  # what the hand gives, on the mean
        inside = two.spring * (twist * t + way_1 - way_2) + two.damper * (moved_1 - moved_2)
        push = handle.damping * v2 + handle.coulomb * side_2 - inside / t
    drive = Drive(push, slack, speed, 0.0, 0.0, ramp, transient)
    book(state, handle, drive, t, moved_2, way_2, squares, taken, v2, to_2)
    state[MOTOR_VISCOUS] += viscous
    state[VISCOUS] += viscous
    state[MOTOR_COULOMB] += dry
    state[COULOMB] += dry

    state[MOTOR] += moved_1
    state[POSITION] += moved_2
    state[MOTOR_VELOCITY], state[MOTOR_DIRECTION] = to_1, after_1
    state[VELOCITY], state[DIRECTION] = to_2, after_2
    return t


@compiled
def _expand(
    two: TwoMasses,
    v1: float,
    v2: float,
    net_1: float,
    net_2: float,
    free_1: bool,
    free_2: bool,
    speed: float,
    ramp: float,
    transient: float,
    h: float,
    work: Array,
) -> int:
    """Fill in all the series in u = t/h; returns how many coefficients of each."""
    motor, handle, spring, damper = two.motor, two.handle, two.spring, two.damper
    scale_1, scale_2 = h / motor.mass, h / (handle.mass + handle.hand_mass)
    drag_1, drag_2 = motor.damping + damper, handle.damping + handle.hand_damping + damper
    work[_V1], work[_V2], work[_APART] = v1, v2, v1 - v2
    work[_X1], work[_X2], work[_FADING] = 0.0, 0.0, transient
    work[_ON_1], work[_ON_2] = net_1, net_2
    size, small = max(abs(v1), abs(v2)) * h, 0
    for n in range(TERMS - 1):
        over = 1.0 / (n + 1.0)
        a, b = work[_V1 + n], work[_V2 + n]
        work[_V1 + n + 1] = scale_1 * (work[_ON_1 + n] - drag_1 * a) * over if free_1 else 0.0
        work[_V2 + n + 1] = scale_2 * (work[_ON_2 + n] - drag_2 * b) * over if free_2 else 0.0
        work[_X1 + n + 1], work[_X2 + n + 1] = h * a * over, h * b * over
        work[_FADING + n + 1] = -h * work[_FADING + n] * over / motor.lag if motor.lag > 0.0 else 0.0
        given_1, given_2 = -work[_FADING + n + 1], 0.0
        if n == 0:
            given_1, given_2 = given_1 - ramp * h, handle.stiffness * speed * h
        inner = spring * (work[_X1 + n + 1] - work[_X2 + n + 1])
        work[_APART + n + 1] = work[_V1 + n + 1] - work[_V2 + n + 1]
        work[_ON_1 + n + 1] = given_1 - inner + damper * work[_V2 + n + 1]
        work[_ON_2 + n + 1] = (
            given_2 + inner + damper * work[_V1 + n + 1] - handle.stiffness * work[_X2 + n + 1]
        )
        term = max(abs(work[_V1 + n + 1]), abs(work[_V2 + n + 1])) * h
        term = max(term, max(abs(work[_X1 + n + 1]), abs(work[_X2 + n + 1])))
        if transient != 0.0:
            term = max(term, scale_1 * h * abs(work[_FADING + n + 1]))
        size = max(size, term)
        small = small + 1 if term <= 1e-19 * size else 0
        if small >= 3:
            return n + 2
    return TERMS


@compiled
def _event(work: Array, own: int, on: int, terms: int, side: float, stiction: float) -> float:
    """The first u in [0, 1] at which a body that slides stops, or one that sticks starts; 2 if none."""
    if stiction == 0.0:
        return 2.0
    if side != 0.0:
        return first_zero(work[own : own + TERMS], terms, side)
    return min(_passing(work, on, terms, 1.0, stiction), _passing(work, on, terms, -1.0, stiction))


@compiled
def _passing(work: Array, on: int, terms: int, side: float, stiction: float) -> float:
    """When the force on a body that sticks passes what holds it, on one side."""
    work[_ROOM] = max(stiction, abs(work[on])) - side * work[on]
    for n in range(1, terms):
        work[_ROOM + n] = -side * work[on + n]
    return first_zero(work[_ROOM : _ROOM + TERMS], terms, 1.0)


@compiled
def _after(
    work: Array, own: int, on: int, terms: int, u: float, turn: float, side: float, stiction: float
) -> tuple[float, float]:
    """A body's velocity and direction at u: both 0 where it stops, or where rounding has turned it."""
    if stiction == 0.0:
        return value(work, own, terms, u), side
    if side == 0.0:  # what comes after 1 may hold it
        starts = turn == u and u < 1.0
        return 0.0, (1.0 if value(work, on, terms, u) > 0.0 else -1.0) if starts else 0.0
    v = value(work, own, terms, u)
    if turn == u or (u > 0.0 and v * side <= 0.0):
        return 0.0, 0.0
    return v, side


@compiled
def run_two(
    first: int,
    last: int,
    points: int,
    state: Array,
    numbers: Array,
    law: Array,
    memory: Array,
    work: Array,
    late: int,
    offset: float,
    lengths: Array,
    arrivals: Array,
    missed: Array,
    force: Array,
    anchor: Array,
    target: Array,
    switch: Array,
    commands: Array,
    record: Array,
) -> None:
    """Run as `kernel.run` does; state, numbers, work and record are those of two bodies."""
    two = packed_two(numbers)
    samples = commands.shape[0] - 1
    due = first_due(first, late, arrivals)
    for k in range(first, last):
        final = k == samples
        h = 0.0 if final else (lengths[0] if lengths.shape[0] == 1 else lengths[k])
        place = state[POSITION] if two.sensed > 0.0 else state[MOTOR]
        reading, command = sample(k, points, place, state, law, memory, missed, commands, record)
        for column in range(k * points, min((k + 1) * points, record.shape[1])):
            record[R_READING, column], record[R_COMMAND, column] = reading, command
        hand = in_interval(k, h, final, state[POSITION], force, anchor, target, switch)
        now = 0.0
        for point in range(points):
            due = apply_due(state, two.motor, due, k, now, late, offset, arrivals, commands)
            _note(state, k * points + point, record)
            if final:
                return
            end = h if point == points - 1 else h * (point + 1) / points
            while now < end:
                until = min(arrival(due, k, late, offset, arrivals), end)
                if hand.kinematic:
                    if hand.bent and now < offset:
                        until = min(until, offset)
                    _carry(state, two, on_the_way(hand, offset, until, h), until - now, work)
                else:
                    here = hand.anchor + hand.speed * now
                    advance_two(state, two, hand.push, here, hand.speed, until - now, work)
                now = until
                if now < end:
                    due = apply_due(state, two.motor, due, k, now, late, offset, arrivals, commands)


@compiled
def _carry(state: Array, two: TwoMasses, target: float, h: float, work: Array) -> None:
    """The handle goes to `target` in h seconds at constant velocity, after an impulse of the hand on it."""
    v0, v1 = state[VELOCITY], (target - state[POSITION]) / h
    impulse = 0.5 * two.handle.mass * (v1 - v0) * (v1 + v0)
    state[HAND_WORK] += impulse
    state[SOURCE_WORK] += impulse
    state[VELOCITY] = v1
    state[DIRECTION] = 1.0 if v1 > 0.0 else (-1.0 if v1 < 0.0 else 0.0)
    advance_two(state, two, 0.0, 0.0, 0.0, h, work)
    state[POSITION] = target


@compiled
def _note(state: Array, column: int, record: Array) -> None:
    note(state, column, record)
    record[R_MOTOR, column] = state[MOTOR]
    record[R_MOTOR_VELOCITY, column] = state[MOTOR_VELOCITY]
    record[R_MOTOR_VISCOUS, column] = state[MOTOR_VISCOUS]
    record[R_MOTOR_COULOMB, column] = state[MOTOR_COULOMB]
    record[R_INSIDE_LOSS, column] = state[INSIDE_LOSS]
