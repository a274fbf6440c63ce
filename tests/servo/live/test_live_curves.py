"""What is made of the rows of a loop: curves and their last seconds, deadlines missed, the line of words."""

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from live_rows import WrittenRows

from zwidth.machine.servo.live.rows import CURVES, LATENESS, SPAN, Envelope, Tally, Watched
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


SPANS = 20
EACH = SPAN / SPANS


def filled(times, values, cuts):
    envelope = Envelope(1, SPANS)
    for part in np.split(np.arange(len(times)), sorted(cuts)):
        envelope.add(times[part], values[part, None])
    return envelope


@given(
    gaps=st.lists(st.floats(1e-3, 1.3), min_size=1, max_size=80),
    cuts=st.lists(st.integers(0, 80), max_size=6),
    seed=st.integers(0, 99),
)
def test_every_span_has_its_lowest_and_highest(gaps, cuts, seed):
    """Whatever the rate and however the samples come: the spans of the last seconds, that of now left out."""
    times = np.cumsum(gaps)
    values = np.random.default_rng(seed).normal(size=len(times))
    band = filled(times, values, cuts).after(-1)
    spans = {}
    for time, value in zip(times, values, strict=True):
        spans.setdefault(int(time // EACH), []).append(value)
    newest = max(spans)
    expected = {n: of for n, of in spans.items() if newest - SPANS < n < newest}
    np.testing.assert_allclose(band.times, [(n + 0.5) * EACH for n in expected], rtol=1e-12)
    assert list(band.low[:, 0]) == [min(of) for of in expected.values()]
    assert list(band.high[:, 0]) == [max(of) for of in expected.values()]


def test_a_buzz_is_not_lost():
    """A sine of 497 Hz that one sample in each span would show as a slow wave fills its whole height."""
    times = np.arange(0, 4, 1e-3)
    envelope = filled(times, np.sin(2 * np.pi * 497 * times), [])
    low, high = envelope.drawn(8)
    known = np.isfinite(low[:, 0])
    assert known.sum() >= 3
    assert (low[known] < -0.99).all()
    assert (high[known] > 0.99).all()


def test_no_span_comes_twice():
    envelope, number, found = Envelope(1, SPANS), -1, []
    for k in range(137):
        envelope.add(np.array([0.1 * k + 0.05]), np.array([[float(k)]]))
        band = envelope.after(number)
        number = band.newest
        found += list(band.high[:, 0])
    assert found == [4.0 + 5 * i for i in range(27)]  # five samples in each span of 0.5 s


@pytest.mark.parametrize("columns", [1, 7, SPANS, 33])
def test_any_width_is_drawn(columns):
    """The first column is 10 s ago, the last is now."""
    envelope = filled(np.arange(0, 30, 0.25), np.arange(120.0), [50])
    low, high = envelope.drawn(columns)
    assert low.shape == high.shape == (columns, 1)
    assert high[-1, 0] == 119
    assert low[0, 0] == 80


def test_an_empty_envelope_draws_nothing():
    envelope = Envelope(3, SPANS)
    envelope.add(np.zeros(0), np.zeros((0, 3)))
    assert np.isnan(envelope.drawn(5)).all()
    assert len(envelope.after(-1).times) == 0


def test_what_is_no_number_hides_nothing():
    envelope = Envelope(1, SPANS)
    envelope.add(np.array([0.1, 0.2, 0.3, 0.9]), np.array([[2.0], [np.nan], [-1.0], [0.0]]))
    band = envelope.after(-1)
    assert (band.low[0, 0], band.high[0, 0]) == (-1.0, 2.0)
