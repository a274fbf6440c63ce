"""The report and the picture of docs/identification.md: 100 s of a simulated paddle.

Run it as `python examples/identify_report.py docs/_static/identify.png`; it prints the report.
The log, paddle.csv, is written to a temporary folder.
"""

from __future__ import annotations

import os
import sys
import tempfile
from pathlib import Path

import numpy as np

import zwidth as zw
from zwidth.cli.main import main

SAMPLES = 100_000


def record(path: Path) -> None:
    """A hand that wanders, and a load cell of ±10 N with 0.1 N of noise and a drifting zero."""
    rng = np.random.default_rng(1)
    paddle = zw.catalogue.device("haptic-paddle")
    time = 1e-3 * np.arange(SAMPLES + 1)
    waves = zip(rng.normal(size=12), rng.uniform(0.3, 4, 12), rng.uniform(0, 6.28, 12), strict=True)
    hand = np.sum([a * np.sin(2 * np.pi * f * time + p) for a, f, p in waves], axis=0)
    hand = hand * 0.02 / hand.std() - 1  # the wall is a metre away
    operator = zw.operators.Tracking(hand, stiffness=300, damping=0)
    trace = zw.simulate(paddle, zw.Wall(1), operator, SAMPLES / 1000, initial_position=hand[0])
    zero = np.interp(time, np.arange(0, 121, 20), 0.05 * np.cumsum(rng.normal(size=7)))
    force = trace["hand_force"].values + zero + rng.normal(0, 0.1, time.size)
    table = np.column_stack([time, trace["measured_position"].values, force])[:SAMPLES]
    np.savetxt(path, table, delimiter=",", header="time_s,position_m,hand_force_N", comments="", fmt="%.9g")


if __name__ == "__main__":
    picture = Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        record(Path("paddle.csv"))
        command = "identify paddle.csv --resolution 22.4um --stiffness 250 --all --force --plot"
        main((*command.split(), str(picture)))
