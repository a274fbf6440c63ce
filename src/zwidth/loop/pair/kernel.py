"""The sampled pair: both arms measure, send, hear, compute, apply after their delays, and move.

A tick is the time between two readings of an arm's own; every `often` ticks, which is T, both send what they
read and hear what has arrived.  Between two changes of force each arm moves alone, exactly, as `loop.kernel`
has it.
"""

from __future__ import annotations

from typing import NamedTuple

from zwidth.loop.carry import carry
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
from zwidth.loop.pair.contact import advance_against
from zwidth.loop.pair.curve import advance_on, line_of, on_line
from zwidth.loop.plant import POSITION, SATURATED, Plant
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
