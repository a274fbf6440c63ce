"""A load cell at the end of its range: it is seen, said, and nothing is concluded from such strokes."""

from __future__ import annotations

from functools import cache
from typing import Literal

import numpy as np
import pytest
from numpy.typing import NDArray
from recordings import hand_moves, paddle

import zwidth as zw
from zwidth.data.logs.sensors import Stops

Array = NDArray[np.float64]
Way = Literal["cut off", "steps of a converter", "noise behind the stop"]


def saturated(force: Array, share: float, way: Way) -> Array:
    """The force of a load cell that is at an end of its range in so many of its samples."""
    most = np.quantile(np.abs(force), 1 - share)
    cut = np.clip(force, -most, most)
    if way == "steps of a converter":
        return np.rint(cut / 0.005) * 0.005
    if way == "noise behind the stop":
        return cut + 0.002 * np.random.default_rng(0).integers(-2, 3, cut.size)
    return cut


@cache
def logged(seed: int, share: float = 0.0, way: Way = "cut off") -> zw.identification.Identified:
    """What a minute of the paddle says."""
    recording = hand_moves(paddle(), 60.0, seed)
    force = saturated(recording.hand_force, share, way) if share else recording.hand_force
    arrays = {"time": recording.time, "position": recording.position, "hand_force": force}
    return zw.identify(zw.Log.from_arrays(resolution=22.4e-6, **arrays))


@pytest.mark.parametrize("way", ["cut off", "steps of a converter", "noise behind the stop"])
def test_damping_is_what_it_was(way):
    found = logged(3, 0.1, way)
    (finding,) = [f for f in found.findings if f.kind == "saturated"]
    assert "the sensor is at the end of its range" in finding.text
    assert 0.05 * 60_000 < finding.samples < 0.11 * 60_000
    low, high = found.estimates["damping"].interval(0.99)
    assert low < 0.15 < high
    assert found.strokes < 0.7 * logged(3).strokes


def test_most_promises_keep_to_the_limit():
    promised = [2e3 * logged(seed, 0.1).estimates["damping"].interval(0.9)[0] for seed in range(2, 18)]
    assert sum(wall > 300 for wall in promised) <= 2  # of a one-sided bound of 95 %
    assert np.median(promised) > 270


def test_too_few_strokes_within_the_range_are_too_little():
    with pytest.raises(zw.InputError, match="the motion shows too little"):
        logged(0, 0.2)


def stops(*blocks: Array) -> tuple[tuple[float, float], int]:
    counted = Stops()
    for block in blocks:
        counted.take(block)
    return counted.found()


TIME = np.arange(20_000) / 1000
SINE = 3.0 * np.sin(2 * np.pi * 0.731 * TIME)
NOISE = np.random.default_rng(1).normal(size=20_000)


@pytest.mark.parametrize(
    "force",
    [
        pytest.param(SINE, id="sine"),
        pytest.param(np.rint(SINE / 0.01) * 0.01, id="fine steps"),
        pytest.param(np.rint(SINE / 0.1) * 0.1, id="coarse steps"),
        pytest.param(NOISE, id="noise"),
        pytest.param(np.rint(NOISE / 0.05), id="noise in steps"),
        pytest.param(np.maximum(SINE, 0.0), id="untouched"),
        pytest.param(np.sign(SINE), id="square"),
        pytest.param(np.zeros(100), id="none"),
        pytest.param(np.linspace(-1, 1, 20_000), id="ramp"),
    ],
)
def test_what_turns_round_is_at_no_stop(force):
    """Nor is a force that is 0 where nobody touches, or one of a few values only."""
    assert stops(force) == ((-np.inf, np.inf), 0)


def test_one_end_in_many_blocks():
    force = np.minimum(SINE + 0.01 * np.random.default_rng(2).normal(size=SINE.size), 2.5)
    whole = stops(force)
    assert whole == ((-np.inf, 2.5), int((force == 2.5).sum()))
    assert stops(*np.array_split(force, 37)) == whole
