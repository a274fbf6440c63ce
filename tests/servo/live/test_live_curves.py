"""What is made of the rows of a loop: curves, deadlines missed, and the line of words."""

from types import SimpleNamespace

import numpy as np
import pytest
from live_rows import WrittenRows

from zwidth.machine.servo.live.rows import CURVES, LATENESS, MARGIN, Tally, Watched
from zwidth.machine.servo.ring import AT, LATE, SAMPLE, WIDTH, Rows


def test_each_row_is_news_once():
    rows = WrittenRows(np.arange(100.0))
    watched = Watched(rows)
    found = []
    for count in (0, 7, 7, 8, 100):
        rows.count = count
        found.append(watched.news().rows)
    assert [len(part) for part in found] == [0, 7, 0, 1, 92]
    np.testing.assert_array_equal(np.concatenate(found), rows.table)


@pytest.mark.parametrize("motion", ["linear", "rotary"])
def test_curves_are_the_columns_and_the_margin(motion):
    """By their names, wherever they stand; the margin is friction loss less energy out."""
    rows = WrittenRows(np.arange(9.0), motion=motion)
    rows.count = 9
    x, f = ("position_rad", "force_N_m") if motion == "rotary" else ("position_m", "force_N")
    curves = dict(zip(CURVES, Watched(rows).news().curves.T, strict=True))
    names = {"position": x, "wished_force": f"wished_{f}", "force": f, "lateness": "late_s"}
    for curve, name in {**names, "energy_out": "energy_out_J", "friction_loss": "friction_loss_J"}.items():
        np.testing.assert_array_equal(curves[curve], rows.column(name))
    expected = [
        b - a for a, b in zip(rows.column("energy_out_J"), rows.column("friction_loss_J"), strict=True)
    ]
    np.testing.assert_array_equal(curves["margin"], expected)


@pytest.mark.parametrize("kept", [10**9, 3])
def test_samples_that_were_not_taken_are_missed_deadlines(kept):
    """Rows that a slow reader did not get are none; what was missed among them is counted all the same."""
    samples = np.array([0, 1, 2, 6, 7, 8, 9, 11, 12.0])
    rows = WrittenRows(samples, kept=kept, late_s=2e-4)
    watched, lateness, skipped = Watched(rows), [], 0
    for count in (2, 5, 9):
        rows.count = count
        news = watched.news()
        lateness += list(news.curves[:, LATENESS])
        skipped += news.skipped
    assert news.missed == 4
    assert skipped == (0 if kept > 9 else 1)
    late_by = [2e-4] * 9
    late_by[3], late_by[7] = 3.2e-3, 1.2e-3  # so many periods of 1 ms more
    if kept == 3:
        del late_by[5]
    np.testing.assert_allclose(lateness, late_by, rtol=1e-12)


def test_the_ring_of_a_loop_is_read_as_it_is():
    kept, written = np.zeros((64, WIDTH)), np.zeros(1, np.int64)
    ring = Rows(
        SimpleNamespace(motion="linear", tells=("current_A",)),
        kept, written, 0, period=0.5, title="", about={},
    )  # fmt: skip
    watched = Watched(ring)
    for i in range(200):
        k = i + 3 * (i >= 120)
        kept[i % 64, [SAMPLE, AT, LATE]] = k, 0.5 * k, 0.0
        written[0] = i + 1
    news = watched.news()
    assert news.missed == 3
    assert news.skipped == 200 - len(news.rows)
    assert 0 < len(news.rows) < 64
    assert news.times[-1] == 0.5 * 202


def test_the_line_says_what_was_counted():
    status = np.zeros(3000)
    status[[5, 700, 2000]] = 1
    late = np.full(3000, 4e-5)
    late[1000] = 8.5e-4
    own = {"position_m": -0.00125, "force_N": 2.5, "energy_out_J": 0.002, "friction_loss_J": 0.005}
    samples = np.arange(3000.0)
    samples[2500:] += 2
    rows = WrittenRows(samples, status=status, late_s=late, law=3.0, **own)
    watched, tally = Watched(rows), Tally(rows)
    assert tally.line == "no sample yet"
    for rows.count in range(0, 3001, 100):
        tally.add(watched.news())
    parts = tally.line.split(" · ")
    assert parts[:2] == ["serving, law 3", "at 3.0 s"]
    assert parts[2] in ("998 Hz", "998.2 Hz", "998.1 Hz", "998.3 Hz")  # 2 of 1000 samples were missed
    assert parts[3:6] == ["−1.250 mm", "+2.500 N", "margin +3.000 mJ"]
    assert parts[6:] == ["late by 40 µs, 2040 µs at most", "2 deadlines missed", "3 bad answers"]


@pytest.mark.parametrize(
    ("phase", "law", "words"), [(0, -1, "measuring"), (1, -1, "waiting"), (3, 0, "ended, law 0")]
)
def test_before_the_first_law_there_is_none_to_name(phase, law, words):
    rows = WrittenRows(np.arange(5.0), phase=float(phase), law=float(law))
    rows.count = 5
    tally = Tally(rows)
    tally.add(Watched(rows).news())
    assert tally.line.split(" · ")[0] == words


def test_the_margin_is_a_curve_of_the_hand():
    """A hand that puts in 3 mJ against friction and 1 mJ into a spring has a margin of 4 mJ."""
    rows = WrittenRows(np.arange(1.0), energy_out_J=-0.001, friction_loss_J=0.003)
    rows.count = 1
    assert Watched(rows).news().curves[0, MARGIN] == pytest.approx(0.004, rel=1e-12)
