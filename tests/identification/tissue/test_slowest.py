"""Tests of a relaxation time longer than the test: bounds from the likelihood, held against the truth."""

from __future__ import annotations

import numpy as np
import pytest

import zwidth as zw

TIME = np.linspace(0, 4, 120)
RAMP = np.clip((TIME - 0.3) / 0.3, 0, 1)
DEPTH = 0.004 * RAMP**2 * (3 - 2 * RAMP)
MODELS = ("maxwell", "standard-linear-solid")


def held(time_constant: float, seed: int = 1) -> zw.tissue.TissueTest:
    """4 s of a solid of 400 N/m and 250 N/m, with noise of 10 mN."""
    force = zw.tissue.force_response(zw.StandardLinearSolid(400, 250, 250 * time_constant), TIME, DEPTH)
    noise = np.random.default_rng(seed).normal(0, 0.01, TIME.size)
    return zw.tissue.fit_test(TIME, DEPTH, force + noise, models=MODELS)


def test_a_test_that_is_long_enough_says_nothing():
    test = held(0.8)
    assert test.slowest is None
    assert not test.doubts


@pytest.mark.parametrize("time_constant", [8.0, 100.0])
def test_the_bounds_hold_the_truth(time_constant):
    """A Maxwell body fits the second as well, and would have its own time known to a few per cent."""
    test = held(time_constant)
    slowest = test.slowest
    assert slowest.at_least < time_constant
    assert slowest.at_most is None or slowest.at_most > time_constant
    assert "hold for longer" in test.doubts[0]
    assert test.to_dict()["slowest_relaxation_time_s"]["at_least"] == slowest.at_least


def test_at_the_bound_the_likelihood_is_what_it_should_be():
    """By another road: rates on a grid, the springs and the zero by linear least squares."""
    test = held(8.0)
    zeroed = test.test.force

    def left(time_constant: float) -> float:
        branch = zw.tissue.force_response(zw.Maxwell(1, time_constant), TIME, DEPTH)
        columns = np.stack([DEPTH, branch, np.ones_like(TIME)], axis=1)
        return float(np.linalg.lstsq(columns, zeroed, rcond=None)[1][0])

    least = min(left(tau) for tau in np.geomspace(3, 40, 400))
    variance = least / (TIME.size - 4)
    for bound in (test.slowest.at_least, test.slowest.at_most):
        assert (left(bound) - least) / variance == pytest.approx(1.658**2, rel=0.03)
