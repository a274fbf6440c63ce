"""The plain loop, quickly: free mass, spring wall, regular clock, one force per interval.

The same motion as `kernel.run`, to the last bit.  An interval without a stop or
a start in it is one line of multiplications with the responses of that interval, computed
once; the others go through `turn`.

The time per sample is that of the chain position → count → force → position, so
that whatever else enters the next position is added up before the force.
"""

from __future__ import annotations

from zwidth.loop.free import free_response
from zwidth.loop.kernel import (
    R_ACTUATOR,
    R_ACTUATOR_WORK,
    R_COMMAND,
    R_COULOMB,
    R_HAND_LOSS,
    R_HAND_WORK,
    R_POSITION,
    R_READING,
    R_SOURCE_WORK,
    R_VELOCITY,
    R_VISCOUS,
    packed_plant,
)
from zwidth.loop.law import BILATERAL, GATE, HEADER, LIMIT, PHASE, RESOLUTION, STEP, measured, rounded
from zwidth.loop.plant import (
    ACTUATOR_WORK,
    COULOMB,
    DIRECTION,
    FORCE,
    GOAL,
    HAND_WORK,
    INSIDE,
    POSITION,
    SATURATED,
    SOURCE_WORK,
    STOPS,
    VELOCITY,
    VISCOUS,
)
from zwidth.loop.turn import Free, turn
from zwidth.native.compiled import Array, compiled


@compiled
def run_plain(
    first: int,
    last: int,
    state: Array,
    numbers: Array,
    law: Array,
    late: int,
    h: float,
    force: Array,
    commands: Array,
    record: Array,
) -> None:
    """Run as `kernel.run` does, for a `Setup` that is `plain`."""
    plant = packed_plant(numbers)
    inverse = 1.0 / (plant.mass + plant.hand_mass)
    drag, coulomb, stiction = plant.damping, plant.coulomb, plant.stiction
    half_hand = 0.5 * plant.hand_mass
    h1, h2, h3 = free_response(drag * inverse, h)
    g1, g2 = inverse * h1, inverse * h2
    limit = law[LIMIT]
    if limit == 0.0:
        limit = 1e300
    one_sided, gain = law[GATE] != BILATERAL, law[HEADER + 1]
    count, phase, step = law[RESOLUTION], law[PHASE], law[STEP]
    samples = commands.shape[0] - 1
    x, v, side, f = state[POSITION], state[VELOCITY], state[DIRECTION], state[FORCE]
    hand, actuator = state[HAND_WORK], state[ACTUATOR_WORK]
    viscous, dry, source = state[VISCOUS], state[COULOMB], state[SOURCE_WORK]
    for k in range(first, last):
        reading = measured(x, count, phase)
        command = 0.0
        if reading > 0.0 or not one_sided:
            command = gain * reading
            state[INSIDE] += 1.0
        command = rounded(command, step)
        if abs(command) > limit:  # a branch, not a min and a max in the chain
            command = limit if command > 0.0 else -limit
            state[SATURATED] += 1.0
        commands[k] = command
        if late == 0:
            f = command
        elif k >= late:
            f = commands[k - late]
        record[R_POSITION, k] = x
        record[R_VELOCITY, k] = v
        record[R_READING, k] = reading
        record[R_COMMAND, k] = command
        record[R_ACTUATOR, k] = f
        record[R_HAND_WORK, k] = hand
        record[R_ACTUATOR_WORK, k] = actuator
        record[R_VISCOUS, k] = viscous
        record[R_COULOMB, k] = dry
        record[R_SOURCE_WORK, k] = source
        record[R_HAND_LOSS, k] = 0.0
        if k == samples:
            break
        push = force[k] if force.shape[0] > 0 else 0.0
        if side == 0.0 and abs(push - f) <= stiction:
            continue
        base = (push - side * coulomb - drag * v) * inverse
        v1 = (v + base * h1) - f * g1
        if v1 * side > 0.0:
            ahead = v * h + base * h2
            moved = ahead - f * g2
            a0 = base - f * inverse
            viscous += drag * (v * v * h + 2.0 * v * a0 * h2 + a0 * a0 * h3)
            dry += coulomb * abs(moved)
            actuator -= f * moved
            source += push * moved
            hand += push * moved - half_hand * (v1 - v) * (v1 + v)
            x = (x + ahead) - f * g2
            v = v1
        else:
            state[STOPS] += abs(side)
            free = Free(x, v, side, hand, actuator, viscous, dry, source)
            free = turn(free, f, push, drag, coulomb, stiction, inverse, half_hand, h)
            x, v, side, hand, actuator, viscous, dry, source = free
    state[POSITION], state[VELOCITY], state[DIRECTION] = x, v, side
    state[FORCE], state[GOAL] = f, f
    state[HAND_WORK], state[ACTUATOR_WORK] = hand, actuator
    state[VISCOUS], state[COULOMB], state[SOURCE_WORK] = viscous, dry, source
