"""The wait for a deadline, and the loop that does nothing but be on time: never early, and how late."""

import threading

import numpy as np
import pytest

from zwidth.machine.servo import lateness as measured
from zwidth.machine.servo.lateness import Lateness, measure_lateness, run_turn
from zwidth.machine.servo.posix import MARGIN, margin, most_awake, now, until
from zwidth.machine.servo.priority import Answer, Granted, RealTime
from zwidth.quantity.answered import data_of

NOTHING = Granted(())


@pytest.mark.parametrize("period", [200, 2_000_000])
def test_every_sample_is_a_step_or_missed(period):
    """At 5 MHz nearly all are missed, for a step takes longer; at 500 Hz hardly any.  None is early."""
    late, told = np.full(50, -1, np.int64), np.zeros(4, np.int64)
    start = now()
    run_turn(period, 0, late, told)
    passed = now() - start
    steps, missed = int(told[0]), int(told[1])
    assert steps >= 1
    assert steps + missed >= 50
    assert (late[:steps] >= 0).all()
    assert (late[steps:] == -1).all()
    assert missed >= (late[:steps] // period).sum()
    # the last of them was due so long after the beginning
    assert passed >= (steps + missed - late[steps - 1] // period) * period - 1


def test_a_turn_ends_when_it_is_told_to():
    late, told = np.zeros(10**6, np.int64), np.zeros(4, np.int64)
    thread = threading.Thread(target=run_turn, args=(1_000_000, 0, late, told))
    thread.start()
    while told[0] < 3:
        pass
    told[3] = 1
    thread.join()
    assert 3 <= told[0] < 10**6


def test_a_quantile_is_the_lateness_that_so_many_steps_kept():
    """The least lateness that holds for at least this share of the steps: counted one by one."""
    late = np.random.default_rng(3).gamma(1.7, 2e-5, 4321)
    told = Lateness(late, 5, 0.0, NOTHING)
    for share in (0.5, 0.99, 0.999, 1.0):
        q = told.quantile(share)
        assert (late <= q).sum() >= share * len(late)
        assert (late < q).sum() < share * len(late)
    assert told.worst == told.quantile(1.0)
    document = data_of(told)
    assert document["steps"] == 4321
    assert document["missed"] == 5
    assert document["lateness_s"]["of_99_9_percent"] == told.quantile(0.999)


def _counted(monkeypatch, granted):
    """`measure_lateness` with turns that are not waited for, but counted; by the priority they asked for."""
    asked = []

    def turn(wishes, period, count, progress):
        asked.append((wishes._priority, period, count))
        progress(1.0)
        return Lateness(np.array([1e-6, 2e-6]), 1, 0.0, granted)

    monkeypatch.setattr(measured, "turn", turn)
    monkeypatch.setattr(RealTime, "__enter__", lambda self: granted)
    return asked


def test_turns_of_both_kinds_alternate(monkeypatch):
    """30 s: three of 5 s each, which see the same load; the progress ends at all of it."""
    asked, seen = _counted(monkeypatch, Granted((Answer("priority", True, "SCHED_FIFO 40"),))), []
    found = measure_lateness(2e-3, 30.0, progress=lambda done, total: seen.append((done, total)))
    kinds = [bool(priority) for priority, *_ in asked[1:]]
    assert kinds == [False, True] * 3
    assert {call[1:] for call in asked[1:]} == {(2_000_000, 2500)}
    assert found.real_time is not None
    assert len(found.ordinary.late) == 6
    assert found.real_time.missed == 3
    assert seen == [(5 * k, 30) for k in range(1, 7)]


def test_without_priority_all_turns_are_ordinary(monkeypatch):
    no = Granted((Answer("priority", False, "not permitted"),))
    asked = _counted(monkeypatch, no)
    found = measure_lateness(1e-3, 12.0)
    assert [priority for priority, *_ in asked[1:]] == [0, 0]
    assert found.real_time is None
    assert found.asked == no


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
