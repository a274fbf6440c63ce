"""Whole runs beside that of the kernel: the plain loop, loops without a trace, rounds of a given motion.

The plain loop has a free mass, a spring wall, a regular clock, one force per interval, and the motion of
`kernel.run` to the last bit.  An interval without a stop or a start in it is one line of multiplications
with the responses of that interval, computed once; the others go through `stop_or_start`.  The time per
sample is that of the chain position → count → force → position, so that whatever else enters the next
position is added up before the force.
"""

from __future__ import annotations

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
    commanded,
    packed_plant,
    run,
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
    Free,
    free_response,
    stop_or_start,
)
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
            free = stop_or_start(free, f, push, drag, coulomb, stiction, inverse, half_hand, h)
            x, v, side, hand, actuator, viscous, dry, source = free
    state[POSITION], state[VELOCITY], state[DIRECTION] = x, v, side
    state[FORCE], state[GOAL] = f, f
    state[HAND_WORK], state[ACTUATOR_WORK] = hand, actuator
    state[VISCOUS], state[COULOMB], state[SOURCE_WORK] = viscous, dry, source


# What is kept of a loop whose trace is not: extremes at the samples.
#
# deepest    max x                         peak    max |f_a|
# extracted  max(−W_h), what the hand has got out at most
# highest, lowest   of x over the last quarter of the samples: does it still move?


DEEPEST, PEAK, EXTRACTED, HIGHEST, LOWEST = range(5)
SUMMARY = 5


@compiled
def summarize(record: Array, samples: int, points: int, summary: Array) -> None:
    """Fill in the summary of one record."""
    summary[DEEPEST] = summary[EXTRACTED] = summary[HIGHEST] = -1e300
    summary[PEAK], summary[LOWEST] = 0.0, 1e300
    quarter = samples - samples // 4
    for k in range(samples + 1):
        column = k * points
        x = record[R_POSITION, column]
        summary[DEEPEST] = max(summary[DEEPEST], x)
        summary[PEAK] = max(summary[PEAK], abs(record[R_ACTUATOR, column]))
        summary[EXTRACTED] = max(summary[EXTRACTED], -record[R_HAND_WORK, column])
        if k >= quarter:
            summary[HIGHEST] = max(summary[HIGHEST], x)
            summary[LOWEST] = min(summary[LOWEST], x)


@compiled
def run_each(
    plain: bool,
    points: int,
    states: Array,
    numbers: Array,
    laws: Array,
    memories: Array,
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
    summaries: Array,
) -> None:
    """`kernel.run` of loops with the same clock and the same hand, a row of each array for each loop.

    Of those that are all `plain` the quicker `run_plain`.
    """
    samples = commands.shape[0] - 1
    for i in range(states.shape[0]):
        if plain:
            run_plain(
                0, samples + 1, states[i, :], numbers[i, :], laws[i, :], late, lengths[0],
                force, commands, record,
            )  # fmt: skip
        else:
            run(
                0, samples + 1, points, states[i, :], numbers[i, :], laws[i, :], memories[i, :], work,
                late, offset, lengths, arrivals, missed, force, anchor, target, switch, commands, record,
            )  # fmt: skip
        summarize(record, samples, points, summaries[i, :])


# A motion that is prescribed and repeated: what each round takes out, and nothing else.  The same forces as
# `kernel.run`, for a regular clock and an amplifier that gives its force at once.
#
#     −∫ f dx − f_c Σ|Δx| − (b/T) Σ Δx²
#
# Once the law has begun two rounds in the same state to the bit, all that follow are the same and
# counted, not run.  So are those of a hand that has lost the same to the bit in very many rounds: the law
# only adds to its account what the hand loses.


LOSING = 40
"""Rounds with the same loss after which a hand goes on losing."""


@compiled
def run_rounds(
    positions: Array,
    law: Array,
    memory: Array,
    before: Array,
    state: Array,
    waiting: Array,
    late: int,
    share: float,
    coulomb: float,
    drag: float,
    taken: Array,
) -> float:
    """Fill in what is taken out in all after each round [J]; returns what friction takes in them all.

    Parameters
    ----------
    positions
        One round; its end leads to its beginning.
    law, memory, state
        See `law` and `plant`; memory is that of a hand at rest at the first position, state is scratch.
    before
        Scratch, as long as the memory.
    waiting
        Scratch for the commands that wait, late + 2 of them, zeros.
    late, share
        d and α of a delay (d + α) T.
    coulomb, drag
        f_c, and b/T.
    taken
        One for each round.
    """
    samples, kept, rounds = positions.shape[0], waiting.shape[0], taken.shape[0]
    needed = 1 + (late + 1 + samples - 1) // samples  # rounds until no command of another one is waiting
    total, paid, same, losing, last, k = 0.0, 0.0, 0, 0, 0.0, 0
    for r in range(rounds):
        for i in range(memory.shape[0]):
            before[i] = memory[i]
        gain, lost = 0.0, 0.0
        for i in range(samples):
            x = positions[i]
            moved = (positions[i + 1] if i + 1 < samples else positions[0]) - x
            waiting[k % kept] = commanded(state, law, memory, measured(x, law[RESOLUTION], law[PHASE]))
            force = waiting[(k + kept - late) % kept]
            if share > 0.0:
                force += share * (waiting[(k + kept - late - 1) % kept] - force)
            friction = coulomb * abs(moved) + drag * moved * moved
            gain -= force * moved + friction
            lost += friction
            k += 1
        total += gain
        paid += lost
        taken[r] = total
        same = same + 1 if unchanged(memory, before) else 0
        losing = losing + 1 if gain < 0.0 and gain == last else 0
        last = gain
        if same > needed or losing > LOSING:
            for later in range(r + 1, rounds):
                total += gain
                taken[later] = total
            return paid + (rounds - 1 - r) * lost
    return paid


@compiled
def unchanged(memory: Array, before: Array) -> bool:
    """True if every number is the same."""
    same = True
    for i in range(memory.shape[0]):
        same = same and memory[i] == before[i]
    return same
