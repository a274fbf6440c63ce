"""Two arms that follow each other, let go apart, integrated in small steps; and the file of a logger."""

from __future__ import annotations

from pathlib import Path

import numpy as np

import zwidth as zw

PERIOD = 0.001
FINE = 8


def moved(
    *,
    stiffness: float = 20.0,
    damping: float = 0.0,
    compensation: float = 0.0,
    link: int = 0,
    late: int = 0,
    viscous: float = 0.02,
    coulomb: float = 0.005,
    limit: float = 1.0,
    seconds: float = 1.2,
) -> dict[str, np.ndarray]:
    """Columns of leader and follower [s, rad, N·m]; masses 0.01 and 0.014 kg m²."""
    steps = round(seconds / PERIOD)
    mass, step = (0.01, 0.014), PERIOD / FINE
    x, v = [0.02, 0.0], [0.0, 0.0]
    read, asked, given = (np.zeros((2, steps)) for _ in range(3))
    for k in range(steps):
        for a in (0, 1):
            read[a, k] = np.floor(x[a] / 1e-4) * 1e-4
        for a in (0, 1):
            own, before = read[a, k], read[a, max(k - 1, 0)]
            there, earlier = read[1 - a, max(k - link, 0)], read[1 - a, max(k - link - 1, 0)]
            asked[a, k] = stiffness * (own - there) + damping * ((own - before) - (there - earlier)) / PERIOD
            asked[a, k] -= compensation * np.sign(own - before)
            given[a, k] = min(max(asked[a, max(k - late, 0)], -limit), limit)
        for _ in range(FINE):
            for a in (0, 1):
                free = v[a] - step * (given[a, k] + viscous * v[a]) / mass[a]
                drop = step * coulomb / mass[a]
                v[a] = 0.0 if abs(free) <= drop else free - drop * np.sign(free)
                x[a] += step * v[a]
    columns = {"time_s": np.arange(steps) * PERIOD}
    for a, arm in enumerate(("leader", "follower")):
        columns[f"{arm}_position_rad"] = read[a]
        columns[f"{arm}_commanded_torque_N_m"] = asked[a]
        columns[f"{arm}_motor_torque_N_m"] = given[a]
    return columns


def written(path: Path, columns: dict[str, np.ndarray]) -> Path:
    table = np.column_stack(list(columns.values()))
    np.savetxt(path, table, fmt="%.7g", delimiter=",", header=",".join(columns), comments="")
    return path


def arms(**other: float) -> zw.Pair:
    numbers = {"damping": 0.02, "coulomb_friction": 0.005, "resolution": 1e-4, "motion": "rotary", **other}
    leader, follower = (zw.Device(mass=mass, sample_period=PERIOD, **numbers) for mass in (0.01, 0.014))
    return zw.Pair(leader, follower, stiffness=1)
