"""The step of the encoder seen in positions, held against the stated one; counters that overflow."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr
from hypothesis import given, settings
from hypothesis import strategies as st

import zwidth as zw


def kinds(log: zw.Log) -> set[str]:
    """The findings in a word each."""
    return {finding.kind for finding in log.findings}


def walk(count: int = 3000, seed: int = 4) -> np.ndarray:
    """Counts of a hand that wanders, up to some steps a sample."""
    random = np.random.default_rng(seed)
    return np.rint(np.cumsum(np.cumsum(random.normal(0, 0.05, count)) * 0.3)).astype(int)


@settings(max_examples=40, deadline=None)
@given(st.floats(1e-8, 1e-3), st.integers(0, 50), st.floats(-1.0, 1.0))
def test_any_step_is_found(step, seed, start):
    """Whole multiples of any number, wherever the first one lies, give that number back."""
    counts = walk(seed=seed)
    log = zw.Log.from_arrays(position=counts * step + start * 400 * step, sample_rate=1000)
    assert log.resolution == pytest.approx(step, rel=1e-9)
    blocks = np.concatenate([b.position for b in log.blocks()])
    assert np.abs(blocks / log.resolution - np.rint(blocks / log.resolution)).max() < 1e-6
    assert (np.rint(np.diff(blocks) / step) == np.diff(counts)).all()


def test_a_step_is_found_behind_single_precision_and_decimals():
    x = walk() * 22.4e-6
    for position in (x.astype(np.float32), np.round(x, 6)):
        log = zw.Log.from_arrays(position=position, sample_rate=1000)
        assert log.resolution == pytest.approx(22.4e-6, rel=1e-4)


def test_positions_without_a_step_have_none():
    """Smooth numbers, also in single precision, are no encoder's; decimals are steps of their own."""
    x = np.cumsum(np.random.default_rng(0).normal(0, 1e-5, 5000))
    for position in (x, x.astype(np.float32)):
        log = zw.Log.from_arrays(position=position, sample_rate=1000)
        assert log.resolution == 0.0
        assert "no step" in kinds(log)
        assert (next(iter(log.blocks())).position == position).all()
    decimals = zw.Log.from_arrays(position=np.round(x, 6), sample_rate=1000)
    assert decimals.resolution == pytest.approx(1e-6, rel=1e-9)


@pytest.mark.parametrize(("stated", "used", "kind"), [
    ("22.4 um", 22.4e-6, "resolution"),
    ("11.2 um", 22.4e-6, "stated resolution"),
    ("44.8 um", 22.4e-6, "stated resolution"),
    ("20 um", 22.4e-6, "stated resolution"),
])  # fmt: skip
def test_a_stated_step_is_held_against_the_data(stated, used, kind):
    """What the positions do is believed, and a contradiction is said."""
    log = zw.Log.from_arrays(position=walk() * 22.4e-6, sample_rate=1000, resolution=stated)
    assert log.resolution == pytest.approx(used, rel=1e-9)
    assert kind in kinds(log)


def test_filtered_positions_stay_as_they_are():
    """A step is stated but the positions lie between: they were filtered, and are not rounded again."""
    x = np.convolve(walk() * 22.4e-6, np.full(7, 1 / 7), mode="same")
    log = zw.Log.from_arrays(position=x, sample_rate=1000, resolution="22.4 um")
    assert log.resolution == 22.4e-6
    assert "no step" in kinds(log)
    assert (next(iter(log.blocks())).position == x).all()


@pytest.mark.parametrize("bits", [10, 12, 16])
@pytest.mark.parametrize("signed", [False, True])
def test_a_counter_that_overflows_is_continued(bits, signed):
    """The jumps of nearly the full range are no motion, over borders of blocks too."""
    size = 2**bits
    motion = 0.9 * size * np.sin(np.linspace(0, 40, 600_000)) + np.linspace(0, 3 * size, 600_000)
    counts = np.rint(motion).astype(int)
    read = (counts + size // 2) % size - size // 2 if signed else counts % size
    log = zw.Log.from_arrays(position=read * 1e-5, sample_rate=1000)
    assert "overflow" in kinds(log)
    x = np.concatenate([b.position for b in log.blocks()])
    assert (np.rint(np.diff(x) / 1e-5) == np.diff(counts)).all()


def test_an_angle_that_starts_again_after_a_turn_is_continued():
    """Degrees from 0 to 360, as many encoders give them."""
    angle = np.linspace(0, 20, 5000) ** 1.5
    log = zw.Log.from_arrays(
        position=np.rint(angle / 1e-3) * 1e-3 % (2 * np.pi), sample_rate=1000, motion="rotary"
    )
    x = np.concatenate([b.position for b in log.blocks()])
    assert x[-1] - x[0] == pytest.approx(angle[-1], abs=0.01)


def test_a_large_fast_motion_is_no_overflow():
    """A jump by half the range only, or a range that the jumps do not fill, is left alone."""
    x = walk() * 1e-5
    x[1500:] += 0.55 * (x.max() - x.min())
    log = zw.Log.from_arrays(position=x, sample_rate=1000)
    assert "overflow" not in kinds(log)


@pytest.mark.parametrize(("arguments", "message"), [
    ({"position": np.full(500, 0.3)}, "never changes"),
    ({"position": walk() * 1e-5, "hand_force": np.full(3000, 1.5)}, "hand force never changes"),
    ({"position": walk() * 1e-5, "hand_force": np.ones(7)}, "as many samples"),
    ({"position": ["a", "b"]}, "list of numbers"),
    ({"position": [1.0]}, "fewer than two"),
    ({"position": np.ones((4, 4))}, "2 dimensions"),
    ({"position": walk() * 1e-5, "motion": "sideways"}, "motion"),
    ({"position": walk() * 1e-5, "resolution": "1 deg"}, "resolution"),
    ({"position": walk() * 1e-5, "resolution": -1e-6}, "resolution"),
    ({"position": walk() * 1e-5, "scale": {"positon": 2}}, "positon"),
    ({}, "position"),
])  # fmt: skip
def test_arrays_that_say_nothing_are_refused(arguments, message):
    with pytest.raises(zw.InputError, match=message):
        zw.Log.from_arrays(sample_rate=1000, **arguments)


def test_counts_per_turn_stand_for_what_a_dataset_states_itself():
    """What is typed comes before the resolution of the file, as for a resolution that is typed."""
    step = 2 * np.pi / 4096
    angle = ("time", walk() * step, {"units": "rad"})
    data = xr.Dataset({"position": angle}, attrs={"resolution_rad": 2 * step})
    log = zw.Log.from_arrays(data, counts_per_turn=4096, sample_rate=1000)
    assert log.motion == "rotary"
    assert log.resolution == pytest.approx(step, rel=1e-12)
