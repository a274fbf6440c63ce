"""Laws written by hand, as a measure for what is emitted: a wall of 300 N/m and 0.05 N·s/m at 1 kHz."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

HERE = Path(__file__).parent
RESOLUTION, PERIOD, UNIT = 2.24e-5, 1e-3, 2.0**-20
"""Of the walls [m], [s], and of the force of `fixed16` [N]."""

NAMES = ("naive_float", "naive_double", "naive_q16", "fixed16")


def text(name: str) -> str:
    return (HERE / f"{name}.h").read_text(encoding="utf-8")


def fixed_forces(counts: NDArray[np.int32], start: int = 0) -> list[int]:
    """What `fixed16` answers, in whole numbers of any size."""
    gain, back = (round(k * RESOLUTION / UNIT) for k in (300 + 0.05 / PERIOD, 0.05 / PERIOD))
    found, before = [], min(max(start, -32767), 32767)
    for count in counts:
        now = min(max(int(count), -32767), 32767)
        found.append(min(max(gain * now - back * before, -17301504), 17301504) if now > 0 else 0)
        before = now
    return found


def float_forces(counts: NDArray[np.int32], real: type[np.floating], start: int = 0) -> NDArray[np.floating]:
    """What the naive laws in floats answer, every operation rounded to `real`."""
    x = np.append(np.int32(start), counts).astype(real) * real(RESOLUTION)
    v = np.diff(x) / real(PERIOD)
    f = real(300) * x[1:] + real(0.05) * v
    return np.where(x[1:] <= 0, real(0), np.clip(f, real(-16.5), real(16.5)))


def touch(samples: int, most: int = 32_767) -> NDArray[np.int32]:
    """Counts of a hand that goes in and out of the wall, and some up to ± `most` that no hand would reach."""
    rng = np.random.default_rng(7)
    k = np.arange(samples)
    counts = np.rint(200 + 400 * np.sin(0.011 * k) + 3 * rng.normal(size=samples)).astype(np.int32)
    counts[::97] = rng.integers(-most, most + 1, size=counts[::97].size)
    counts[::31] = rng.integers(-40, 40, size=counts[::31].size)
    return counts
