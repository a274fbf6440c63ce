"""Where a device surely moves, and where it was between two ticks."""

from __future__ import annotations

import numpy as np

from zwidth.data.identification.device.pulses import (
    count_without_steps,
    counted,
    find_strokes,
    positions,
)


def test_a_stroke_is_a_row_of_ticks_in_one_direction():
    """Up five counts and down five: two strokes, from the first tick to the last, and the turn in neither."""
    counts = np.array([0, 1, 2, 3, 4, 5, 5, 4, 3, 2, 1, 0], dtype=float)
    strokes = find_strokes(counts)
    assert strokes.first.tolist() == [1, 7]
    assert strokes.last.tolist() == [5, 11]
    assert strokes.side.tolist() == [1.0, -1.0]


def test_a_late_tick_cuts_a_stroke():
    """A device that has rested in the middle of its way may have stuck: nothing is said of that time."""
    counts = np.concatenate([np.arange(20), np.full(30, 19), np.arange(19, 40)]).astype(float)
    strokes = find_strokes(counts)
    assert strokes.first.tolist() == [1, 51]
    assert strokes.last.tolist() == [19, 70]


def test_no_stroke_of_an_encoder_that_does_not_move():
    """Without ticks there are no strokes."""
    assert find_strokes(np.zeros(100)).first.size == 0


def test_positions_between_seldom_ticks_follow_a_parabola():
    """Half a sample before each tick the device is at an edge; in between it is where it really was."""
    time = np.arange(400.0)
    true = 3e-4 * time**2 + 0.01 * time  # counts: a tick every 3 to 40 samples
    counts = np.floor(true)
    strokes = find_strokes(counts)
    found = positions(counts, strokes)
    inside = slice(strokes.first[0] + 1, strokes.last[0] - 1)
    assert np.abs(found - true)[inside].max() < 0.15
    assert np.abs(found - true)[inside].mean() < 0.5 * np.abs(counts + 0.5 - true)[inside].mean()


def test_positions_of_a_fast_motion_are_the_middles_of_the_counts():
    """Where every sample brings a tick nothing better is known."""
    counts = np.arange(0.0, 300.0, 3.0)
    assert positions(counts, find_strokes(counts)).tolist() == (counts + 0.5).tolist()


def test_a_position_without_steps_is_counted_above_its_noise():
    """Noise makes no ticks: a hand that rests has none, one that moves has them in its direction only."""
    rng = np.random.default_rng(3)
    resting = 1e-5 * rng.normal(size=5000)
    count = count_without_steps(np.concatenate([resting, resting + 1.0]))
    assert 4e-5 < count < 2e-4
    assert np.ptp(counted(resting, count)) <= 1
    moving = np.linspace(0.5 * count, 0.01, 5000) + resting
    assert (np.diff(counted(moving, count)) >= 0).all()
