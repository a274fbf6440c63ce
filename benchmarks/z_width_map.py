"""How long does a Z-width map take for each cell, beside a loop over python-control?

* `zw.z_width`: 1000 × 1000 cells, three hands, each cell passive or not by exact comparison and
  stable or not by floats with bounds, exactly where these do not suffice;
* the same written to a zarr store chunk by chunk;
* python-control on 20 × 20 cells of the same map, one hand: plant sampled once, feedback with each wall,
  largest modulus of its poles; nothing proved.

Warm, medians of five; the ratio is for one cell and one hand.
"""

from __future__ import annotations

import shutil
import tempfile
import time
import warnings
from collections.abc import Callable
from pathlib import Path
from statistics import median

import control
import numpy as np

import zwidth as zw
from zwidth.model.operator import Finger

CELLS, FEW = 1000, 20
STIFFNESS, DAMPING = (0, 30000), (0, 90)
DEVICE, PERIOD = zw.catalogue.device("haptic-paddle"), 1e-3


def with_control() -> np.ndarray:
    """Stable or not, 20 × 20 cells with a finger."""
    finger, mass = Finger(), float(DEVICE.mass) + Finger().mass
    plant = control.tf([1], [mass, float(DEVICE.damping) + finger.damping, finger.stiffness])
    sampled = control.sample_system(plant, PERIOD, method="zoh")
    stable = np.empty((FEW, FEW), dtype=bool)
    for i, k in enumerate((np.arange(FEW) + 0.5) * STIFFNESS[1] / FEW):
        for j, b in enumerate((np.arange(FEW) + 0.5) * DAMPING[1] / FEW):
            wall = control.tf([k + b / PERIOD, -b / PERIOD], [1, 0], PERIOD)
            stable[i, j] = np.abs(control.feedback(sampled, wall).poles()).max() < 1
    return stable


def seconds(action: Callable[[], object]) -> float:
    """The median of five runs, the first one warm."""
    action()
    times = []
    for _ in range(5):
        start = time.perf_counter()
        action()
        times.append(time.perf_counter() - start)
    return median(times)


def mapped(path: Path | None = None) -> None:
    """The whole map, to memory or to a new store."""
    if path is not None:
        shutil.rmtree(path, ignore_errors=True)
    zw.z_width(DEVICE, STIFFNESS, DAMPING, (CELLS, CELLS), path=path)


def main() -> None:
    """Print the table."""
    warnings.simplefilter("ignore")
    own = zw.z_width(DEVICE, STIFFNESS, DAMPING, (FEW, FEW), hands={"finger": Finger()})
    differ = int((own["stable_finger"].values != with_control()).sum())
    memory = seconds(mapped)
    with tempfile.TemporaryDirectory() as folder:
        stored = seconds(lambda: mapped(Path(folder) / "map.zarr"))
    rival = seconds(with_control)
    each, theirs = memory / (3 * CELLS**2) * 1e9, rival / FEW**2 * 1e9
    print(f"zwidth, {CELLS} x {CELLS} cells, 3 hands    {memory:6.2f} s {each:8.0f} ns per cell and hand")
    print(f"the same to a zarr store           {stored:6.2f} s")
    print(f"python-control, {FEW} x {FEW} cells, 1 hand  {rival:6.2f} s {theirs:8.0f} ns per cell and hand")
    print(f"ratio {theirs / each:.0f}; cells where they differ: {differ} of {FEW**2}")


if __name__ == "__main__":
    main()
