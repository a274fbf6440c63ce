"""The logs that things leave which shake, as people log: rows left out, one force or both, noise."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from shaken import Run, Thing

import zwidth as zw


@dataclass(frozen=True)
class Logged:
    """A file, and what its owner knows of the device: nothing, or numbers that are somewhat wrong."""

    path: Path
    device: zw.Device | None
    columns: str
    every: int


def write_log(rng: np.random.Generator, thing: Thing, made: Run, path: Path) -> Logged:
    """Log it as people do: every sample or fewer, from the start or later, one column of force or both."""
    every = int(rng.choice([1, 1, 1, 1, 2, 3, 4]))
    frequency = _frequency(thing, made)
    while every > 1 and every * thing.period * frequency > 0.12:
        every -= 1
    start = int(made.time.size * rng.choice([0.0, 0.0, 0.3, 0.5]))
    rows = slice(start, None, every)
    which = str(rng.choice(["both", "commanded", "applied"], p=[0.75, 0.15, 0.10]))
    size = float(np.std(made.applied[-made.time.size // 3 :])) or 1.0
    noise = size * float(rng.choice([0.0, 0.003, 0.02])) * rng.normal(size=made.time.size)
    digits = int(np.ceil(-np.log10(size))) + 4
    turn = thing.motion == "rotary"
    columns = {
        "time_s": [f"{t:.6f}" for t in made.time[rows] + rng.uniform(0, 9)],
        ("angle_deg" if turn else "position_mm"): [
            f"{x:.7g}" for x in made.measured[rows] * (180 / np.pi if turn else 1e3)
        ],
    }
    unit = "_N_m" if turn else "_N"
    if which != "applied":
        columns[("commanded_torque" if turn else "commanded_force") + unit] = [
            f"{f:.{max(digits, 0)}f}" for f in made.commanded[rows]
        ]
    if which != "commanded":
        columns[("motor_torque" if turn else "motor_force") + unit] = [
            f"{f:.{max(digits, 0)}f}" for f in (made.applied + noise)[rows]
        ]
    lines = [",".join(columns), *(",".join(row) for row in zip(*columns.values(), strict=True))]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return Logged(path, _as_its_owner_knows_it(rng, thing), which, every)


def _frequency(thing: Thing, made: Run) -> float:
    last = made.velocity[-made.time.size // 3 :]
    power = np.abs(np.fft.rfft((last - last.mean()) * np.hanning(last.size)))
    return float(np.argmax(power)) / (last.size * thing.period)


def _as_its_owner_knows_it(rng: np.random.Generator, thing: Thing) -> zw.Device | None:
    about = [float(f"{rng.uniform(0.85, 1.15):.3f}") for _ in range(3)]
    if rng.random() < 0.1:
        return None
    return zw.Device(
        motion=thing.motion,  # type: ignore[arg-type]
        mass=(thing.mass + thing.handle_mass) * about[0],
        damping=thing.damping * about[1],
        coulomb_friction=thing.coulomb * about[2],
        resolution=thing.resolution,
        sample_period=thing.period,
    )
