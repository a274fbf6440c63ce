"""The sampled loop without its record: only the final state and the extremes are kept.

The same steps as `kernel.run`; what a graphics card runs, one loop per thread.
"""

from __future__ import annotations

from zwidth.compiled import Array, compiled
from zwidth.loop.kernel import apply_due, commanded, in_interval, packed_plant, travel
from zwidth.loop.law import PHASE, RESOLUTION, measured
from zwidth.loop.plant import FORCE, HAND_WORK, POSITION
from zwidth.loop.summary import DEEPEST, EXTRACTED, HIGHEST, LOWEST, PEAK


@compiled
def run_unrecorded(
    samples: int,
    state: Array,
    numbers: Array,
    law: Array,
    memory: Array,
    work: Array,
    late: int,
    offset: float,
    period: float,
    force: Array,
    anchor: Array,
    target: Array,
    switch: Array,
    regular: Array,
    commands: Array,
    summary: Array,
) -> None:
    """Run one loop with a regular clock; arguments as of `kernel.run`, `regular` being its empty arrivals."""
    plant = packed_plant(numbers)
    summary[DEEPEST] = summary[EXTRACTED] = summary[HIGHEST] = -1e300
    summary[PEAK], summary[LOWEST] = 0.0, 1e300
    quarter = samples - samples // 4
    due = 0
    for k in range(samples + 1):
        final = k == samples
        h = 0.0 if final else period
        reading = measured(state[POSITION], law[RESOLUTION], law[PHASE])
        commands[k] = commanded(state, law, memory, reading)
        hand = in_interval(k, h, final, state[POSITION], force, anchor, target, switch)
        due = apply_due(state, plant, due, k, 0.0, late, offset, regular, commands)
        x = state[POSITION]
        summary[DEEPEST] = max(summary[DEEPEST], x)
        summary[PEAK] = max(summary[PEAK], abs(state[FORCE]))
        summary[EXTRACTED] = max(summary[EXTRACTED], -state[HAND_WORK])
        if k >= quarter:
            summary[HIGHEST] = max(summary[HIGHEST], x)
            summary[LOWEST] = min(summary[LOWEST], x)
        if final:
            return
        due = travel(state, plant, hand, 0.0, h, h, due, k, late, offset, regular, commands, work)
