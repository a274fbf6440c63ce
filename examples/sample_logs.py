"""The logs that ship as samples: strokes on a simulated paddle, a wheel that shakes, a relaxation test.

Run it as `python examples/sample_logs.py FOLDER`; it writes session.csv, shaking.csv and relaxation.csv
there, the same bytes each time.  Nothing in them was measured.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import zwidth as zw

STEP = 2e-5
"""One encoder count [m]."""


def session(path: Path) -> None:
    """Ten seconds of strokes, slow and quick; a load cell with 0.03 N of noise, its zero 0.02 N off."""
    rng = np.random.default_rng(4)
    paddle = zw.Device(mass="36 g", damping=0.15, coulomb_friction=0.12, resolution=STEP, rate="1 kHz")
    hand = np.concatenate([_strokes(0.8, 4, rng), _strokes(0.25, 24, rng)])[:10_001] - 1  # 1 m from the wall
    operator = zw.operators.Tracking(hand, stiffness=300, damping=0)
    trace = zw.simulate(paddle, zw.Wall(1), operator, 10, initial_position=hand[0])
    position = np.rint((trace["measured_position"].values + 1) / STEP) * STEP
    force = trace["hand_force"].values + 0.02 + rng.normal(0, 0.03, position.size)
    table = np.column_stack([trace["time"].values, 1e3 * position, force])[:10_000]
    _write(path, table, "time_s,position_mm,hand_force_N", ("%.3f", "%.2f", "%.2f"))


def shaking(path: Path) -> None:
    """1.2 s of a wheel let go off centre: its spring comes 3 ms later than wheel.toml says."""
    step = 2 * np.pi / 65536
    wheel = zw.Device(
        motion="rotary", mass=0.006, damping=0.02, coulomb_friction=0.05, resolution=step, rate="1 kHz",
        delay="3.3 ms", force_limit=12,
    )  # fmt: skip
    centring = zw.PulseTransferFunction([20], [1])
    trace = zw.simulate(
        wheel, centring, zw.operators.ConstantForce(force=0.01), 1.6, initial_position=0.15, encoder_phase=0.4
    )
    trace = trace.isel(time=slice(300, 1500))
    columns = (np.rad2deg(trace["measured_position"]), trace["commanded_force"], trace["actuator_force"])
    table = np.column_stack([trace["time"].values, *map(np.asarray, columns)])
    names = "time_s,angle_deg,commanded_torque_N_m,motor_torque_N_m"
    _write(path, table, names, ("%.3f", "%.4f", "%.4f", "%.4f"))


def relaxation(path: Path) -> None:
    """A probe is pushed 5 mm into soft tissue within 50 ms and held for 4 s; 0.01 N of noise."""
    rng = np.random.default_rng(7)
    time = 0.005 * np.arange(811)
    position = 2.5e-3 * (1 - np.cos(np.pi * np.clip(time / 0.05, 0, 1)))
    tissue = zw.StandardLinearSolid(310, 145, 60)
    force = zw.tissue.force_response(tissue, time, position) + rng.normal(0, 0.01, time.size)
    table = np.column_stack([time, 1e3 * position, force])
    _write(path, table, "time_s,position_mm,force_N", ("%.3f", "%.4f", "%.3f"))


def _strokes(duration: float, many: int, rng: np.random.Generator) -> NDArray[np.float64]:
    """Half a cosine from one turning point to the next, some 5 cm apart, lengths and times varied [m]."""
    ends = 0.025 * (-1.0) ** np.arange(many + 1) * np.exp(0.15 * rng.normal(size=many + 1))
    samples = np.rint(1000 * duration * np.exp(0.15 * rng.normal(size=many))).astype(int)
    return np.concatenate(
        [
            here + (there - here) * (1 - np.cos(np.pi * np.arange(n) / n)) / 2
            for here, there, n in zip(ends, ends[1:], samples, strict=False)
        ]
    )


def _write(path: Path, table: NDArray[np.float64], names: str, formats: tuple[str, ...]) -> None:
    head = f"# Simulated by examples/sample_logs.py of zwidth, not measured\n{names}"
    np.savetxt(path, table, delimiter=",", header=head, comments="", fmt=formats, newline="\n")


if __name__ == "__main__":
    folder = Path(sys.argv[1])
    session(folder / "session.csv")
    shaking(folder / "shaking.csv")
    relaxation(folder / "relaxation.csv")
