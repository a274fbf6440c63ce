"""How late is our loop beside cyclictest, on a core that another task keeps busy?

    python benchmarks/pace.py [--duration 600] [--core 0]

At 1 kHz and 5 kHz, as an ordinary thread and with SCHED_FIFO, both take turns of five seconds on the one core
on which a third process never rests; --duration is that of each of the four [s].  Printed are the lateness of
both, in quantiles, and ours by theirs at 99 %, which is wanted below 1.5.  cyclictest, of the package
rt-tests, counts whole microseconds and leaves an ordinary thread the timer slack of the system, 50 µs, where
ours asks for 1 ns.
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import subprocess
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np

from zwidth.machine.servo.lateness import TURN, turn
from zwidth.machine.servo.priority import PRIORITY, RealTime

RATES = (1000, 5000)
SHARES = (0.5, 0.99, 0.999, 1.0)
WANTED = 1.5
RANGE = 200_000
"""Of cyclictest's histogram [µs]."""


@contextmanager
def busy(core: int) -> Iterator[None]:
    """A process that never rests, on a core."""
    code = f"import os; os.sched_setaffinity(0, {{{core}}})\nwhile True: pass"
    child = subprocess.Popen([sys.executable, "-c", code])
    try:
        yield
    finally:
        child.kill()
        child.wait()


def ours(rate: int, fifo: bool, core: int, seconds: float) -> Counter[int]:
    """Steps by their lateness [µs]."""
    wishes = RealTime(core=core) if fifo else RealTime(priority=0, memory=False, core=core)
    found = turn(wishes, 1_000_000_000 // rate, round(seconds * rate), lambda share: None)
    assert not fifo or "priority" in found.granted, found.granted
    values, counts = np.unique((1e6 * found.late).round(2), return_counts=True)
    return Counter(dict(zip(values.tolist(), counts.tolist(), strict=True)))


def theirs(rate: int, fifo: bool, core: int, seconds: float) -> Counter[int]:
    """The same of cyclictest."""
    policy = ["--policy=fifo", f"-p{PRIORITY}", "-m"] if fifo else ["--policy=other"]
    with tempfile.TemporaryDirectory() as folder:
        told = Path(folder) / "told.json"
        loop = ["-t1", f"-a{core}", f"-i{1_000_000 // rate}", f"-l{round(seconds * rate)}", f"-h{RANGE}"]
        command = ["cyclictest", *loop, *policy, "-q", f"--json={told}"]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        thread = json.loads(told.read_text())["thread"]["0"]
    found = Counter({int(late): count for late, count in thread["histogram"].items()})
    found[thread["max"]] += thread["cycles"] - sum(found.values())  # those beyond the histogram
    return found


def quantiles(steps: Counter[int]) -> list[float]:
    """Of the lateness [µs]."""
    values = sorted(steps)
    share = np.cumsum([steps[v] for v in values]) / sum(steps.values())
    return [float(values[int(np.searchsorted(share, q - 1e-12))]) for q in SHARES]


def main() -> None:
    """All four, one after the other."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--duration", type=float, default=600.0, help="of each of the four [s]")
    parser.add_argument("--core", type=int, default=0, help="number of the core that is kept busy")
    arguments = parser.parse_args()
    if shutil.which("cyclictest") is None:
        sys.exit("cyclictest is not installed: it is in the package rt-tests")
    with RealTime() as granted:
        kinds = (False, True) if "priority" in granted else (False,)
    if len(kinds) == 1:
        print(f"SCHED_FIFO is left out: {granted['priority'].told}")
    print(f"load of the last minute: {os.getloadavg()[0]:.2f} on {os.cpu_count()} cores")
    print(f"{'':34}{'50 %':>9}{'99 %':>9}{'99.9 %':>9}{'worst':>9}   [µs]")
    rounds = max(round(arguments.duration / (2 * TURN)), 1)
    with busy(arguments.core):
        turn(RealTime(priority=0, memory=False), 1_000_000, 2, lambda share: None)  # load
        for rate in RATES:
            for fifo in kinds:
                found: list[Counter[int]] = [Counter(), Counter()]
                for _ in range(rounds):
                    for steps, loop in zip(found, (ours, theirs), strict=True):
                        steps.update(loop(rate, fifo, arguments.core, arguments.duration / (2 * rounds)))
                one, other = map(quantiles, found)
                kind = f"{rate} Hz, {'SCHED_FIFO' if fifo else 'ordinary'}"
                for name, values in (("ours", one), ("cyclictest", other)):
                    print(f"{kind:22}{name:12}" + "".join(f"{v:9.1f}" for v in values))
                ratio = one[1] / other[1]
                print(f"{'':22}ours by theirs at 99 %: {ratio:.3g}, wanted < {WANTED}", flush=True)
    print(f"load of the last minute: {os.getloadavg()[0]:.2f}")


if __name__ == "__main__":
    main()
