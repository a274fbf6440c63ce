"""A Panda-like arm: how long the map over all its postures takes, and what is decided about random postures.

    python benchmarks/arm_postures.py [POSTURES] [PLACES]

Of every place a box of ±0.02 rad in two joints is asked with walls of 0.9 and of 1.1 times what its
middle bears.
The seconds are of this machine, and of the processor alone beside them.
"""

from __future__ import annotations

import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

import numpy as np

import zwidth as zw

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))
from described_arms import panda_like

HALF = 0.02


def main(postures: int, places: int) -> None:
    """Print both."""
    path = panda_like(Path(tempfile.mkdtemp()) / "panda.urdf")
    arm = zw.arms.read_arm(path, whole=True)
    begun, used = time.perf_counter(), time.process_time()
    found = zw.stiffness_over_postures(arm, zw.Wall(500), rate=1000, postures=postures)
    seconds, busy = time.perf_counter() - begun, time.process_time() - used
    print(f"{postures} postures: {seconds:.1f} s, {busy:.1f} s of a processor")
    print(f"stiffest wall at all of them: {found.largest_stiffness:.6g} N/m")
    low, high = np.array(arm.joint_range).T
    rng = np.random.default_rng(11)
    for share in (0.9, 1.1):
        outcomes: Counter[str] = Counter()
        for _ in range(places):
            q = rng.uniform(low + HALF, high - HALF)
            ranges = [(v - HALF, v + HALF) if i in (1, 3) else (v, v) for i, v in enumerate(q)]
            here = arm.replace(joint_range=ranges)
            stiffest = 2 * 1000 / np.linalg.norm(here.jacobian(q), 2) ** 2  # 1 N*m*s/rad in each joint
            outcomes[zw.workspace(here, zw.Wall(share * stiffest), rate=1000, points=10).outcome] += 1
        print(f"walls of {share:g} times what the middle bears: {dict(outcomes)}", flush=True)


if __name__ == "__main__":
    main(*(int(word) for word in (sys.argv[1:] + ["20000", "10"][len(sys.argv) - 1 :])))
