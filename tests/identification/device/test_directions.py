"""Damping that differs by direction: a wall rests on the lesser, whether or not the difference is seen."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from numpy.typing import NDArray

import zwidth as zw
from zwidth.cli.main import main

Array = NDArray[np.float64]
PERIOD, COUNT = 1e-3, 22.4e-6


def waves(seed: int, seconds: float) -> tuple[Array, Array, Array]:
    """Position, velocity and acceleration of a hand that wanders about 20 mm to and fro."""
    rng = np.random.default_rng(seed)
    omega, phase = 2 * np.pi * rng.uniform(0.3, 4.0, 12)[:, None], rng.uniform(0, 6.28, 12)[:, None]
    amplitude = rng.normal(size=12)[:, None]
    angle = omega * np.arange(round(seconds / PERIOD)) * PERIOD + phase
    x = (amplitude * np.sin(angle)).sum(axis=0)
    v = (amplitude * omega * np.cos(angle)).sum(axis=0)
    a = -(amplitude * omega**2 * np.sin(angle)).sum(axis=0)
    scale = 0.02 / x.std()
    return x * scale, v * scale, a * scale


def recorded(seed: int, inward: float, outward: float, seconds: float = 60.0) -> zw.Log:
    """The paddle with another damping in each direction; white noise of 0.1 N on the load cell."""
    x, v, a = waves(seed, seconds)
    force = 0.036 * a + np.where(v > 0, inward, outward) * v + 0.15 * np.sign(v)
    noise = 0.1 * np.random.default_rng(seed + 1000).normal(size=x.size)
    return zw.Log.from_arrays(
        position=np.floor(x / COUNT) * COUNT,
        hand_force=force + noise,
        sample_period=PERIOD,
        resolution=COUNT,
    )


@cache
def found(seed: int, inward: float, outward: float) -> zw.identification.Identified:
    """What a minute of it says."""
    return zw.identify(recorded(seed, inward, outward))


@pytest.mark.parametrize(("inward", "outward"), [(0.26, 0.14), (0.14, 0.26)])
def test_each_direction_is_found(inward: float, outward: float) -> None:
    """In intervals that hold it, and the finding names both; Coulomb friction is the mean as before."""
    result = found(0, inward, outward)
    for estimate, true in zip(result.directions, (inward, outward, (inward - outward) / 2), strict=True):
        low, high = estimate.interval(0.999)
        assert low < true < high
        assert high - low < 0.25 * 0.26
    assert result.directions.weaker.value == pytest.approx(0.14, rel=0.1)
    low, high = result.estimates["coulomb_friction"].interval(0.999)
    assert low < 0.15 < high
    assert result.shows("damping by direction")


def test_the_wall_rests_on_the_lesser() -> None:
    """Of 12 sessions at 95 % two at most promise more than 2 · 0.14/T; by the mean of both all would."""
    results = [found(seed, 0.26, 0.14) for seed in range(12)]
    walls = [2 * float(result.device(0.9).damping.low) / PERIOD for result in results]
    assert sum(wall > 280 for wall in walls) <= 2
    assert np.median(walls) > 0.85 * 280
    assert all(2 * result.estimates["damping"].interval(0.9)[0] / PERIOD > 280 for result in results)
    best = results[0].device(None)
    assert float(best.damping) == results[0].directions.outward.value


def test_confidence_in_a_wall_between_the_two() -> None:
    """A wall that only the mean of both directions would allow is not promised."""
    result = found(1, 0.26, 0.14)
    assert result.confidence(zw.Wall(308)) < 0.5
    assert result.confidence(zw.Wall(350)) < 0.01
    assert result.confidence(zw.Wall(225)) > 0.95


def test_a_device_that_is_the_same_both_ways_loses_little() -> None:
    """Not knowing that it is costs some per cent of the promise; nothing is said of directions."""
    results = [found(seed, 0.15, 0.15) for seed in range(12)]
    share = [float(result.device(0.9).damping.low) / 0.15 for result in results]
    assert np.median(share) > 0.85
    assert sorted(share)[1] > 0.75
    assert sum(s > 1 for s in share) <= 2
    assert not any(result.shows("damping by direction") for result in results)
    assert float(results[0].device(None).damping) == results[0].estimates["damping"].value


def test_both_stand_in_every_face(tmp_path, capsys) -> None:
    """The table, the document, the file and the command."""
    result = found(0, 0.26, 0.14)
    assert "inward" in repr(result)
    assert "outward" in repr(result)
    document = result.to_dict(0.95)
    low, high = document["damping_outward_N_s_per_m"]["interval"]
    assert low < 0.14 < high
    assert document["stiffest_by_damping_N_per_m"]["interval"][0] <= 2 * low / PERIOD
    saved = tmp_path / "device.toml"
    result.save(saved, 0.99)
    assert main(["check", str(saved), "--stiffness", "300", "--contact", "kept"]) != 0
    capsys.readouterr()
    assert "inward" not in repr(found(0, 0.15, 0.15))
