"""Motor and handle, a spring and a damper between them: their motion between events.

    m₁ v₁' = −f_a(t) − b₁ v₁ − f_c1 sgn v₁ − k w − c w'                              w = x₁ − x₂
    M₂ v₂' = F − b₂ v₂ − f_c2 sgn v₂ + k w + c w' + k_h (x_a(t) − x₂) + c_h (ẋ_a − v₂)   M₂ = m₂ + m_h

by the power series of `plant`, of both bodies at once.  Each slides or sticks by itself: one that sticks is a
body of velocity 0 until the series of the force on it passes its stiction, one that slides does so until the
series of its velocity passes 0.  A handle whose motion is prescribed is a body of constant velocity.
"""

from __future__ import annotations

from typing import NamedTuple

from zwidth.loop.kernel import RECORDED
from zwidth.loop.plant import (
    COULOMB,
    DIRECTION,
    FAULT,
    FORCE,
    GOAL,
    POSITION,
    STOPS,
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
from zwidth.loop.two_bodies import (
    APART,
    FADING,
    INSIDE_LOSS,
    MOTOR,
    MOTOR_COULOMB,
    MOTOR_DIRECTION,
    MOTOR_VELOCITY,
    MOTOR_VISCOUS,
    ON_1,
    ON_2,
    ROOM,
    V1,
    V2,
    X1,
    X2,
    Start,
    TwoMasses,
    expand_two,
    pieces_of_two,
)
from zwidth.loop.two_strides import Course, at_once
from zwidth.native.compiled import Array, compiled
from zwidth.quantity.elementary import exp

R_MOTOR, R_MOTOR_VELOCITY, R_MOTOR_VISCOUS, R_MOTOR_COULOMB, R_INSIDE_LOSS = range(RECORDED, RECORDED + 5)
RECORDED_OF_TWO = RECORDED + 5

_MOST_EVENTS = 100_000


@compiled
def advance_two(
    state: Array, two: TwoMasses, force: float, anchor: float, speed: float, h: float, place: int, work: Array
) -> None:
    """Move both bodies by h seconds; arguments as of `step.advance`, work is WORK_OF_TWO long.

    `place` is 0 or 1, the first or second stretch of a sample, where h is the same in each; else −1.
    """
    elapsed, lag = 0.0, two.motor.lag
    for _ in range(_MOST_EVENTS):
        left = h - elapsed
        if left <= 0.0:
            return
        ramp, reach = slewing(state, two.motor)
        ending = reach <= left
        if ending:
            left = reach
        used = 0.0
        if place >= 0 and elapsed == ramp == lag == 0.0:
            used = _stride(state, two, force, anchor, speed, left, place, work)
        if used == 0.0:
            used = _stretch(state, two, force, anchor + speed * elapsed, speed, ramp, left, work)
        if lag > 0.0:
            state[FORCE] = state[GOAL] + (state[FORCE] - state[GOAL]) * exp(-used / lag)
        elif ramp != 0.0:
            state[FORCE] = state[GOAL] if ending and used == left else state[FORCE] + ramp * used
        elapsed = h if used == left and not ending else elapsed + used
    state[FAULT] = 1.0


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


class _Begun(NamedTuple):
    """A stretch as it begins: the bodies, the way to the anchor, the twist, what fades of the force."""

    start: Start
    slack: float
    twist: float
    transient: float


@compiled
def _begun(state: Array, two: TwoMasses, force: float, anchor: float, speed: float) -> _Begun:
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
    return _Begun(Start(v1, v2, side_1, side_2, net_1, net_2, speed), slack, twist, transient)


@compiled
def _stride(
    state: Array, two: TwoMasses, force: float, anchor: float, speed: float, h: float, place: int, work: Array
) -> float:
    """Move by h seconds at once; 0 where a body may stop or start inside, and nothing is moved."""
    begun = _begun(state, two, force, anchor, speed)
    course = at_once(two, begun.start, state[FORCE], h, place, work)
    return _end(state, two, begun, course, force, 0.0) if course.t > 0.0 else 0.0


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
    begun = _begun(state, two, force, anchor, speed)
    course = _by_series(state, two, begun.start, ramp, begun.transient, h, work)
    return _end(state, two, begun, course, force, ramp)


@compiled
def _end(state: Array, two: TwoMasses, begun: _Begun, course: Course, force: float, ramp: float) -> float:
    """Write down where both are and every energy; returns the time used."""
    motor, handle, (start, slack, twist, transient) = two.motor, two.handle, begun
    v2, side_1, side_2, speed = start.v2, start.side_1, start.side_2, start.speed
    t, to_1, after_1, to_2, after_2, moved_1, moved_2, way_1, way_2, taken, fast_1, fast_2, apart = course
    state[STOPS] += abs(side_1) * (1.0 - abs(after_1)) + abs(side_2) * (1.0 - abs(after_2))
    viscous, dry = motor.damping * fast_1, motor.coulomb * abs(moved_1)
    state[INSIDE_LOSS] += two.damper * apart
    push = force
    if two.driven > 0.0 and t > 0.0:  # what the hand gives, on the mean
        inside = two.spring * (twist * t + way_1 - way_2) + two.damper * (moved_1 - moved_2)
        push = handle.damping * v2 + handle.coulomb * side_2 - inside / t
    drive = Drive(push, slack, speed, 0.0, 0.0, ramp, transient)
    book(state, handle, drive, t, moved_2, way_2, fast_2, taken, v2, to_2)
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
def _by_series(
    state: Array, two: TwoMasses, start: Start, ramp: float, transient: float, h: float, work: Array
) -> Course:
    """Up to the first stop or start of either body, or a piece of the stretch."""
    motor, handle, side_1, side_2 = two.motor, two.handle, start.side_1, start.side_2
    length = h / pieces_of_two(two, h)
    terms = expand_two(two, start, ramp, transient, length, work)
    turn_1 = _event(work, V1, ON_1, terms, side_1, motor.stiction)
    turn_2 = 2.0 if two.driven > 0.0 else _event(work, V2, ON_2, terms, side_2, handle.stiction)
    u = min(turn_1, turn_2, 1.0)
    t = length if u == 1.0 else u * length
    to_1, after_1 = _after(work, V1, ON_1, terms, u, turn_1, side_1, motor.stiction)
    to_2, after_2 = start.v2, side_2
    if two.driven == 0.0:
        to_2, after_2 = _after(work, V2, ON_2, terms, u, turn_2, side_2, handle.stiction)
    moved_1, moved_2 = value(work, X1, terms, u), value(work, X2, terms, u)

    way_1 = length * integral(work, X1, terms, u) if ramp != 0.0 or two.driven > 0.0 else 0.0
    way_2 = length * integral(work, X2, terms, u) if handle.stiffness > 0.0 or two.driven > 0.0 else 0.0
    if motor.lag > 0.0:
        taken = state[GOAL] * moved_1 + length * product_integral(work, V1, FADING, terms, u)
    else:
        taken = state[FORCE] * moved_1 + ramp * (t * moved_1 - way_1)
    fast_1 = fast_2 = apart = 0.0
    if motor.damping > 0.0 and side_1 != 0.0:
        fast_1 = length * product_integral(work, V1, V1, terms, u)
    if handle.damping + handle.hand_damping > 0.0 and side_2 != 0.0:
        fast_2 = length * product_integral(work, V2, V2, terms, u)
    if two.damper > 0.0:
        apart = length * product_integral(work, APART, APART, terms, u)
    return Course(
        t, to_1, after_1, to_2, after_2, moved_1, moved_2, way_1, way_2, taken, fast_1, fast_2, apart
    )


@compiled
def _event(work: Array, own: int, on: int, terms: int, side: float, stiction: float) -> float:
    """The first u in [0, 1] at which a body that slides stops, or one that sticks starts; 2 if none."""
    if stiction == 0.0:
        return 2.0
    if side != 0.0:
        return first_zero(work, own, terms, side)
    upward = _passing(work, on, terms, 1.0, stiction)  # each leaves its series in work: one after the other
    return min(upward, _passing(work, on, terms, -1.0, stiction))


@compiled
def _passing(work: Array, on: int, terms: int, side: float, stiction: float) -> float:
    """When the force on a body that sticks passes what holds it, on one side."""
    work[ROOM] = max(stiction, abs(work[on])) - side * work[on]
    for n in range(1, terms):
        work[ROOM + n] = -side * work[on + n]
    return first_zero(work, ROOM, terms, 1.0)


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


PARTS = (_stretch, expand_two, _event, _passing, _after)
"""What stays a function of its own where the step is written out."""
