"""Two devices and a link between their ports: both read, send, hear, compute and move, sample by sample."""

from __future__ import annotations

from typing import NamedTuple

from zwidth.links import laws
from zwidth.links.wire import Wire, deliver, post
from zwidth.loop.kernel import R_COMMAND, R_READING, first_due
from zwidth.loop.pair.kernel import Arm, read, through
from zwidth.native.compiled import Array, compiled


class End(NamedTuple):
    """One port: its law, what that knows, and the wire on which it hears."""

    code: float
    numbers: Array
    state: Array
    hears: Wire


@compiled
def run_link(
    start: int,
    stop: int,
    points: int,
    h: float,
    leader: Arm,
    near: End,
    follower: Arm,
    far: End,
    work: Array,
) -> None:
    """Run the samples `start` … `stop` − 1; can be called again."""
    nothing = work[:0].reshape((2, 0))
    due, its_due = first_due(start, leader.late, nothing), first_due(start, follower.late, nothing)
    final = leader.commands.shape[0] - 1
    for k in range(start, stop):
        say(leader, near, far.hears, k)
        say(follower, far, near.hears, k)
        command(leader, near, k, points)
        command(follower, far, k, points)
        due = through(leader, due, k, points, h, k == final, work)
        its_due = through(follower, its_due, k, points, h, k == final, work)


@compiled
def say(arm: Arm, end: End, wire: Wire, k: int) -> None:
    """Read the arm, and send what the period that has ended makes of it."""
    read(arm, k)
    if k > 0:
        laws.send(end.code, end.numbers, end.state, arm.readings[k] - arm.readings[k - 1])
        post(wire, end.state)


@compiled
def command(arm: Arm, end: End, k: int, points: int) -> None:
    """Hear what has arrived, and ask the actuator for the port's force, which is positive along x."""
    deliver(end.hears, k, end.state)
    f = -laws.force(end.code, end.numbers, end.state)
    arm.commands[k] = f
    for column in range(k * points, min((k + 1) * points, arm.record.shape[1])):
        arm.record[R_READING, column] = arm.readings[k]
        arm.record[R_COMMAND, column] = f
