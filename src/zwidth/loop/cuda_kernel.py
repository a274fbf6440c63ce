"""The kernel of the graphics card: thread `case` runs loop number `case`."""

from __future__ import annotations

from numba import cuda

from zwidth.compiled import Array
from zwidth.loop.unrecorded import run_unrecorded


@cuda.jit  # type: ignore[untyped-decorator]
def kernel(
    samples: int,
    states: Array,
    numbers: Array,
    laws: Array,
    memories: Array,
    work: Array,
    clocks: Array,
    which: Array,
    forces: Array,
    anchors: Array,
    targets: Array,
    switches: Array,
    regular: Array,
    commands: Array,
    summaries: Array,
) -> None:
    """Arguments as `gpu.packed` lays them out: a row per loop, or per signal that loops share."""
    case = cuda.grid(1)  # type: ignore[attr-defined]
    if case < states.shape[0]:
        run_unrecorded(
            samples,
            states[case],
            numbers[case],
            laws[case],
            memories[case],
            work[case],
            int(clocks[case, 0]),
            clocks[case, 1],
            clocks[case, 2],
            forces[int(which[0, case])],
            anchors[int(which[1, case])],
            targets[int(which[2, case])],
            switches[int(which[3, case])],
            regular,
            commands[case],
            summaries[case],
        )
