"""The last seconds of a curve: lowest and highest in equal spans of time."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from zwidth.machine.servo.live.rows import SPAN, Envelope

SPANS = 20
WIDTH = SPAN / SPANS


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
        spans.setdefault(int(time // WIDTH), []).append(value)
    newest = max(spans)
    expected = {n: of for n, of in spans.items() if newest - SPANS < n < newest}
    np.testing.assert_allclose(band.times, [(n + 0.5) * WIDTH for n in expected], rtol=1e-12)
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
