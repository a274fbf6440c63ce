"""The sampled pair: both arms measure, send, hear, compute, apply after their delays, and move.

A tick is the time between two readings of an arm's own; every `often` ticks, which is T, both send what they
read and hear what has arrived.  Between two changes of force each arm moves alone, exactly, as `loop.kernel`
has it.
"""

from __future__ import annotations

from math import ceil, sqrt
from typing import NamedTuple

from zwidth.loop.kernel import (
    R_COMMAND,
    R_READING,
    Hand,
    apply_due,
    arrival,
    first_due,
    in_interval,
    note,
    on_the_way,
    travel,
)
from zwidth.loop.law import measured, rounded
from zwidth.loop.plant import FAULT, POSITION, SATURATED, VELOCITY, Plant
from zwidth.loop.step import advance, carry
from zwidth.native.compiled import Array, compiled
from zwidth.quantity.elementary import tanh


class Law(NamedTuple):
    """What one side computes: taps of readings, the newest first, and what compensates friction.

    `own` at its own readings, each after `every` ticks; `heard` of the other and `echo` of its own, old
    readings, once in T.
    """

    own: float
    own_before: float
    every: int
    heard: float
    heard_before: float
    age: int
    echo: float
    echo_before: float
    echo_age: int
    coulomb: float
    viscous: float
    speed: float
    period: float
    resolution: float
    phase: float
    step: float
    limit: float


class Arm(NamedTuple):
    """One side in arrays: what is changed, and what its hand does.

    `told` holds what the newest readings of T make of the force; `wall` is 1 where a real wall stands at
    x = 0, and the plant inside it is `inside`; `curve` has the lines of its friction, none where that is the
    plant's own.
    """

    plant: Plant
    inside: Plant
    wall: int
    curve: Array
    law: Law
    late: int
    offset: float
    state: Array
    readings: Array
    sent: Array
    told: Array
    commands: Array
    record: Array
    force: Array
    anchor: Array
    target: Array
    switch: Array


@compiled
def run_pair(
    first: int, last: int, often: int, points: int, h: float, leader: Arm, follower: Arm, work: Array
) -> None:
    """Run the ticks `first` … `last` − 1, and the last sample when last is one more; can be called again."""
    nothing = work[:0].reshape((2, 0))
    ticks = leader.commands.shape[0] - 1
    due, its_due = first_due(first, leader.late, nothing), first_due(first, follower.late, nothing)
    for k in range(first, last):
        for arm in (leader, follower):
            read(arm, k)
        if k % often == 0:
            j = k // often
            leader.sent[j], follower.sent[j] = leader.readings[k], follower.readings[k]
            hear(leader, follower, j)
            hear(follower, leader, j)
        for arm in (leader, follower):
            command(arm, k, points)
        due = through(leader, due, k, points, h, k == ticks, work)
        its_due = through(follower, its_due, k, points, h, k == ticks, work)


@compiled
def read(arm: Arm, k: int) -> None:
    """Take the reading of tick k, or keep the last one."""
    if k % arm.law.every != 0:
        arm.readings[k] = arm.readings[k - 1]
        return
    arm.readings[k] = measured(arm.state[POSITION], arm.law.resolution, arm.law.phase)


@compiled
def at(sent: Array, j: int) -> float:
    """The reading of sample j; before the first one the arm was where it is at the first."""
    return sent[max(j, 0)]


@compiled
def hear(arm: Arm, other: Arm, j: int) -> None:
    """What the readings that have arrived by sample j add to the force until the next."""
    law = arm.law
    heard, echo = j - law.age, j - law.echo_age
    told = law.heard * at(other.sent, heard) + law.heard_before * at(other.sent, heard - 1)
    told += law.echo * at(arm.sent, echo) + law.echo_before * at(arm.sent, echo - 1)
    v = (at(arm.sent, j) - at(arm.sent, j - 1)) / law.period
    told -= law.viscous * v
    if law.coulomb != 0.0 and v != 0.0:
        share = tanh(v / law.speed) if law.speed > 0.0 else (1.0 if v > 0.0 else -1.0)
        told -= law.coulomb * share
    arm.told[0] = told


