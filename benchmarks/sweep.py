"""A sweep of a million loops: killed and gone on with on two Dask workers, and against a plain Python loop.

    python benchmarks/sweep.py                    10^6 springs over stiffness and delay
    python benchmarks/sweep.py --walls            10^6 walls over stiffness and virtual damping, 0 among it
    python benchmarks/sweep.py --side 300         as many along each axis

The sweep is run three times: undisturbed on one process; on two workers of a Dask cluster, its command killed
by SIGKILL when about a third of the chunks are there; and the same command again.  Every array is compared,
byte by byte.  The times of a loop are of the processor, and of one run.
"""

from __future__ import annotations

import argparse
import os
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np

import zwidth as zw


def main() -> None:
    """Print what was measured."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--side", type=int, default=1000, help="values along each axis (default: 1000)")
    parser.add_argument("--loops", type=int, default=200, help="of the plain Python loop (default: 200)")
    parser.add_argument("--walls", action="store_true", help="walls with virtual damping, not springs alone")
    asked = parser.parse_args()
    other = "virtual_damping=0:0.15" if asked.walls else "delay=0:5 ms"
    with tempfile.TemporaryDirectory() as folder:
        _killed_and_gone_on(Path(folder), asked.side, other)
    if asked.walls:
        _damped(zw.catalogue.device("haptic-paddle"), asked.loops, asked.side)
    else:
        _against_a_loop(asked.side, asked.loops)


def _command(path: Path, side: int, other: str, *more: str) -> list[str]:
    varied = ("--vary", f"stiffness=1:3000:{side}", "--vary", f"{other}:{side}")
    return [sys.executable, "-m", "zwidth", "sweep", "haptic-paddle", *varied, "-o", str(path), *more]


def _killed_and_gone_on(folder: Path, side: int, other: str) -> None:
    from distributed import LocalCluster

    alone, killed = folder / "alone.zarr", folder / "killed.zarr"
    begun = time.perf_counter()
    subprocess.run(_command(alone, side, other, "--workers", "1"), check=True, stdout=subprocess.DEVNULL)
    print(f"undisturbed, one process: {side**2} loops in {time.perf_counter() - begun:.1f} s")
    with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
        command = _command(killed, side, other, "--dask", cluster.scheduler_address)
        process = subprocess.Popen(command)
        while _done(killed)[0] * 3 < max(_done(killed)[1], 1) and process.poll() is None:
            time.sleep(0.02)
        os.kill(process.pid, signal.SIGKILL)
        process.wait()
        done, chunks = _done(killed)
        print(f"on two Dask workers, killed by SIGKILL with {done} of {chunks} chunks on disk")
        begun = time.perf_counter()
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        print(f"the same command again: whole after {time.perf_counter() - begun:.1f} s more")
    print(f"same bytes in every array: {_arrays(alone) == _arrays(killed)}")


def _done(path: Path) -> tuple[int, int]:
    """Chunks that are marked, and how many there are."""
    import zarr

    try:
        marks = np.asarray(zarr.open_group(path, mode="r")["done"])
    except (FileNotFoundError, KeyError, ValueError):
        return 0, 0
    return int(marks.sum()), marks.size


def _arrays(path: Path) -> dict[str, bytes]:
    import zarr

    group: Any = zarr.open_group(path, mode="r")
    return {name: np.asarray(array).tobytes() for name, array in group.arrays()}


def _against_a_loop(side: int, loops: int) -> None:
    """The time of a loop in a sweep, and in Python over `zw.check`, of loops drawn from the same grid."""
    device, wall = zw.catalogue.device("haptic-paddle"), zw.Wall(100)
    vary = {"stiffness": f"1:3000:{side}", "delay": f"0:5 ms:{side}"}
    begun = time.process_time()
    found = zw.sweep(device, wall, vary=vary, workers=1, progress=lambda *_: None)
    swept = (time.process_time() - begun) / side**2
    drawn = np.random.default_rng(1).integers(side, size=(loops, 2))
    zw.check(device, wall)  # what is loaded once
    outcome = with_numbers = 0.0
    for k, d in drawn:
        stiffness, delay = float(found.stiffness[k]), float(found.delay[d])
        begun = time.process_time()
        verdict = zw.check(device.replace(delay=delay), wall.replace(stiffness=stiffness))
        middle = time.process_time()
        largest, limit = verdict.max_stiffness, verdict.limit  # type: ignore[attr-defined]  # it is linear
        with_numbers += time.process_time() - begun
        outcome += middle - begun
        one = found.isel(stiffness=k, delay=d)
        assert (one.outcome, one.binding, one.max_stiffness) == (verdict.outcome, limit, largest)
    each, both = outcome / loops, with_numbers / loops
    print(f"springs, a loop: sweep {swept * 1e6:.1f} µs, zw.check {each * 1e6:.0f} µs")
    print(f"  ratio {each / swept:.0f}")
    print(f"  with what binds and the largest stiffness {both * 1e6:.0f} µs, ratio {both / swept:.0f}")
    print(f"  {loops} loops drawn at random, each the same")


def _damped(device: zw.Device, loops: int, side: int) -> None:
    """The same of walls with damping, most of them decided line by line."""
    begun = time.process_time()
    few = min(side, 20)  # lines; each as long as in the sweep above
    found = zw.sweep(
        device, zw.Wall(100, "0.1"), workers=1, progress=lambda *_: None,
        vary={"stiffness": (1, 3000, side), "virtual_damping": (0.001, 0.15, few)},
    )  # fmt: skip
    swept = (time.process_time() - begun) / (side * few)
    plain = 0.0
    for k, b in np.random.default_rng(1).integers((side, few), size=(loops, 2)):
        stiffness, virtual = float(found.stiffness[k]), float(found.virtual_damping[b])
        begun = time.process_time()
        verdict = zw.check(device, zw.Wall(stiffness, virtual))
        largest, limit = verdict.max_stiffness, verdict.limit  # type: ignore[attr-defined]  # it is linear
        plain += time.process_time() - begun
        one = found.isel(stiffness=k, virtual_damping=b)
        assert (one.outcome, one.binding, one.max_stiffness) == (verdict.outcome, limit, largest)
    each = plain / loops
    print(
        f"damped walls, {side * few} loops: sweep {swept * 1e6:.0f} µs a loop, zw.check {each * 1e3:.1f} ms"
    )
    print(f"  ratio {each / swept:.0f}; {loops} loops drawn at random, each the same")


if __name__ == "__main__":
    main()
