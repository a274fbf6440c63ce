"""The experiments of two papers, served in real time: are they what the simulation says?

    python benchmarks/served_experiments.py                    prints the tables; about three minutes
    python benchmarks/served_experiments.py --watch browser    draws them while they run; or terminal

Abbott & Okamura (2005), section IV: touches of a Haptic Paddle by a finger and a dowel.  The soft-tissue
paper, its Table 2: a motorized guide pushes a PHANToM into a wall whose stiffness is raised until it goes
unstable.  Device and hand are simulated in the loop, which runs in real time on a thread of its own.
"""

from __future__ import annotations

import argparse
import contextlib
import time
from collections.abc import Iterator
from typing import Any

import numpy as np

import zwidth as zw
from zwidth.machine.servo import Servo
from zwidth.machine.servo.devices import Simulated

STIFFNESS = np.geomspace(500, 12_000, 33)
"""Tried by halving [N/m]."""


def serve(device: Any, law: Any, hand: Any, duration: float, watch: str) -> dict[str, Any]:
    """Columns of the served samples, lateness, and how much of it the simulation says again."""
    simulated = Simulated(device=device, hand=hand, duration=duration)
    with Servo(device, law, simulated, decide=lambda *_: zw.check(device, zw.Wall(1))) as servo:
        servo.measure("50 ms")
        with watched(servo, watch):
            kept: list[np.ndarray] = []
            seen = 0
            servo.start(anyway=True)
            while servo.running:
                time.sleep(0.05)
                seen, new = servo.rows.after(seen)
                kept.append(new)
            seen, new = servo.rows.after(seen)
        table = np.concatenate([*kept, new])
        columns = dict(
            zip(servo.rows.COLUMNS, table[table[:, servo.rows.column("phase")] == 2].T, strict=True)
        )
        report = servo.report()
    taken = columns["sample"].astype(int)
    late, missed = np.zeros(simulated.samples + 1), np.ones(simulated.samples + 1, bool)
    late[taken], missed[taken] = columns["late_s"], False
    timing = zw.simulation.Timing(lateness=late, missed=missed)
    trace = zw.simulate(device, law, simulated.scripted, simulated.duration, timing=timing)
    regular = zw.simulate(device, law, hand, simulated.duration)
    same = np.array_equal(trace.hand_work.values[taken], columns["hand_work_J"])
    same &= np.array_equal(trace.commanded_force.values[taken], columns["force_N"])
    return {
        "x": columns["true_position_m"],
        "out": max(0.0, -columns["hand_work_J"].min()),
        "simulated": regular.zwidth.energy.got_out,
        "swing": last_second(columns["true_position_m"], device),
        "swing simulated": last_second(regular.position.values, device),
        "same": same,
        "missed": report.missed,
    }


def last_second(x: np.ndarray, device: Any) -> float:
    """How far the handle swings in it [m]."""
    return float(np.ptp(x[-round(1 / float(device.exact("sample_period"))) :]))


@contextlib.contextmanager
def watched(servo: Servo, face: str) -> Iterator[None]:
    """Drawn meanwhile."""
    if face == "none":
        yield
        return
    from zwidth.cli.machine.serve import begin_watching

    end = begin_watching(face, 0 if face == "browser" else None, servo)
    try:
        yield
    finally:
        end()


def paddle(watch: str) -> None:
    """Touches of the paddle: what the hand got out, served and simulated with a regular clock."""
    device, hands = zw.catalogue.device("haptic-paddle"), zw.operators
    coarse = device.replace(resolution="2.24 mm")
    touches = [
        ("typical touch, 300 N/m", device, 300, hands.TypicalTouch(), 2.0),
        ("malicious touch, 300 N/m", device, 300, hands.MaliciousTouch(), 2.0),
        ("typical touch, 770 N/m", device, 770, hands.TypicalTouch(), 2.0),
        ("malicious touch, 770 N/m", device, 770, hands.MaliciousTouch(), 2.0),
        ("dowel, 770 N/m", device, 770, hands.Dowel(), 2.0),
        ("soft touch, coarse encoder, 80 N/m", coarse, 80, hands.SoftTouch(), 3.0),
        ("soft touch, coarse encoder, 240 N/m", coarse, 240, hands.SoftTouch(), 3.0),
    ]
    heads = ("served", "simulated", "served", "simulated", "same bits", "missed")
    print(f"{'':36} {'got out [mJ]':>19} {'swing at the end [µm]':>23}")
    print(f"{'touch':36} {' '.join(f'{head:>10}' for head in heads)}")
    for name, own, stiffness, hand, seconds in touches:
        got = serve(own, zw.Wall(stiffness), hand, seconds, watch)
        numbers = (1e3 * got["out"], 1e3 * got["simulated"], 1e6 * got["swing"], 1e6 * got["swing simulated"])
        cells = " ".join(f"{number:10.4g}" for number in numbers)
        print(f"{name:36} {cells} {got['same']!s:>10} {got['missed']:10}")


PAPER = {0.0: (5322, 5350), 5.0: (5164, 3540), 14.0: (6094, 0)}
"""Of Table 2, at damping [N·s/m]: standard linear solid, Kelvin-Voigt [N/m]."""


def tissue(watch: str) -> None:
    """The largest stiffness at which the guide's push stays quiet."""
    phantom = zw.Device(
        mass=0.008, damping=0.27, coulomb_friction=0.04, resolution=3e-5, sample_period=1e-3, name="PHANToM"
    )
    path = np.minimum(0.02e-3 * np.arange(1201) - 0.002, 0.01)
    guide = zw.operators.Tracking(path, stiffness=5000, damping=0.3)
    moved = path[-1] - path[900]
    print(f"\n{'wall, largest quiet stiffness':36} {'served':>8} {'simulated':>10} {'paper':>8}   N/m")
    for damping, paper in PAPER.items():
        for wall, of_paper in zip(("standard linear solid", "Kelvin-Voigt"), paper, strict=True):

            def law(k: float, wall: str = wall, b: float = damping) -> Any:
                return zw.StandardLinearSolid(k, 10, b) if wall.startswith("standard") else zw.Wall(k, b)

            def shakes(k: float) -> bool:
                x = serve(phantom, law(k), guide, 1.2, watch)["x"]
                return float(np.ptp(x[len(x) * 3 // 4 :])) > moved + 0.5e-3

            low, high = 0, len(STIFFNESS) - 1
            while high - low > 1:
                middle = (low + high) // 2
                low, high = (low, middle) if shakes(STIFFNESS[middle]) else (middle, high)
            batch = zw.simulation.simulate_batch(
                phantom, law(1), guide, 1.2, vary={"environment.stiffness": STIFFNESS}
            )
            wild = batch.swing.values > moved + 0.5e-3
            first = STIFFNESS[np.argmax(wild)] if wild.any() else np.inf
            name = f"{wall}, {damping:g} N·s/m"
            print(f"{name:36} {STIFFNESS[high]:8.0f} {first:10.0f} {of_paper:8}")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--watch", choices=("none", "terminal", "browser"), default="none")
    watching = parser.parse_args().watch
    paddle(watching)
    tissue(watching)
