"""What is kept of a loop whose trace is not: extremes at the samples.

deepest    max x                         peak    max |f_a|
extracted  max(−W_h), what the hand has got out at most
highest, lowest   of x over the last quarter of the samples: does it still move?
"""

from __future__ import annotations

from zwidth.loop.kernel import R_ACTUATOR, R_HAND_WORK, R_POSITION, run
from zwidth.loop.plain import run_plain
from zwidth.native.compiled import Array, compiled

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
                0,
                samples + 1,
                states[i, :],
                numbers[i, :],
                laws[i, :],
                late,
                lengths[0],
                force,
                commands,
                record,
            )
        else:
            run(
                0, samples + 1, points, states[i, :], numbers[i, :], laws[i, :], memories[i, :], work,
                late, offset, lengths, arrivals, missed, force, anchor, target, switch, commands, record,
            )  # fmt: skip
        summarize(record, samples, points, summaries[i, :])
