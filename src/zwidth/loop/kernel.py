"""The sampled loop: measure, compute, apply after the delay, hold, move.

Sample k is taken at t_k, the beginning of interval k.  Its command is applied
`offset` into the interval `late` samples on and held until the next one is
applied.  Between two changes of force `advance` moves the plant exactly.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from zwidth.loop.law import (
    BILATERAL,
    GATE,
    LIMIT,
    PHASE,
    RESOLUTION,
    STEP,
    limited,
    measured,
    rendered_force,
    rounded,
)
from zwidth.loop.plant import (
    ACTUATOR_WORK,
    COULOMB,
    FORCE,
    GOAL,
    HAND_LOSS,
    HAND_WORK,
    INSIDE,
    POSITION,
    SATURATED,
    SOURCE_WORK,
    STATE_SIZE,
    VELOCITY,
    VISCOUS,
    Plant,
)
from zwidth.loop.step import advance, carry, glide, is_free, response_of
from zwidth.native.compiled import Array, compiled

# The record: one row per quantity, one column per instant.
R_POSITION, R_VELOCITY, R_READING, R_COMMAND, R_ACTUATOR = range(5)
R_HAND_WORK, R_ACTUATOR_WORK, R_VISCOUS, R_COULOMB, R_SOURCE_WORK, R_HAND_LOSS = range(5, 11)
RECORDED = 11

_NEVER = 1e300


@compiled
def packed_plant(p: Array) -> Plant:
    """The plant from the numbers of its array."""
    return Plant(p[0], p[1], p[2], p[3], p[4], p[5], p[6], p[7], p[8])


@compiled
def run(
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
    """Run the intervals `first` … `last` − 1, and sample N when last is N + 1; can be called again.

    Parameters
    ----------
    points
        Instants recorded per interval.
    state, numbers, law, memory, work
        See `plant`, `law` and `series`; state, memory and work are changed.
    late, offset
        d and α T of a delay (d + α) T, when the clock is regular.
    lengths
        Of the intervals [s]: one value when all are the same.
    arrivals
        When the clock is irregular: for every command the interval, and the time
        into it, at which it is applied, 2 × (N + 1); else 2 × 0.
    missed
        1 where a sample is not taken; empty if none is.
    force, anchor, target, switch
        What the hand does, see `operator.Signals`; empty where it does not.
    commands
        The command of every sample, N + 1 of them, filled in.
    record
        RECORDED × (N·points + 1), filled in.
    """
    plant = packed_plant(numbers)
    samples = commands.shape[0] - 1
    due = first_due(first, late, arrivals)
    whole = offset == 0.0 and points == 1 and lengths.shape[0] == 1 and arrivals.shape[1] == 0
    free = whole and is_free(plant) and target.shape[0] == 0
    response = response_of(plant, lengths[0] if free else 0.0)
    for k in range(first, last):
        final = k == samples
        h = 0.0 if final else (lengths[0] if lengths.shape[0] == 1 else lengths[k])
        reading, command = sample(k, points, state[POSITION], state, law, memory, missed, commands, record)
        if free:
            record[R_READING, k], record[R_COMMAND, k] = reading, command
            f = command if late == 0 else (commands[k - late] if k >= late else state[FORCE])
            state[FORCE] = state[GOAL] = f
            note(state, k, record)
            if not final:
                glide(state, plant, response, f, force[k] if force.shape[0] > 0 else 0.0, h, work)
            continue
        for column in range(k * points, min((k + 1) * points, record.shape[1])):
            record[R_READING, column], record[R_COMMAND, column] = reading, command
        hand = in_interval(k, h, final, state[POSITION], force, anchor, target, switch)
        now = 0.0
        for point in range(points):
            due = apply_due(state, plant, due, k, now, late, offset, arrivals, commands)
            note(state, k * points + point, record)
            if final:
                return
            end = h if point == points - 1 else h * (point + 1) / points
            due = travel(state, plant, hand, now, end, h, due, k, late, offset, arrivals, commands, work)
            now = end


class Hand(NamedTuple):
    """What the hand does in one interval: see `operator.Signals`."""

    push: float
    anchor: float
    speed: float
    begin: float
    middle: float
    goal: float
    kinematic: bool
    bent: bool


@compiled
def in_interval(
    k: int,
    h: float,
    final: bool,
    position: float,
    force: Array,
    anchor: Array,
    target: Array,
    switch: Array,
) -> Hand:
    """The hand in interval k, which begins at `position`."""
    kinematic, bent = target.shape[0] > 0, switch.shape[0] > 0
    push = force[k] if force.shape[0] > 0 and not final else 0.0
    here = anchor[k] if anchor.shape[0] > 0 else 0.0
    speed = (anchor[k + 1] - here) / h if anchor.shape[0] > 0 and not final else 0.0
    goal = target[k + 1] if kinematic and not final else position
    middle = switch[k] if bent and not final else position
    return Hand(push, here, speed, position, middle, goal, kinematic, bent)


@compiled
def travel(
    state: Array,
    plant: Plant,
    hand: Hand,
    start: float,
    end: float,
    h: float,
    due: int,
    k: int,
    late: int,
    offset: float,
    arrivals: Array,
    commands: Array,
    work: Array,
) -> int:
    """Move from `start` to `end` of interval k, applying commands on the way; returns the next one due."""
    now = start
    while now < end:
        until = min(arrival(due, k, late, offset, arrivals), end)
        if hand.kinematic:
            if hand.bent and now < offset:
                until = min(until, offset)
            carry(state, plant, on_the_way(hand, offset, until, h), until - now)
        else:
            advance(state, plant, hand.push, hand.anchor + hand.speed * now, hand.speed, until - now, work)
        now = until
        if now < end:
            due = apply_due(state, plant, due, k, now, late, offset, arrivals, commands)
    return due


@compiled
def apply_due(
    state: Array,
    plant: Plant,
    due: int,
    k: int,
    now: float,
    late: int,
    offset: float,
    arrivals: Array,
    commands: Array,
) -> int:
    """Apply the commands whose time has come in interval k; returns the next one due."""
    while arrival(due, k, late, offset, arrivals) <= now:
        state[GOAL] = commands[due]
        if plant.lag == 0.0 and plant.slew == 0.0:
            state[FORCE] = commands[due]
        due += 1
    return due


@compiled
def sample(
    k: int,
    points: int,
    position: float,
    state: Array,
    law: Array,
    memory: Array,
    missed: Array,
    commands: Array,
    record: Array,
) -> tuple[float, float]:
    """Measure and compute: (reading, command).  A missed sample leaves law and command as they were."""
    if missed.shape[0] > 0 and missed[k] > 0.0:
        reading = record[R_READING, (k - 1) * points] if k > 0 else 0.0
        command = commands[k - 1] if k > 0 else 0.0
    else:
        reading = measured(position, law[RESOLUTION], law[PHASE])
        command = commanded(state, law, memory, reading)
    commands[k] = command
    return reading, command


@compiled
def commanded(state: Array, law: Array, memory: Array, reading: float) -> float:
    """What the law and the converter make of a reading; counts samples inside and saturated."""
    wish = rendered_force(law, memory, reading)
    if law[GATE] == BILATERAL or reading > 0.0:
        state[INSIDE] += 1.0
    f = rounded(wish, law[STEP])
    if law[LIMIT] > 0.0 and abs(f) > law[LIMIT]:
        state[SATURATED] += 1.0
    return limited(law, memory, f)


@compiled
def first_due(first: int, late: int, arrivals: Array) -> int:
    """The first command that is applied in interval `first` or later."""
    if arrivals.shape[1] == 0:
        return max(0, first - late)
    due = 0
    while due < arrivals.shape[1] and arrivals[0, due] < first:
        due += 1
    return due


@compiled
def arrival(due: int, k: int, late: int, offset: float, arrivals: Array) -> float:
    """When, in interval k, the command `due` is applied [s]; never, if not in this one."""
    if arrivals.shape[1] == 0:
        return offset if due + late == k else _NEVER
    return arrivals[1, due] if due < arrivals.shape[1] and arrivals[0, due] == k else _NEVER


@compiled
def on_the_way(hand: Hand, offset: float, until: float, h: float) -> float:
    """The prescribed position at the time `until` of an interval."""
    if until == h:
        return hand.goal
    if not hand.bent:
        return hand.begin + (hand.goal - hand.begin) * (until / h)
    if until <= offset:
        return hand.begin + (hand.middle - hand.begin) * (until / offset)
    return hand.middle + (hand.goal - hand.middle) * ((until - offset) / (h - offset))


@compiled
def note(state: Array, column: int, record: Array) -> None:
    """Write the state at one instant."""
    record[R_POSITION, column] = state[POSITION]
    record[R_VELOCITY, column] = state[VELOCITY]
    record[R_ACTUATOR, column] = state[FORCE]
    record[R_HAND_WORK, column] = state[HAND_WORK]
    record[R_ACTUATOR_WORK, column] = state[ACTUATOR_WORK]
    record[R_VISCOUS, column] = state[VISCOUS]
    record[R_COULOMB, column] = state[COULOMB]
    record[R_SOURCE_WORK, column] = state[SOURCE_WORK]
    record[R_HAND_LOSS, column] = state[HAND_LOSS]


# What a law remembers after each reading that may come next.  A row holds the memory of the law and, behind
# it, the forces of the last readings, the one that acts in this interval first, that of the last reading
# last: as many as a delay keeps waiting, and one.


@compiled
def after_reading(law: Array, row: Array, waiting: int, count: int, state: Array) -> None:
    """Take one reading, in counts; the row moves on; state is scratch."""
    size = row.size - waiting
    force = commanded(state, law, row[:size], law[RESOLUTION] * count)
    for i in range(size, row.size - 1):
        row[i] = row[i + 1]
    row[row.size - 1] = force


@compiled
def after_every_reading(
    law: Array, rows: Array, counts: Array, waiting: int, lowest: int, highest: int, state: Array, out: Array
) -> None:
    """Fill in out, (rows, counts within reach, row): each row after each reading on the board.

    The middle of the second axis is the same reading once more; a reading off the board leaves
    what was there.
    """
    reach = out.shape[1] // 2
    for i in range(rows.shape[0]):
        for move in range(-reach, reach + 1):
            count = int(counts[i]) + move
            if lowest <= count <= highest:
                here = out[i, move + reach, :]
                for j in range(here.size):
                    here[j] = rows[i, j]
                after_reading(law, here, waiting, count, state)


def scratch() -> Array:
    """For `state`."""
    return np.zeros(STATE_SIZE)
