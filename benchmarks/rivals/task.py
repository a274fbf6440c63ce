"""The one loop that every simulator of the benchmark simulates, and how it is timed.

The wall of Abbott & Okamura (2005), section V: x > 0 inside it,

    m v̇ = F − K x_m − b v − f_c sgn v,   x_m = Δ ⌊x/Δ⌋, no wall force where x_m ≤ 0

sampled at kT and held, without delay.  The hand pushes with 1 N + 0.5 N sin 2π 5 t, sampled
and held as well.  The start is at rest, 10 mm outside.
"""

from __future__ import annotations

import json
import math
import time
from collections.abc import Callable, Sequence
from statistics import median

MASS = 0.036
"""m [kg]"""
DAMPING = 0.15
"""b [N·s/m]"""
COULOMB = 0.12
"""f_c [N]"""
STIFFNESS = 300.0
"""K [N/m]"""
RESOLUTION = 22.4e-6
"""Δ [m]"""
PERIOD = 1e-3
"""T [s]"""
START = -0.01
"""Position at rest at t = 0 [m]"""
COMPARED = 2000
"""The position is compared with the reference at the samples 0 … COMPARED."""
REPEATS = 5


def hand_force(k: int) -> float:
    """The force of the hand from kT to (k + 1)T [N]."""
    return 1.0 + 0.5 * math.sin(2 * math.pi * 5 * (k * PERIOD))


def hand_forces(samples: int) -> list[float]:
    """The force of the hand in each of the first sample intervals [N]."""
    return [hand_force(k) for k in range(samples)]


def wall_force(position: float) -> float:
    """The force of the wall, out of it, computed from the sampled position [N]."""
    measured = RESOLUTION * math.floor(position / RESOLUTION)
    return STIFFNESS * measured if measured > 0 else 0.0


def report(
    simulate: Callable[[int], Sequence[float]],
    samples: int,
    loops: int = 1,
    positions: Sequence[float] | None = None,
) -> None:
    """Run `simulate(number of samples)` warm, several times, and print time and positions as JSON.

    `simulate` returns the positions at the sample instants from t = 0 on [m], unless they
    are given.  One run may be that of several `loops`.
    """
    found = simulate(max(samples, COMPARED))
    compared = found if positions is None else positions
    seconds = []
    for _ in range(REPEATS):
        start = time.perf_counter()
        simulate(samples)
        seconds.append(time.perf_counter() - start)
    ns = 1e9 * median(seconds) / (samples * loops)
    print(json.dumps({"ns": ns, "positions": [float(x) for x in compared[: COMPARED + 1]]}))
