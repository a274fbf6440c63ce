"""Where a device surely moves, and the equation of motion in means over pulses: as good as integrals."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.interpolate import BSpline

from zwidth.data.identification.device import pulses
from zwidth.data.identification.device.pulses import Strokes, find_strokes, positions, pulse, weighed

PERIOD = 1e-3


def _stroke(samples: int) -> Strokes:
    return Strokes(np.array([0]), np.array([samples]), np.array([1.0]), np.arange(samples))


@pytest.mark.parametrize("piece", [4, 10, 24])
def test_means_are_integrals_with_the_spline(piece):
    """Mean acceleration, velocity, position and force of a smooth motion, by quad and scipy's spline."""
    time = np.arange(300) * PERIOD
    w = 2 * np.pi * 7.0
    x, a = np.sin(w * time), -w * w * np.sin(w * time)
    rows = weighed(pulse(piece), x, _stroke(300), PERIOD, a, None)
    row = rows[len(rows) // 2]
    edges = row[pulses.TIME] + piece * PERIOD * np.arange(-2, 3)
    spline = BSpline.basis_element(edges, extrapolate=False)
    area, _ = quad(spline, edges[0], edges[-1])

    def mean(function):
        pairs = zip(edges, edges[1:], strict=False)
        return sum(quad(lambda t: spline(t) * function(t), *pair)[0] for pair in pairs) / area

    acceleration, velocity = mean(lambda t: -w * w * np.sin(w * t)), mean(lambda t: w * np.cos(w * t))
    for column, expected in (
        (pulses.EVEN_ACCELERATION, acceleration),
        (pulses.ODD_ACCELERATION, acceleration),
        (pulses.EVEN_VELOCITY, velocity),
        (pulses.ODD_VELOCITY, velocity),
        (pulses.FORCE, acceleration),
        (pulses.POSITION, mean(lambda t: np.sin(w * t))),
    ):
        assert row[column] == pytest.approx(expected, rel=2e-5)


def test_a_force_that_is_held_counts_from_its_sample_to_the_next():
    """A ramp that is held stands half a sample before the ramp itself; a delay moves it further."""
    time = np.arange(400) * PERIOD
    for delay in (0.0, 2.3):
        rows = weighed(pulse(8, delay), np.zeros(400), _stroke(400), PERIOD, None, time)
        late = rows[:, pulses.TIME] + rows[:, pulses.FORCE]  # the actuator's force counts negative
        assert late == pytest.approx((0.5 + delay) * PERIOD, rel=1e-3)
        assert rows[:, pulses.FORCE_SLOPE] == pytest.approx(-1.0, rel=1e-3)


def test_a_late_force_is_read_in_time():
    time, rest = np.arange(400) * PERIOD, np.zeros(400)
    late, there = (
        weighed(pulse(8, late=n), rest, _stroke(400), PERIOD, np.sin(40 * (time - n * PERIOD)), None)
        for n in (3.4, 0.0)
    )
    at = {round(row[pulses.TIME] / PERIOD): row[pulses.FORCE] for row in there}
    for row in late:
        assert row[pulses.FORCE] == pytest.approx(at[round(row[pulses.TIME] / PERIOD)], abs=1e-4)


def test_a_stroke_shorter_than_a_pulse_gives_none():
    assert len(weighed(pulse(8), np.zeros(30), _stroke(30), PERIOD, None, None)) == 0


@pytest.mark.parametrize(
    ("counts", "first", "last", "side"),
    [
        # up five and down five: from the first tick to the last, and the turn in neither
        ([0, 1, 2, 3, 4, 5, 5, 4, 3, 2, 1, 0], [1, 7], [5, 11], [1.0, -1.0]),
        # a device that has rested in the middle of its way may have stuck: nothing is said of that time
        ([*range(20), *[19] * 30, *range(19, 40)], [1, 51], [19, 70], [1.0, 1.0]),
        ([0] * 100, [], [], []),
    ],
    ids=["turns", "rests", "does not move"],
)
def test_a_stroke_is_a_row_of_ticks_in_one_direction(counts, first, last, side):
    strokes = find_strokes(np.array(counts, dtype=float))
    assert (strokes.first.tolist(), strokes.last.tolist(), strokes.side.tolist()) == (first, last, side)


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
    count = pulses.count_without_steps(np.concatenate([resting, resting + 1.0]))
    assert 4e-5 < count < 2e-4
    assert np.ptp(pulses.counted(resting, count)) <= 1
    moving = np.linspace(0.5 * count, 0.01, 5000) + resting
    assert (np.diff(pulses.counted(moving, count)) >= 0).all()
