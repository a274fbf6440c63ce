"""The published fit: exact where it must be, biased where smoothing biases."""

from __future__ import annotations

import numpy as np
import pytest
from recorded_strokes import TRUE, recorded

import zwidth as zw

TIME = np.arange(1000) * 1e-3


def test_without_noise_counts_and_passes_it_finds_the_truth():
    """Least squares with differences of a finely read, slow motion gives m, b, f_c to 0.1 %."""
    arrays = next(recorded([(0.06, 0.5, 20)], np.random.default_rng(1), resolution=1e-9, noise=0.0).blocks())
    speed = np.gradient(arrays.position, 1e-3)
    force = 0.036 * np.gradient(speed, 1e-3) + 0.15 * speed + 0.12 * np.sign(speed)
    log = zw.Log.from_arrays(time=arrays.time, position=arrays.position, hand_force=force, resolution=1e-9)
    found = zw.identification.identify_published(log, passes=0)
    assert {name: getattr(found, name) for name in TRUE} == pytest.approx(TRUE, rel=1e-3)
    assert found.explained > 0.999999


def test_it_is_the_normal_equations_of_smoothed_differences():
    """The same numbers by another road: one convolution of whole counts for all passes, normal equations.

    A speed is exactly 0 in one row, where it turns: rounded, its sign would be the processor's.
    """
    log = recorded([(0.06, 0.5, 5)], np.random.default_rng(2))
    block = next(log.blocks())
    passes, kernel = 7, np.ones(1, dtype=np.int64)
    for _ in range(passes):
        kernel = np.convolve(kernel, [1, 1, 1])
    counts = np.rint(block.position / 22.4e-6).astype(np.int64)
    speed = np.convolve(
        np.convolve(np.convolve(counts, kernel, "valid"), [1, 0, -1], "valid"), kernel, "valid"
    )
    assert not speed.all()
    bend, speed, unit = np.convolve(speed, [1, 0, -1], "valid"), speed[1:-1], 22.4e-6 / 9.0**passes / 2e-3
    matrix = np.stack([bend * unit / 2e-3, speed * unit, np.sign(speed)], axis=1)
    force = block.hand_force[16:-16]
    expected = np.linalg.solve(matrix.T @ matrix, matrix.T @ force)
    found = zw.identification.identify_published(log, passes=passes)
    assert np.allclose([found.mass, found.damping, found.coulomb_friction], expected, rtol=1e-9)
    assert found.samples == len(force)
    left = force - matrix @ expected
    assert found.explained == pytest.approx(1 - np.mean(left**2) / force.var(), rel=1e-9)


def test_without_coulomb_friction_damping_is_more_than_doubled():
    """A mass and a damper call walls passive that are not: Abbott & Okamura (2005) found 0.41 for 0.15."""
    log = recorded([(0.06, 0.5, 30)], np.random.default_rng(4))
    viscous = zw.identification.identify_published(log, model="viscous")
    assert viscous.coulomb_friction is None
    assert viscous.damping > 2 * TRUE["damping"]
    assert viscous.explained < zw.identification.identify_published(log).explained


def test_runs_are_stacked_and_not_smoothed_across():
    rng = np.random.default_rng(5)
    logs = [recorded([(0.06, 0.5, 5)], rng) for _ in range(2)]
    both = zw.identification.identify_published(zw.Log.concatenate(logs), passes=5)
    each = [zw.identification.identify_published(log, passes=5) for log in logs]
    assert both.samples == each[0].samples + each[1].samples
    assert min(e.mass for e in each) <= both.mass <= max(e.mass for e in each)


STROKES = next(recorded([(0.06, 0.5, 3)], np.random.default_rng(6)).blocks())
GOOD = {"time": STROKES.time, "position": STROKES.position, "hand_force": STROKES.hand_force}


@pytest.mark.parametrize(
    ("arrays", "options", "message"),
    [
        (GOOD, {"passes": -1}, "passes"),
        (GOOD, {"passes": 2.0}, "passes"),
        (GOOD, {"passes": 5000}, "fewer passes"),
        (GOOD, {"model": "stiction"}, "model is"),
        ({"time": TIME, "position": np.sin(TIME * 20) * 0.01}, {}, "no force"),
        ({"time": TIME, "position": 0.01 * TIME, "hand_force": np.sin(TIME)}, {}, "apart"),
    ],
)
def test_bad_input_is_refused(arrays, options, message):
    log = zw.Log.from_arrays(resolution=1e-5, **arrays)
    with pytest.raises(zw.InputError, match=message):
        zw.identification.identify_published(log, **options)
