"""How late is the served loop, with its simulated paddle, beside cyclictest on a busy machine?

    python benchmarks/served_paddle.py [--duration 600]

At 1 kHz and 5 kHz the paddle is served on one core and cyclictest runs on another, at the same time, both
with SCHED_FIFO and locked memory, beside a process on each core that never rests.  Every turn they change
cores, so that both meet the same machine.  --duration is that of each rate [s].  Printed are the quantiles
of the lateness and ours by theirs at 99 %, which is wanted below 1.5; and whether each turn, simulated again
with its recorded lateness, gives the same forces and energies, to the last bit.
"""

from __future__ import annotations

import argparse
import os
import shutil
import sys
from collections import Counter
from concurrent.futures import ThreadPoolExecutor

import numpy as np
from pace import busy, quantiles, theirs

import zwidth as zw
from zwidth.machine.servo import RealTime, Safety, Servo
from zwidth.machine.servo.devices import Simulated

TURN = 60.0
"""[s]"""

WANTED = 1.5

LENIENT = Safety(longest_gap="30 s", host_timeout="30 s")
"""A machine that stands still for a while is to be measured here; otherwise the force would end."""


def served(rate: int, core: int, seconds: float) -> tuple[Counter[float], np.ndarray, bool]:
    """Samples by lateness [µs], how long each gap was [samples], whether a replay gives the same bits."""
    paddle = zw.catalogue.device("haptic-paddle").replace(rate=rate)
    wall = zw.Wall(stiffness=290 * rate / 1000)
    simulated = Simulated(device=paddle, hand=zw.operators.Finger(), duration=seconds)
    with Servo(paddle, wall, simulated, real_time=RealTime(core=core), safety=LENIENT) as servo:
        servo.measure("0.1 s")
        servo.start(anyway=True)
        seen, kept = 0, []
        while not servo.wait(0.5):
            seen, rows = servo.rows.after(seen)
            kept.append(rows)
        kept.append(servo.rows.after(seen)[1])
        names = servo.rows.COLUMNS
        assert not servo.report().failed, servo.report().ended
    table = np.concatenate(kept)
    columns = dict(zip(names, table[table[:, names.index("phase")] == 2].T, strict=True))
    taken = columns["sample"].astype(int)
    gaps = np.diff(taken, prepend=-1, append=simulated.samples + 1) - 1
    late, absent = np.zeros(simulated.samples + 1), np.ones(simulated.samples + 1, bool)
    late[taken], absent[taken] = columns["late_s"], False
    timing = zw.simulation.Timing(lateness=late, missed=absent)
    trace = zw.simulate(paddle, wall, simulated.scripted, simulated.duration, timing=timing)
    pairs = (("force_N", "commanded_force"), ("hand_work_J", "hand_work"), ("true_position_m", "position"))
    same = all(np.array_equal(columns[a], trace[b].values[taken]) for a, b in pairs)
    values, counts = np.unique((1e6 * columns["late_s"]).round(2), return_counts=True)
    return Counter(dict(zip(values.tolist(), counts.tolist(), strict=True))), gaps[gaps > 0], same


def main() -> None:
    """Both rates, one after the other."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--duration", type=float, default=600.0, help="of each rate [s]")
    duration = parser.parse_args().duration
    if shutil.which("cyclictest") is None:
        sys.exit("cyclictest is not installed: it is in the package rt-tests")
    served(1000, 0, 0.5)  # loaded before anything is timed
    turns = max(2, round(duration / TURN))
    print(f"load of the last minute: {os.getloadavg()[0]:.2f} on {os.cpu_count()} cores")
    print(f"{'':26}{'50 %':>9}{'99 %':>9}{'99.9 %':>9}{'worst':>9}   [µs]")
    for rate in (1000, 5000):
        ours, cyclictest = Counter[float](), Counter[float]()
        gaps, same = [], 0
        with busy(0), busy(1), ThreadPoolExecutor() as pool:
            for turn in range(turns):
                core = turn % 2
                other = pool.submit(theirs, rate, True, 1 - core, duration / turns)
                found, missed, equal = served(rate, core, duration / turns)
                ours.update(found)
                cyclictest.update(other.result())
                gaps.append(missed)
                same += equal
        one, two = quantiles(ours), quantiles(cyclictest)
        for name, values in (("served paddle", one), ("cyclictest", two)):
            print(f"{rate} Hz {name:18}" + "".join(f"{v:9.1f}" for v in values))
        print(f"{'':8}ours by theirs at 99 %: {one[1] / two[1]:.3g}, wanted < {WANTED}")
        gap = np.concatenate([*gaps, np.zeros(1)]) / rate * 1e3
        told = f"{sum(ours.values())} samples, {round(gap.sum() * rate / 1e3)} missed in {gap.size - 1} gaps"
        print(
            f"{'':8}{told}, the longest {gap.max():.3g} ms; {gap[gap > 10].sum():.3g} ms in gaps above 10 ms"
        )
        print(f"{'':8}{same} of {turns} turns replayed to the last bit", flush=True)
    print(f"load of the last minute: {os.getloadavg()[0]:.2f}")


if __name__ == "__main__":
    main()
