"""A sampled loop whose law runs elsewhere, such as on an emulated chip: given counts it answers with forces.

Plant, hand and energies are those of `zwidth.simulate`: between two changes of force the motion is exact.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import floor

import numpy as np
from numpy.typing import NDArray

from zwidth.loop import kernel
from zwidth.loop.law import LIMIT, STEP, rounded
from zwidth.loop.plant import FAULT, POSITION
from zwidth.loop.setup import empty_record, prepare
from zwidth.model.device.device import Device
from zwidth.model.environment.wall import Wall
from zwidth.model.operator.operator import Operator

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Motion:
    """What became of it, a number for each sample.

    `counts` is what the encoder read; `position` [m, rad], `velocity`, `command` and `force` of the actuator
    [N, N·m] and the work of the hand so far [J] are those of the plant.
    """

    counts: NDArray[np.int32]
    position: Array
    velocity: Array
    command: Array
    force: Array
    hand_work: Array

    @property
    def extracted(self) -> float:
        """The most energy that the hand has got out at any sample [J], ≥ 0."""
        return max(0.0, -float(self.hand_work.min()))


def closed(
    device: Device,
    operator: Operator,
    duration: float,
    force: Callable[[int], float],
    init: Callable[[int], None] | None = None,
) -> Motion:
    """A touch of `duration` seconds, sample by sample.

    `force` is from counts to the force of the law [N, N·m], > 0 where it pushes out; `init` is told the first
    counts before the first sample.
    """
    # of the wall only that it begins at 0 is used
    setup = prepare(device, Wall(stiffness=1), operator, duration)
    frame, state, plant = setup.frame, setup.state, setup.frame.plant
    commands, record, work = empty_record(setup.frame)
    signals, h, limit = setup.frame.optional(), float(frame.period), setup.law[LIMIT]
    counts = np.zeros(frame.samples + 1, np.int32)
    due = 0
    for k in range(frame.samples + 1):
        final = k == frame.samples
        counts[k] = floor(state[POSITION] / frame.resolution)
        if k == 0 and init is not None:
            init(int(counts[0]))
        wanted = rounded(force(int(counts[k])), setup.law[STEP])
        commands[k] = min(max(wanted, -limit), limit) if limit > 0 else wanted
        hand = kernel.in_interval(k, h, final, state[POSITION], *signals)
        due = kernel.apply_due(state, plant, due, k, 0.0, frame.late, frame.offset, frame.arrivals, commands)
        kernel.note(state, k, record)
        if not final:
            late = (due, k, frame.late, frame.offset, frame.arrivals)
            due = kernel.travel(state, plant, hand, 0.0, h, h, *late, commands, work)
    assert state[FAULT] == 0, "too many events in one interval"
    record[kernel.R_COMMAND] = commands
    rows = (kernel.R_POSITION, kernel.R_VELOCITY, kernel.R_COMMAND, kernel.R_ACTUATOR, kernel.R_HAND_WORK)
    return Motion(counts, *(record[row] for row in rows))
