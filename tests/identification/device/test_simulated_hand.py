"""A simulated hand with a damper: its force jumps at the samples, and is no mass."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import zwidth as zw
from zwidth.loop.traces.files import save_netcdf

MASS, DAMPING, COULOMB, HAND = 0.036, 0.15, 0.12, 3.0


def path(seed: int) -> np.ndarray:
    """Strokes of some 5 cm within some 0.25 s, half a cosine each, 8 s at 1 kHz [m]."""
    rng = np.random.default_rng(seed)
    ends = 0.025 * (-1.0) ** np.arange(41) * np.exp(0.15 * rng.normal(size=41))
    parts = [
        a + (b - a) * (1 - np.cos(np.pi * np.arange(n) / n)) / 2
        for a, b, n in zip(ends[:-1], ends[1:], rng.integers(180, 320, 40), strict=True)
    ]
    return np.concatenate(parts)[:8001] - 1


@pytest.fixture(scope="module")
def traces() -> list[xr.Dataset]:
    """Three logs of one paddle in a hand with 300 N/m and 3 N·s/m."""
    paddle = zw.Device(
        mass=MASS, damping=DAMPING, coulomb_friction=COULOMB, resolution="20 um", sample_period="1 ms"
    )
    found = []
    for seed in range(3):
        hand = path(seed)
        operator = zw.operators.Tracking(hand, stiffness=300, damping=HAND)
        found.append(zw.simulate(paddle, zw.Wall(1), operator, 8, initial_position=hand[0]))
    return found


def test_the_force_of_a_log_is_the_mean_of_both_sides(traces: list[xr.Dataset], tmp_path: Path) -> None:
    """From the path: c (ẋ_a after − ẋ_a before)/2 less than what the trace has; of a file too."""
    trace = traces[0]
    file = tmp_path / "hand.nc"
    save_netcdf(trace, file)
    speed = np.diff(path(0)) / 1e-3
    expected = trace["hand_force"].values[1:-1] - HAND * np.diff(speed) / 2
    for log in (zw.Log.from_arrays(trace), zw.read_log(file)):
        force = np.concatenate([block.hand_force for block in log.blocks()])
        assert force[1:-1] == pytest.approx(expected, abs=1e-7)
        assert any(finding.kind == "jumps" for finding in log.findings)


def test_a_damped_hand_adds_no_mass(traces: list[xr.Dataset]) -> None:
    """The force just after each sample would make 4 % more of it, c T/2 = 1.5 g."""
    found = zw.identify(zw.Log.concatenate([zw.Log.from_arrays(trace) for trace in traces]))
    low, high = found.estimates["mass"].interval(0.999)
    assert low < MASS < high
    assert high - low < HAND * 1e-3 / 2
