"""What an observer rests on: Riccati's equation, and whether a log shakes at all."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.linalg import expm, solve_discrete_are

import zwidth as zw
from zwidth.data.identification.device.observer import exponential, power_of_2, settled, stretches

SWINGS = np.array([[0.0, 1, 0, 0], [-9, -0.3, 9, 0.1], [0, 0, 0, 1], [4, 0.1, -4, -0.2]])


def test_a_filter_settles_where_riccati_says():
    flow, unknown = expm(SWINGS * 0.1), np.diag([0.0, 0.1, 0.0, 0.2]) ** 2
    expected = solve_discrete_are(flow.T, np.eye(4)[:, :1], unknown, np.eye(1))
    assert settled(flow, unknown) == pytest.approx(expected, rel=1e-6, abs=1e-9)


def test_the_exponential_of_a_small_matrix():
    assert exponential(SWINGS) == pytest.approx(expm(SWINGS), rel=1e-12, abs=1e-12)


@pytest.mark.parametrize(("least", "power"), [(0.3, 1), (1.0, 1), (1.1, 2), (32.0, 32), (33.0, 64)])
def test_the_next_power_of_two(least, power):
    assert power_of_2(least) == power


def moved(size: float) -> zw.Log:
    """Slow strokes of 1 N and, on top, a force drawn anew every other sample."""
    time = np.arange(2000) * 1e-3
    noise = np.repeat(np.random.default_rng(1).normal(size=1000), 2)
    force = np.sin(6 * time) + size * noise
    return zw.Log.from_arrays(time=time, position=np.sin(6 * time), actuator_force=force, resolution=1e-5)


@pytest.mark.parametrize(("size", "friction", "shakes"), [(1, 0.5, True), (1, 1, False), (0.01, 0.0, False)])
def test_a_log_shakes_beyond_friction_and_beyond_its_strokes(size, friction, shakes):
    assert stretches(moved(size), 0.0, 10_000).shakes(friction) == shakes


def test_a_delay_takes_the_force_of_a_sample_before():
    late = stretches(moved(1), 1.25, 10_000)
    assert late.late * 4 == late.steps
    assert late.force[0].size == late.read[0].size + 1 == 1998
