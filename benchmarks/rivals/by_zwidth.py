"""zwidth: `by_zwidth.py call`, `kernel`, or `batch THREADS`.

`call` is `zw.simulate` with checks, trajectory, energies and dataset; `kernel` the
compiled loop inside it, which records the same; `batch` many loops side by side.
"""

from __future__ import annotations

import sys

from task import (
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

SAMPLES = 100_000
DEVICE = zw.Device(
    mass=MASS, damping=DAMPING, coulomb_friction=COULOMB, resolution=RESOLUTION, sample_period=PERIOD
)
WALL = zw.Wall(stiffness=STIFFNESS)
HAND = hand_forces(SAMPLES)


def whole_call(samples: int) -> list[float]:
    """The positions from `zw.simulate`."""
    hand = zw.operators.RecordedForce(HAND[:samples])
    trace = zw.simulate(DEVICE, WALL, operator=hand, duration=samples * PERIOD, initial_position=START)
    return trace["position"].values


def kernel(samples: int) -> None:
    """Time the compiled loop; what it needs is laid out before."""
    from zwidth.loop.kernel import R_POSITION
    from zwidth.loop.setup import empty_record, prepare
    from zwidth.loop.simulate import run_setup

    hand = zw.operators.RecordedForce(HAND[:samples])
    setup = prepare(DEVICE, WALL, hand, samples * PERIOD, initial_position=START)
    commands, record, work = empty_record(setup)

    def simulate(_samples: int) -> list[float]:
        run_setup(setup, setup.state.copy(), setup.memory.copy(), work, commands, record, None)
        return record[R_POSITION]

    report(simulate, samples)


def batch(threads: int) -> None:
    """Time many loops side by side."""
    sys.exit("zwidth has no batch yet")


if __name__ == "__main__":
    if sys.argv[1] == "call":
        report(whole_call, SAMPLES)
    elif sys.argv[1] == "kernel":
        kernel(SAMPLES)
    else:
        batch(int(sys.argv[2]))
