"""The sampled loop of two masses with a transmission between them, as `kernel` runs that of one mass."""

from __future__ import annotations

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
    sample,
)
from zwidth.loop.plant import DIRECTION, HAND_WORK, POSITION, SOURCE_WORK, VELOCITY
from zwidth.loop.two_bodies import (
    INSIDE_LOSS,
    MOTOR,
    MOTOR_COULOMB,
    MOTOR_VELOCITY,
    MOTOR_VISCOUS,
    TwoMasses,
    packed_two,
)
from zwidth.loop.two_masses import (
    R_INSIDE_LOSS,
    R_MOTOR,
    R_MOTOR_COULOMB,
    R_MOTOR_VELOCITY,
    R_MOTOR_VISCOUS,
    advance_two,
)
from zwidth.native.compiled import Array, compiled


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
    pieces = max(1, (target.shape[0] - 1) // samples)
    regular = pieces == points == 1 and lengths.shape[0] == 1 and arrivals.shape[1] == 0
    for k in range(first, last):
        final = k == samples
        h = 0.0 if final else (lengths[0] if lengths.shape[0] == 1 else lengths[k])
        piece, begun, border = 0, 0.0, h / pieces
        place = state[POSITION] if two.sensed > 0.0 else state[MOTOR]
        reading, command = sample(k, points, place, state, law, memory, missed, commands, record)
        for column in range(k * points, min((k + 1) * points, record.shape[1])):
            record[R_READING, column], record[R_COMMAND, column] = reading, command
        hand = in_interval(k * pieces, h, final, state[POSITION], force, anchor, target, switch)
        now = 0.0
        for point in range(points):
            due = apply_due(state, two.motor, due, k, now, late, offset, arrivals, commands)
            _note(state, k * points + point, record)
            if final:
                return
            end = h if point == points - 1 else h * (point + 1) / points
            while now < end:
                until = min(border, end)
                due = travel_two(
                    state, two, hand, now, until, begun, border, regular,
                    due, k, late, offset, arrivals, commands, work,
                )  # fmt: skip
                now = until
                if now == border and piece + 1 < pieces:
                    piece, begun = piece + 1, border
                    border = h if piece + 1 == pieces else h * (piece + 1) / pieces
                    hand = in_interval(
                        k * pieces + piece, h, final, state[POSITION], force, anchor, target, switch
                    )


@compiled
def travel_two(
    state: Array,
    two: TwoMasses,
    hand: Hand,
    start: float,
    end: float,
    begun: float,
    border: float,
    regular: bool,
    due: int,
    k: int,
    late: int,
    offset: float,
    arrivals: Array,
    commands: Array,
    work: Array,
) -> int:
    """As `kernel.travel`, of both bodies; the hand's path is straight between `begun` and `border`.

    A `regular` sample has the stretches of every other, two at most.
    """
    now = start
    while now < end:
        until = min(arrival(due, k, late, offset, arrivals), end)
        stretch = (0 if now == 0.0 else 1) if regular else -1
        if hand.kinematic:
            if hand.bent and now < offset:
                until = min(until, offset)
            _carry(
                state,
                two,
                on_the_way(hand, offset, until - begun, border - begun),
                until - now,
                stretch,
                work,
            )
        else:
            here = hand.anchor + hand.speed * now
            advance_two(state, two, hand.push, here, hand.speed, until - now, stretch, work)
        now = until
        if now < end:
            due = apply_due(state, two.motor, due, k, now, late, offset, arrivals, commands)
    return due


@compiled
def _carry(state: Array, two: TwoMasses, target: float, h: float, place: int, work: Array) -> None:
    """The handle goes to `target` in h seconds at constant velocity, after an impulse of the hand on it."""
    v0, v1 = state[VELOCITY], (target - state[POSITION]) / h
    impulse = 0.5 * two.handle.mass * (v1 - v0) * (v1 + v0)
    state[HAND_WORK] += impulse
    state[SOURCE_WORK] += impulse
    state[VELOCITY] = v1
    state[DIRECTION] = 1.0 if v1 > 0.0 else (-1.0 if v1 < 0.0 else 0.0)
    advance_two(state, two, 0.0, 0.0, 0.0, h, place, work)
    state[POSITION] = target


@compiled
def _note(state: Array, column: int, record: Array) -> None:
    note(state, column, record)
    record[R_MOTOR, column] = state[MOTOR]
    record[R_MOTOR_VELOCITY, column] = state[MOTOR_VELOCITY]
    record[R_MOTOR_VISCOUS, column] = state[MOTOR_VISCOUS]
    record[R_MOTOR_COULOMB, column] = state[MOTOR_COULOMB]
    record[R_INSIDE_LOSS, column] = state[INSIDE_LOSS]