@compiled
def command(arm: Arm, k: int, points: int) -> None:
    """The force that the newest readings ask for, in steps of the converter and up to the limit."""
    law, state = arm.law, arm.state
    last = law.every * (k // law.every - 1)
    f = law.own * arm.readings[k] + law.own_before * arm.readings[max(last, 0)] + arm.told[0]
    f = rounded(f, law.step)
    if law.limit > 0.0 and abs(f) > law.limit:
        state[SATURATED] += 1.0
        f = law.limit if f > 0.0 else -law.limit
    arm.commands[k] = f
    for column in range(k * points, min((k + 1) * points, arm.record.shape[1])):
        arm.record[R_READING, column] = arm.readings[k]
        arm.record[R_COMMAND, column] = f


@compiled
def through(arm: Arm, due: int, k: int, points: int, h: float, final: bool, work: Array) -> int:
    """Note tick k and move on to the next; returns the next command that is due."""
    nothing = work[:0].reshape((2, 0))
    length = 0.0 if final else h
    hand = in_interval(k, length, final, arm.state[POSITION], arm.force, arm.anchor, arm.target, arm.switch)
    now = 0.0
    for point in range(points):
        due = apply_due(arm.state, arm.plant, due, k, now, arm.late, arm.offset, nothing, arm.commands)
        note(arm.state, k * points + point, arm.record)
        if final:
            return due
        end = h if point == points - 1 else h * (point + 1) / points
        due = go(arm, hand, now, end, h, due, k, work)
        now = end
    return due


@compiled
def go(arm: Arm, hand: Hand, start: float, end: float, h: float, due: int, k: int, work: Array) -> int:
    """Move from `start` to `end` of tick k, with a hand or against a wall; returns the next command due."""
    nothing = work[:0].reshape((2, 0))
    if arm.wall == 0 and arm.curve.shape[0] == 0:
        return travel(
            arm.state, arm.plant, hand, start, end, h, due, k, arm.late, arm.offset, nothing,
            arm.commands, work,
        )  # fmt: skip
    now = start
    while now < end:
        until = min(arrival(due, k, arm.late, arm.offset, nothing), end)
        if arm.wall == 1:
            advance_against(arm.state, arm.plant, arm.inside, arm.curve, until - now, work)
        elif hand.kinematic:
            if hand.bent and now < arm.offset:
                until = min(until, arm.offset)
            there = on_the_way(hand, arm.offset, until, h)
            fast = abs(there - arm.state[POSITION]) / (until - now)
            carry(arm.state, on_line(arm.plant, arm.curve, line_of(arm.curve, fast)), there, until - now)
        else:
            here = hand.anchor + hand.speed * now
            advance_on(arm.state, arm.plant, arm.curve, hand.push, here, hand.speed, until - now, work)
        now = until
        if now < end:
            due = apply_due(arm.state, arm.plant, due, k, now, arm.late, arm.offset, nothing, arm.commands)
    return due


# An arm whose friction is a curve of straight lines: each is Coulomb and viscous friction, of any sign.
#
#     f(v) = f_i + b_i |v|  for v_i ≤ |v| < v_{i+1},    stuck up to f(0)
#
# Within a line the motion has its closed form; where the speed leaves it is found to the last bits, so that
# every joule is that of the line it was lost on.  Where friction falls an arm may stick and slip.


FROM, COULOMB_PART, VISCOUS_PART = range(3)
"""Of a line: v_i, f_i, b_i."""

_LOOKS = 8
"""How often in a stretch it is looked whether the speed has left its line, at least."""

_MOST = 100_000
_BISECTIONS = 60


@compiled
def line_of(curve: Array, speed: float) -> int:
    """The line on which a speed lies."""
    i = 0
    while i + 1 < curve.shape[0] and speed >= curve[i + 1, FROM]:
        i += 1
    return i


@compiled
def on_line(plant: Plant, curve: Array, i: int) -> Plant:
    """The plant with the friction of one line."""
    return Plant(
        plant.mass,
        plant.hand_mass,
        curve[i, VISCOUS_PART],
        curve[i, COULOMB_PART],
        plant.stiction,
        plant.stiffness,
        plant.hand_damping,
        plant.lag,
        plant.slew,
    )


@compiled
def advance_on(
    state: Array, plant: Plant, curve: Array, push: float, anchor: float, speed: float, h: float, work: Array
) -> None:
    """As `step.advance`, with the friction of a curve; without one the same.

    A speed that leaves its line and comes back between two looks is not seen to have left it.
    """
    if curve.shape[0] == 0:
        advance(state, plant, push, anchor, speed, h, work)
        return
    mass, now = plant.mass + plant.hand_mass, 0.0
    for _ in range(_MOST):
        if now >= h:
            return
        before = state.copy()
        i = line_of(curve, abs(state[VELOCITY]))
        own = on_line(plant, curve, i)
        quick = max(abs(own.damping + own.hand_damping) / mass, sqrt(own.stiffness / mass))
        step = min(h - now, h / max(_LOOKS, ceil(4.0 * quick * h)))
        here = anchor + speed * now
        advance(state, own, push, here, speed, step, work)
        if _left(curve, i, before, state):
            low = 0.0
            for _ in range(_BISECTIONS):
                middle = 0.5 * (low + step)
                if middle <= low or middle >= step:
                    break
                state[:] = before
                advance(state, own, push, here, speed, middle, work)
                if _left(curve, i, before, state):
                    step = middle
                else:
                    low = middle
            state[:] = before
            advance(state, own, push, here, speed, step, work)
        now = h if now + step >= h else now + step
    state[FAULT] = 1.0


@compiled
def _left(curve: Array, i: int, before: Array, state: Array) -> bool:
    """Whether the speed is on another line, or on this one the other way."""
    turned = i > 0 and before[VELOCITY] * state[VELOCITY] <= 0.0
    return turned or line_of(curve, abs(state[VELOCITY])) != i


# An arm against a real wall: a spring and a damper in continuous time, on one side of x = 0 only.

"""How often in a stretch it is looked whether the arm has met or left the wall, at least."""


@compiled
def advance_against(state: Array, free: Plant, inside: Plant, curve: Array, h: float, work: Array) -> None:
    """Move by h seconds under a constant actuator force; as `inside` where x > 0, as `free` elsewhere.

    The instant at which x passes 0 is found to the last bits, so that the wall gives back no more than it
    took.  An arm that goes in and out again between two looks is not seen to have met it.
    """
    looks = _LOOKS
    if inside.stiffness > 0.0:  # 20 in the half period of a contact
        looks = max(looks, ceil(h * 20.0 / 3.2 * sqrt(inside.stiffness / inside.mass)))
    for look in range(looks):
        left = h * (look + 1) / looks - h * look / looks
        x = state[POSITION]
        within = x > 0.0 or (x == 0.0 and state[VELOCITY] > 0.0)
        for _ in range(4):  # it passes 0 once, or not at all; more often only by rounding
            before = state.copy()
            advance_on(state, inside if within else free, curve, 0.0, 0.0, 0.0, left, work)
            if (state[POSITION] > 0.0) == within or state[POSITION] == 0.0:
                break
            low, high = 0.0, left
            for _ in range(_BISECTIONS):
                middle = 0.5 * (low + high)
                if middle <= low or middle >= high:
                    break
                state[:] = before
                advance_on(state, inside if within else free, curve, 0.0, 0.0, 0.0, middle, work)
                if (state[POSITION] > 0.0) == within:
                    low = middle
                else:
                    high = middle
            state[:] = before
            advance_on(state, inside if within else free, curve, 0.0, 0.0, 0.0, low, work)
            left -= low
            within = not within
