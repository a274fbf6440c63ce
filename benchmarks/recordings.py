"""What does a recording of a loop at 5 kHz cost: processor, bytes, memory, and does it lose rows?

Rows of a simulated touch are handed to the recorder as a ring would hand them, by the clock; with --speed 10
ten minutes pass in one.  The share of a processor is that of the recorder alone: nothing else runs here.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import zwidth as zw
from zwidth.machine.servo.recording import Recorded, Recorder, read_recording

Array = NDArray[np.float64]

PERIOD = 2e-4
COLUMNS = (
    "sample",
    "time_s",
    "late_s",
    "position_m",
    "wished_force_N",
    "force_N",
    "energy_out_J",
    "friction_loss_J",
    "status",
    "phase",
    "law",
    "limited",
    "exchange_s",
)


class Clocked:
    """Rows that come into being as time passes, `speed` times as fast as at 5 kHz."""

    COLUMNS = COLUMNS
    period, motion, title = PERIOD, "linear", "a touch of a finger at 5 kHz"

    def __init__(self, speed: float, rows: int) -> None:
        self.about: dict[str, Any] = {"device": "haptic paddle"}
        self.events: list[dict[str, Any]] = []
        self.touch = touch()
        self._rate, self._all, self._start = speed / PERIOD, rows, time.perf_counter()
        self._kept = max(1 << 15, int(4 * speed / PERIOD))

    @property
    def written(self) -> int:
        """Rows so far."""
        return min(self._all, int((time.perf_counter() - self._start) * self._rate))

    def after(self, count: int) -> tuple[int, Array]:
        """As the ring of the loop does."""
        written = self.written
        numbers = np.arange(max(count, written - self._kept), written)
        rows = self.touch[numbers % len(self.touch)]
        rows[:, 0] = numbers
        rows[:, 1] = numbers * PERIOD + rows[:, 2]
        return written, rows


def touch() -> Array:
    """Twelve seconds of a hand that goes in and out of a wall, by a clock that is some microseconds late."""
    device = zw.catalogue.device("haptic-paddle").replace(sample_period=PERIOD)
    samples = 60_000
    times = PERIOD * np.arange(samples + 1)
    hand = zw.operators.Tracking(2e-3 * np.sin(6 * times), stiffness=300.0, damping=1.0)
    trace = zw.simulate(device, zw.Wall(stiffness=300), hand, samples * device.exact("sample_period"))
    random = np.random.default_rng(0)
    table = np.zeros((samples, len(COLUMNS)))
    table[:, COLUMNS.index("phase")] = 2.0
    table[:, COLUMNS.index("late_s")] = np.rint(random.gamma(2.0, 2000.0, samples)) * 1e-9
    table[:, COLUMNS.index("exchange_s")] = np.rint(random.gamma(4.0, 10_000.0, samples)) * 1e-9
    taken = {
        "position_m": "measured_position",
        "wished_force_N": "commanded_force",
        "force_N": "commanded_force",
        "energy_out_J": "actuator_work",
        "friction_loss_J": "coulomb_loss",
    }
    for name, of in taken.items():
        table[:, COLUMNS.index(name)] = trace[of].values[:samples]
    return table


def resident() -> float:
    """[MB] of memory that this process has now."""
    pages = int(Path("/proc/self/statm").read_text(encoding="utf-8").split()[1])
    return pages * 4096 / 1e6


def recorded(path: Path, seconds: float, speed: float) -> tuple[Recorded, float, float, float]:
    """What became of it, the share of a processor, and the memory [MB] after a quarter and at the end."""
    rows = Clocked(speed, int(seconds / PERIOD))
    sizes: list[float] = []
    used, begun = time.process_time(), time.perf_counter()
    with Recorder(rows, path, force=True) as recorder:
        while rows.written < seconds / PERIOD:
            time.sleep(0.5)
            sizes.append(resident())
    share = (time.process_time() - used) / (time.perf_counter() - begun)
    quarter = len(sizes) // 4
    return recorder.close(), share, sizes[quarter], sizes[-1]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--minutes", type=float, default=10.0)
    parser.add_argument("--speed", type=float, default=10.0, help="times as fast as at 5 kHz")
    parser.add_argument("--folder", default=None, help="where to write (default: a temporary folder)")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory(dir=arguments.folder) as folder:
        path = Path(folder) / "run.mcap"
        done, share, early, late = recorded(path, 60 * arguments.minutes, arguments.speed)
        begun = time.perf_counter()
        found = read_recording(path)
        took = time.perf_counter() - begun
        assert found.whole
        assert found.samples == done.rows
        whole = np.array_equal(found.columns["sample"], np.arange(done.rows))
        print(
            f"{path.name}: {done.rows:,} rows, {done.rows_lost} lost, all there: {whole}; "
            f"{done.size / max(1, done.rows):.1f} bytes a row, {done.size / 1e6:.0f} MB; "
            f"{100 * share:.2f} % of a processor at {5 * arguments.speed:g} kHz; memory {early:.0f} MB "
            f"after a quarter, {late:.0f} MB at the end; read back in {took:.1f} s"
        )


if __name__ == "__main__":
    main()
