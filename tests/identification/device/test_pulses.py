"""The equation of motion in means over pulses: sums as good as integrals."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.interpolate import BSpline

from zwidth.data.identification.device import pulses
from zwidth.data.identification.device.pulses import Strokes, pulse, weighed

PERIOD = 1e-3


def _spline(piece: int, centre: float) -> BSpline:
    """The cubic B-spline of unit area, by scipy."""
    knots = centre + piece * PERIOD * np.arange(-2, 3)
    return BSpline.basis_element(knots, extrapolate=False)


def _stroke(samples: int) -> Strokes:
    return Strokes(np.array([0]), np.array([samples]), np.array([1.0]), np.arange(samples))


@pytest.mark.parametrize("piece", [4, 10, 24])
def test_means_are_integrals_with_the_spline(piece):
    """Mean acceleration, velocity, position and force of a smooth motion, by quad and scipy's spline."""
    time = np.arange(300) * PERIOD
    w = 2 * np.pi * 7.0
    x, v, a = np.sin(w * time), w * np.cos(w * time), -w * w * np.sin(w * time)
    rows = weighed(pulse(piece), x, _stroke(300), PERIOD, a, None)
    row = rows[len(rows) // 2]
    spline = _spline(piece, row[pulses.TIME])
    area, _ = quad(spline, row[pulses.TIME] - 2 * piece * PERIOD, row[pulses.TIME] + 2 * piece * PERIOD)

    def mean(function):
        edges = row[pulses.TIME] + piece * PERIOD * np.arange(-2, 3)
        parts = [
            quad(lambda t: spline(t) * function(t), *edge)[0] for edge in zip(edges, edges[1:], strict=False)
        ]
        return sum(parts) / area

    acceleration = mean(lambda t: -w * w * np.sin(w * t))
    for column in (pulses.EVEN_ACCELERATION, pulses.ODD_ACCELERATION):
        assert row[column] == pytest.approx(acceleration, rel=2e-5)
    for column in (pulses.EVEN_VELOCITY, pulses.ODD_VELOCITY):
        assert row[column] == pytest.approx(mean(lambda t: w * np.cos(w * t)), rel=2e-5)
    assert row[pulses.FORCE] == pytest.approx(acceleration, rel=2e-5)
    assert row[pulses.POSITION] == pytest.approx(mean(lambda t: np.sin(w * t)), rel=2e-5)
    assert v.size == x.size


def test_a_force_that_is_held_counts_from_its_sample_to_the_next():
    """A ramp that is held stands half a sample before the ramp itself; a delay moves it further."""
    time = np.arange(400) * PERIOD
    for delay in (0.0, 2.3):
        rows = weighed(pulse(8, delay), np.zeros(400), _stroke(400), PERIOD, None, time)
        late = rows[:, pulses.TIME] + rows[:, pulses.FORCE]  # the actuator's force counts negative
        assert late == pytest.approx((0.5 + delay) * PERIOD, rel=1e-3)
        assert rows[:, pulses.FORCE_SLOPE] == pytest.approx(-1.0, rel=1e-3)


def test_a_late_force_is_read_in_time():
    """A force recorded 3.4 samples late gives the same means as one in time."""
    time = np.arange(400) * PERIOD
    late = weighed(
        pulse(8, late=3.4), np.zeros(400), _stroke(400), PERIOD, np.sin(40 * (time - 3.4e-3)), None
    )
    there = weighed(pulse(8, late=0.0), np.zeros(400), _stroke(400), PERIOD, np.sin(40 * time), None)
    at = {round(row[pulses.TIME] / PERIOD): row[pulses.FORCE] for row in there}
    for row in late:
        assert row[pulses.FORCE] == pytest.approx(at[round(row[pulses.TIME] / PERIOD)], abs=1e-4)


def test_a_stroke_shorter_than_a_pulse_gives_none():
    """No pulse reaches beyond its stroke."""
    assert len(weighed(pulse(8), np.zeros(30), _stroke(30), PERIOD, None, None)) == 0
