"""The wait for a deadline: never early, and a margin that follows how late a sleeping thread awakes."""

import numpy as np
import pytest

from zwidth.machine.servo.posix import MARGIN, margin, most_awake, now, until

SHARE = 1 / 256


@pytest.mark.parametrize("spin", [0, 30_000, 10_000_000])
def test_nobody_awakes_before_the_deadline(spin):
    for ahead in (1_000, 150_000, 2_000_000):
        deadline = now() + ahead
        overslept = until(deadline, spin)
        assert now() >= deadline
        assert overslept >= 0


def test_a_deadline_that_is_over_is_not_waited_for():
    """Nothing was slept; and of a wait that is shorter than the margin neither."""
    assert until(now() - 1, 0) == 0
    assert until(now() + 40_000, 50_000_000) == 0


def test_the_margin_is_outlasted_by_one_sleep_in_256():
    """Whatever the law of the lateness: the quantile of 99.6 %, here of a skewed one with a long tail."""
    random = np.random.default_rng(7)
    overslept = np.rint(20_000 + 15_000 * random.standard_gamma(1.3, 60_000)).astype(np.int64)
    spin, seen, outlasted = MARGIN, [], 0
    for k, late in enumerate(overslept):
        outlasted += k >= 10_000 and late > spin
        spin = margin(spin, int(late), 500_000)
        seen.append(spin)
    assert outlasted / 50_000 == pytest.approx(SHARE, rel=0.15)
    assert np.median(seen[10_000:]) == pytest.approx(np.quantile(overslept, 1 - SHARE), rel=0.1)


def test_the_margin_stays_between_its_ends():
    """However late; and without real-time priority, where the largest is 0, all of the wait is slept."""
    spin = MARGIN
    for _ in range(100):
        spin = margin(spin, 10**9, 300_000)
    assert spin == 300_000
    for _ in range(10_000):
        spin = margin(spin, 0, 300_000)
    assert 0 < spin < 10_000
    assert margin(0, 50_000, 0) == 0


def test_only_a_loop_with_priority_watches_the_clock():
    assert 0 < most_awake(200_000, True) < 100_000
    assert most_awake(200_000, False) == 0
