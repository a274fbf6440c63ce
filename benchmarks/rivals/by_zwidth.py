"""zwidth: `by_zwidth.py call`, `kernel` or `batch THREADS`.

`call` is `zw.simulate` with its checks, trajectory, energies and dataset; `kernel` the
compiled loop inside it, which records the same.  `batch` is `zw.simulation.simulate_batch`; the loops start
at different places, the first where the task does, and keep their end and their energies, no trajectory.
"""

from __future__ import annotations

import sys

import numpy as np
from task import (
    COMPARED,
    COULOMB,
    DAMPING,
    MASS,
    PERIOD,
    RESOLUTION,
    START,
    STIFFNESS,
    hand_forces,
    report,
)

import zwidth as zw
from zwidth.loop.batch import BLOCK
from zwidth.loop.kernel import R_POSITION
from zwidth.loop.setup import Setup, empty_record, prepare
from zwidth.loop.simulate import run_setup

SAMPLES = 100_000
BATCH_LOOPS = 2 * BLOCK
DEVICE = zw.Device(
    mass=MASS, damping=DAMPING, coulomb_friction=COULOMB, resolution=RESOLUTION, sample_period=PERIOD
)
WALL = zw.Wall(stiffness=STIFFNESS)
HAND = np.array(hand_forces(SAMPLES))
STARTS = [START - 1e-5 * i for i in range(BATCH_LOOPS)]


def push(samples: int) -> zw.operators.RecordedForce:
    """The hand."""
    return zw.operators.RecordedForce(HAND[:samples])


def laid_out(samples: int, start: float = START) -> Setup:
    """The loop, checked and in arrays."""
    return prepare(DEVICE, WALL, push(samples), samples * PERIOD, initial_position=start)


def call() -> None:
    """The whole of `zw.simulate`."""

    def simulate(samples: int) -> list[float]:
        trace = zw.simulate(DEVICE, WALL, push(samples), samples * PERIOD, initial_position=START)
        return trace.position.values

    report(simulate, SAMPLES)


def kernel() -> None:
    """The compiled loop."""
    setup = laid_out(SAMPLES)
    commands, record, work = empty_record(setup.frame)

    def simulate(_samples: int) -> list[float]:
        run_setup(setup, setup.state.copy(), setup.memory.copy(), work, commands, record, None)
        return record[R_POSITION]

    report(simulate, SAMPLES)


def batch(threads: int) -> None:
    """The whole of `zw.simulation.simulate_batch`."""

    def ends(samples: int, starts: list[float]) -> list[float]:
        vary = {"initial_position": starts}
        many = zw.simulation.simulate_batch(
            DEVICE, WALL, push(samples), samples * PERIOD, vary=vary, workers=threads
        )
        return many.position.values

    positions = [START, *(ends(k, STARTS[:1])[0] for k in range(1, COMPARED + 1))]
    report(lambda samples: ends(samples, STARTS), SAMPLES, BATCH_LOOPS, positions)


if __name__ == "__main__":
    {"call": call, "kernel": kernel, "batch": batch}[sys.argv[1]](*map(int, sys.argv[2:]))
