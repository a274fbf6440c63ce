"""zwidth: `by_zwidth.py call`, `kernel`, `batch THREADS` or `lanes THREADS`.

`call` is `zw.simulate` with its checks, trajectory, energies and dataset; `kernel` the
compiled loop inside it, which records the same.  `batch` is `zw.simulation.simulate_batch`, `lanes`
the compiled loops inside it; the loops start at different places, the first where
the task does, and keep their end and their energies, no trajectory.
"""

from __future__ import annotations

import sys
from concurrent.futures import ThreadPoolExecutor

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
from zwidth.loop.batch import aligned
from zwidth.loop.kernel import R_POSITION
from zwidth.loop.plant import POSITION
from zwidth.loop.setup import Setup, empty_record, prepare
from zwidth.loop.side_by_side import BUFFER, LANES, run_side_by_side
from zwidth.loop.simulate import run_setup
from zwidth.loop.summary import SUMMARY

SAMPLES = 100_000
BATCH_LOOPS = 2 * LANES
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
    commands, record, work = empty_record(setup)

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


def lanes(threads: int) -> None:
    """The compiled loops side by side, one block of them on each thread."""
    first = [laid_out(SAMPLES, start) for start in STARTS[:LANES]]
    numbers, laws = np.array([s.plant_numbers for s in first]), np.array([s.law for s in first])
    states, periods = np.array([s.state for s in first]), np.full(LANES, PERIOD)
    force = np.repeat(HAND[:, None], LANES, axis=1)

    def block(samples: int) -> float:
        state, kept = states.copy(), np.zeros((LANES, SUMMARY))
        buffer, queue = aligned(BUFFER), aligned(LANES)
        run_side_by_side(state, numbers, laws, periods, 0, force[:samples], samples, buffer, queue, kept)
        return float(state[0, POSITION])

    def simulate(samples: int) -> list[float]:
        return list(pool.map(block, [samples] * threads))

    with ThreadPoolExecutor(threads) as pool:
        positions = [START, *(block(k) for k in range(1, COMPARED + 1))]
        report(simulate, SAMPLES, LANES * threads, positions)


if __name__ == "__main__":
    {"call": call, "kernel": kernel, "batch": batch, "lanes": lanes}[sys.argv[1]](*map(int, sys.argv[2:]))
