"""Do the intervals of an identified device hold, how wide are they, and how long does it take?

    python benchmarks/identification.py [--runs 500] [--others 100] [--samples 100000] [--seed 0]

A simulated hand moves the haptic paddle about (m = 0.036 kg, b = 0.15 N s/m, f_c = 0.12 N); a load
cell of ±10 N with white noise of 1 % of its range, 0.1 N, and a zero that drifts by 0.05 N in
20 s, and an encoder record it.  For each parameter: how often its 95 % interval held
the truth, the mean width of the interval against the Cramér–Rao bound for one who knows the true
motion and only has the noise and the drift of the force against him, and what the method of
Abbott & Okamura (2005) made of the same record: its mean error.  Then the time for 10⁷ samples,
beside reading them.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.csv
import pyarrow.parquet
from scipy import stats

import zwidth as zw
from zwidth.data.identification.device.identify import identify
from zwidth.data.identification.device.published import identify_published
from zwidth.data.logs import Log, read_log

TRUE = {"mass": 0.036, "damping": 0.15, "coulomb_friction": 0.12}
NOISE, DRIFT = 0.1, 0.05
FINE = 2.5e-4
CONDITIONS = {
    "22.4 um, 1 kHz": {},
    "224 um, 1 kHz": {"resolution": "224 um"},
    "2.24 mm, 1 kHz": {"resolution": "2.24 mm"},
    "22.4 um, 500 Hz": {"sample_period": "2 ms"},
    "22.4 um, 5 kHz": {"sample_period": "0.2 ms"},
    "22.4 um, 1 kHz, 10 s": {"seconds": 10.0},
}


def record(seed, samples, seconds=None, **others):
    """One recording of the paddle, and the standard errors of the Cramér–Rao bound."""
    rng = np.random.default_rng(seed)
    device = zw.Device(**{**TRUE, "resolution": "22.4 um", "sample_period": "1 ms", **others})
    period = float(device.exact("sample_period"))
    samples = samples if seconds is None else round(seconds / period)
    finer = max(1, round(period / FINE))  # the hand's path is straight between samples
    at = np.arange(samples * finer + 1) * period / finer
    waves = zip(rng.normal(size=12), rng.uniform(0.3, 4.0, 12), rng.uniform(0, 6.28, 12), strict=True)
    path = sum(a * np.sin(2 * np.pi * f * at + p) for a, f, p in waves)
    path = path * 0.02 / path.std() - 1.0
    hand = zw.operators.Tracking(path, stiffness=300.0, damping=0.0)
    trace = zw.simulate(
        device.replace(sample_period=device.exact("sample_period") / finer),
        zw.Wall(stiffness=1),  # a metre away
        hand,
        samples * device.exact("sample_period"),
        initial_position=path[0],
    )
    names = ("measured_position", "velocity", "hand_force")
    read, v, force = (trace[name].values[: samples * finer : finer] for name in names)
    at = at[: samples * finer : finer]
    knots = np.arange(0.0, at[-1] + 20.0, 20.0)
    zero = np.interp(at, knots, DRIFT * np.cumsum(rng.normal(size=knots.size)))
    measured = force + zero + NOISE * rng.normal(size=samples)
    log = Log.from_arrays(
        time=at, position=read, hand_force=measured, resolution=float(device.exact("resolution"))
    )
    return log, best_possible(at, v)


def best_possible(at, v):
    """Standard errors of m, b, f_c by Cramér and Rao, a line of drift in each 10 s left free."""
    moving = v != 0
    columns = np.stack([np.gradient(v, at), v, np.sign(v)], axis=1)[moving]
    piece = (at[moving] // 10.0).astype(int)
    for k in np.unique(piece):
        here = piece == k
        basis, _ = np.linalg.qr(np.stack([np.ones(here.sum()), at[moving][here]], axis=1))
        columns[here] -= basis @ (basis.T @ columns[here])
    return NOISE * np.sqrt(np.diag(np.linalg.inv(columns.T @ columns)))


def one(task):
    """Interval held, width by the bound, relative error of both methods; for m, b and f_c."""
    seed, samples, others = task
    log, bound = record(seed, samples, **others)
    found, published = identify(log), identify_published(log)
    rows = []
    for name, best in zip(TRUE, bound, strict=True):
        low, high = found.estimates[name].interval(0.95)
        width = (high - low) / (2 * stats.norm.ppf(0.975) * best)
        ours = found.estimates[name].value / TRUE[name] - 1
        theirs = getattr(published, name) / TRUE[name] - 1
        rows.append((low <= TRUE[name] <= high, width, ours, theirs))
    return rows


def coverage(name, others, runs, samples, seed):
    """One condition, three lines."""
    with ProcessPoolExecutor() as pool:
        results = np.array(
            list(pool.map(one, [(seed + k, samples, others) for k in range(runs)], chunksize=4))
        )
    for k, parameter in enumerate(TRUE):
        held, width, ours, theirs = results[:, k].T
        print(
            f"{name:22} {parameter:17} held {int(held.sum()):4d} of {runs} ({held.mean():6.1%})"
            f"   width {width.mean():5.2f} x Cramer-Rao   error {ours.mean():+8.3%} ± {ours.std():.3%}"
            f"   published method {theirs.mean():+8.2%}",
            flush=True,
        )


def speed(samples):
    """Seconds for a long recording, from arrays and from files, beside the bare reading of the file."""
    log, _ = record(0, 100_000)
    block = list(log.blocks())
    once = {k: np.concatenate([getattr(b, k) for b in block]) for k in ("position", "hand_force")}
    repeats = samples // once["position"].size
    table = pa.table(
        {
            "time_s": np.arange(repeats * once["position"].size) * 1e-3,
            "position_m": np.tile(once["position"], repeats),
            "hand_force_N": np.tile(once["hand_force"], repeats),
        }
    )
    identify(log)  # loaded
    with tempfile.TemporaryDirectory() as folder:
        files = {"csv": Path(folder, "log.csv"), "parquet": Path(folder, "log.parquet")}
        pyarrow.csv.write_csv(table, files["csv"])
        pyarrow.parquet.write_table(table, files["parquet"])
        bare = {"csv": pyarrow.csv.read_csv, "parquet": pyarrow.parquet.read_table}
        for kind, path in files.items():
            reading = min(_timed(lambda k=kind, p=path: bare[k](p)) for _ in range(3))
            whole = min(_timed(lambda p=path: identify(read_log(p, resolution=22.4e-6))) for _ in range(3))
            print(
                f"{table.num_rows:.0e} samples from {kind:8} {whole:6.2f} s, bare reading {reading:.2f} s: "
                f"{whole / reading:.1f} times as long"
            )


def _timed(work):
    start = time.perf_counter()
    work()
    return time.perf_counter() - start


def main():
    """All of it."""
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("--runs", type=int, default=500)
    arguments.add_argument("--others", type=int, default=100)
    arguments.add_argument("--samples", type=int, default=100_000)
    arguments.add_argument("--seed", type=int, default=0)
    given = arguments.parse_args()
    for k, (name, others) in enumerate(CONDITIONS.items()):
        coverage(name, others, given.runs if k == 0 else given.others, given.samples, given.seed)
    speed(10**7)


if __name__ == "__main__":
    main()
