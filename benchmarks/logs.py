"""How long does it take to read a log with all its checks, beside reading its bare numbers?"""

from __future__ import annotations

import argparse
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from statistics import median

import numpy as np
import pyarrow as pa
import pyarrow.csv as pc
import pyarrow.parquet as pq

import zwidth as zw

RUNS = 5


def write(folder: Path, samples: int) -> dict[str, Path]:
    """A hand that moves 20 mm to and fro, an encoder of 22.4 µm, a load cell; in two formats."""
    k = np.arange(samples)
    position = np.round(np.rint(0.02 * np.sin(1e-3 * k) / 22.4e-6) * 22.4e-6, 7)
    force = np.round(np.random.default_rng(0).normal(size=samples), 4)
    table = pa.table({"time_s": np.round(k / 1000, 3), "position_m": position, "hand_force_N": force})
    paths = {"Parquet": folder / "log.parquet", "CSV": folder / "log.csv"}
    pq.write_table(table, paths["Parquet"])
    pc.write_csv(table, paths["CSV"])
    return paths


def through(path: Path) -> None:
    """zwidth: the first pass with all checks, then every block."""
    for _ in zw.read_log(path).blocks():
        pass


def bare(path: Path) -> None:
    """pyarrow alone, block by block."""
    if path.suffix == ".parquet":
        with pq.ParquetFile(path) as file:
            for _ in file.iter_batches(batch_size=2**18):
                pass
    else:
        for _ in pc.open_csv(path, read_options=pc.ReadOptions(block_size=2**23)):
            pass


def seconds(call: Callable[[Path], None], path: Path) -> tuple[float, float]:
    """Time on the clock, and of the processors."""
    wall, used = time.perf_counter(), time.process_time()
    call(path)
    return time.perf_counter() - wall, time.process_time() - used


def peak(path: Path) -> int:
    """[MiB] most memory of a process that reads the log."""
    script = (
        "import resource, sys, zwidth as zw\n"
        "for _ in zw.read_log(sys.argv[1]).blocks(): pass\n"
        "print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss // 1024)\n"
    )
    run = subprocess.run(
        [sys.executable, "-c", script, str(path)], capture_output=True, text=True, check=True
    )
    return int(run.stdout)


def main() -> None:
    """Measure in turn and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--samples", type=int, default=10_000_000)
    samples = parser.parse_args().samples
    with tempfile.TemporaryDirectory() as folder:
        paths = write(Path(folder), samples)
        print(f"{samples} samples of time, position and force; medians of {RUNS}, pyarrow and zwidth in turn")
        for name, path in paths.items():
            for call in (bare, through):
                call(path)  # libraries loaded, file in the disk cache
            rounds = [(seconds(bare, path), seconds(through, path)) for _ in range(RUNS)]
            wall, used = ([median(r[who][what] for r in rounds) for who in (0, 1)] for what in (0, 1))
            ratio = median(theirs[1] / bare_[1] for bare_, theirs in rounds)
            print(
                f"{name:<8} {path.stat().st_size >> 20:>4} MiB  "
                f"pyarrow {wall[0]:.2f} s (processors {used[0]:.2f} s)  "
                f"zwidth {wall[1]:.2f} s (processors {used[1]:.2f} s)  {ratio:.1f} x  peak {peak(path)} MiB"
            )


if __name__ == "__main__":
    main()
