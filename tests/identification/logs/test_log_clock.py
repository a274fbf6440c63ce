"""The clock of a log: its period, jitter, lost and repeated samples, recordings one after the other."""

from __future__ import annotations

import numpy as np
import pytest
from strategies import seeds

import zwidth as zw
from zwidth.data.logs.table import BLOCK_SIZE


def kinds(log: zw.Log) -> set[str]:
    """The findings in a word each."""
    return {finding.kind for finding in log.findings}


def said(log: zw.Log, kind: str) -> str:
    """The sentence of one finding."""
    return next(f.text for f in log.findings if f.kind == kind)


def drift(count: int) -> np.ndarray:
    """[m] a position without steps."""
    return np.cumsum(np.random.default_rng(2).normal(0, 1e-5, count))


def test_even_stamps_are_the_time(recording) -> None:
    """A clean log comes back as it is, in one run, with nothing odd."""
    log = zw.Log.from_arrays(time=recording.time, position=recording.position, hand_force=recording.force)
    blocks = list(log.blocks())
    assert (log.sample_period, log.samples, log.runs, log.motion) == (1 / 2000, 4000, 1, "linear")
    assert log.channels == ("hand_force",)
    assert kinds(log) == {"sample period", "resolution"}
    assert np.abs(blocks[0].time - recording.time).max() < 1e-15
    assert np.abs(blocks[0].position - recording.position).max() < 1e-17
    assert (blocks[0].hand_force == recording.force).all()
    assert blocks[0].actuator_force is None
    assert log.duration == 2.0


def test_blocks_may_be_read_twice_and_are_no_longer_than_said() -> None:
    """Several passes see the same; a long run is cut into blocks that follow each other."""
    count = 2 * BLOCK_SIZE + 1000
    log = zw.Log.from_arrays(time=np.arange(count) * 1e-3, position=drift(count))
    first, second = list(log.blocks()), list(log.blocks())
    assert [b.time.size for b in first] == [b.time.size for b in second]
    assert max(b.time.size for b in first) <= BLOCK_SIZE
    assert {b.run for b in first} == {0}
    time = np.concatenate([b.time for b in first])
    assert np.abs(np.diff(time) - 1e-3).max() < 1e-9


@pytest.mark.parametrize("spread", [2e-5, 1.5e-4, 4e-4])
def test_jitter_of_the_stamps_is_said_and_the_row_is_the_clock(spread: float) -> None:
    """Stamps within ± spread of an even grid of 0.5 ms: no sample is missing, the times are even."""
    count = 20000
    late = np.random.default_rng(3).uniform(0, spread, count)
    log = zw.Log.from_arrays(time=np.arange(count) * 5e-4 + late, position=drift(count))
    (block,) = log.blocks()
    assert log.runs == 1
    assert {"jitter", "grouped stamps"} & kinds(log)
    assert log.sample_period == pytest.approx(5e-4, rel=1e-5)
    assert np.abs(np.diff(block.time) - log.sample_period).max() < 1e-14
    assert abs(block.time[0] - 0.5 * spread) < spread


def test_a_late_stamp_is_no_lost_sample_and_a_lost_sample_is() -> None:
    """One stamp late by 0.8 T changes nothing; one row taken out makes a new run."""
    time = np.arange(5000) * 1e-3
    time[1234] += 8e-4
    log = zw.Log.from_arrays(time=time, position=drift(5000))
    assert log.runs == 1
    assert "gap" not in kinds(log)
    lost = zw.Log.from_arrays(time=np.delete(time, 3210), position=drift(4999))
    assert lost.runs == 2
    assert next(f for f in lost.findings if f.kind == "gap").samples == 1
    assert [b.time.size for b in lost.blocks()] == [3210, 1789]
    second = list(lost.blocks())[1]
    assert second.time[0] == pytest.approx(3.211)


def test_gaps_on_the_border_of_a_piece_are_found() -> None:
    """The same cuts wherever a gap falls in what is read at once."""
    count = 2 * BLOCK_SIZE
    for place in (BLOCK_SIZE - 1, BLOCK_SIZE, BLOCK_SIZE + 1):
        time = np.delete(np.arange(count) * 1e-3, slice(place, place + 5))
        log = zw.Log.from_arrays(time=time, position=drift(count - 5))
        assert log.runs == 2
        ends = [b.time[-1] for b in log.blocks() if b.run == 0]
        assert ends[-1] == pytest.approx((place - 1) * 1e-3)
        assert sum(b.time.size for b in log.blocks()) == count - 5


@pytest.mark.parametrize("rate", [1003, 1010, 1050, 1500, 2200])
def test_a_clock_of_milliseconds_drops_no_sample_of_a_faster_loop(rate: int) -> None:
    """Between 1 and 2 kHz stamps in whole ms come once or twice: every row is a sample."""
    log = zw.Log.from_arrays(time=np.round(np.arange(20000) / rate, 3), position=drift(20000))
    assert (log.samples, log.runs) == (20000, 1)
    assert log.sample_period == pytest.approx(1 / rate, rel=1e-3)


@pytest.mark.parametrize("unit", [1e-3, 1.1e-3, 5e-3])
def test_a_coarse_clock_repeats_stamps_and_no_sample_is_left_out(unit: float) -> None:
    """3 kHz stamped by a clock that ticks every few ms: the rows are the clock, the period their mean."""
    time = np.floor(np.arange(30000) / 3000 / unit + 1e-9) * unit
    log = zw.Log.from_arrays(time=time, position=drift(30000))
    assert log.runs == 1
    assert log.samples == 30000
    assert log.sample_period == pytest.approx(1 / 3000, rel=1e-3)
    assert "grouped stamps" in kinds(log)


def test_packets_of_samples_are_stamped_when_they_arrive() -> None:
    """Eight samples with the stamps of their packet; a lost packet still shows."""
    arrival = np.repeat(np.arange(7, 40000, 8) / 4000, 8) + np.tile(np.arange(8) * 1e-7, 5000)
    log = zw.Log.from_arrays(time=arrival, position=drift(40000))
    assert log.runs == 1
    assert log.sample_period == pytest.approx(1 / 4000, rel=1e-3)
    fewer = np.delete(arrival, slice(16000, 16800))
    assert zw.Log.from_arrays(time=fewer, position=drift(fewer.size)).runs == 2


def test_a_row_written_twice_is_left_out(recording) -> None:
    """Its stamp comes twice, the clock goes on: one of the two is dropped, the run goes on."""
    rows = np.sort(np.append(np.arange(4000), [700, 2500]))
    log = zw.Log.from_arrays(time=recording.time[rows], position=recording.position[rows])
    (block,) = log.blocks()
    assert next(f for f in log.findings if f.kind == "repeated").samples == 2
    assert np.abs(block.position - recording.position).max() < 1e-17


def test_time_that_starts_again_is_a_new_run(recording) -> None:
    """Recordings one after the other in one file, each from its own zero."""
    log = zw.Log.from_arrays(time=np.tile(recording.time, 3), position=np.tile(recording.position, 3))
    assert log.runs == 3
    assert "restart" in kinds(log)
    assert [b.time[0] for b in log.blocks()] == [0.0, 0.0, 0.0]


def test_time_that_goes_back_otherwise_is_refused(recording) -> None:
    """A clock set back by 0.3 s in the middle of a recording: nobody knows which samples follow which."""
    time = recording.time.copy()
    time[3000:] -= 0.3
    with pytest.raises(zw.InputError, match="goes back"):
        zw.Log.from_arrays(time=time, position=recording.position)


def test_another_rate_in_the_middle_is_refused() -> None:
    """2 kHz, then 1 kHz, or 2 kHz and then 2.1 kHz."""
    first = np.arange(20000) / 2000
    for period in (1e-3, 1 / 2100):
        time = np.append(first, first[-1] + period * np.arange(1, 20000))
        with pytest.raises(zw.InputError, match="period"):
            zw.Log.from_arrays(time=time, position=drift(time.size))


def test_stamps_without_a_clock_are_refused() -> None:
    """Samples at random instants are no sampled signal."""
    time = np.cumsum(np.random.default_rng(1).uniform(0, 0.01, 20000))
    with pytest.raises(zw.InputError, match="no common period"):
        zw.Log.from_arrays(time=time, position=drift(20000))


def test_a_stated_rate_is_held_against_the_stamps(recording) -> None:
    """Equal: silent; off by 0.5 %: reported and used; off by 5 %: refused."""
    x = recording.position
    assert "stated period" not in kinds(
        zw.Log.from_arrays(time=recording.time, position=x, sample_rate="2 kHz")
    )
    log = zw.Log.from_arrays(time=recording.time * 1.005, position=x, sample_rate="2 kHz")
    assert "+0.5 %" in said(log, "stated period")
    assert log.sample_period == 5e-4
    with pytest.raises(zw.InputError, match="stated are"):
        zw.Log.from_arrays(time=recording.time * 1.05, position=x, sample_rate="2 kHz")


def test_without_time_the_rate_is_needed_and_is_the_clock(recording) -> None:
    """A row has no other clock than its number."""
    log = zw.Log.from_arrays(position=recording.position, sample_period="0.5 ms")
    (block,) = log.blocks()
    assert np.abs(block.time - recording.time).max() < 1e-15
    with pytest.raises(zw.InputError, match="sample_rate"):
        zw.Log.from_arrays(position=recording.position)
    with pytest.raises(zw.InputError, match="say the same"):
        zw.Log.from_arrays(position=recording.position, sample_period=1e-3, sample_rate=1000)


@pytest.mark.parametrize("dtype", ["float64", "datetime64[ns]", "int64"])
def test_dates_are_counted_from_the_first(dtype: str, recording) -> None:
    """Seconds since 1970 have no room for microseconds; their differences have."""
    nanoseconds = 1_700_000_000_123_456_789 + np.rint(recording.time * 1e9).astype(np.int64)
    if dtype == "float64":
        log = zw.Log.from_arrays(time=nanoseconds / 1e9, position=recording.position)
    elif dtype == "int64":
        log = zw.Log.from_arrays(time=nanoseconds, position=recording.position, scale={"time": 1e-9})
    else:
        log = zw.Log.from_arrays(time=nanoseconds.astype(dtype), position=recording.position)
    (block,) = log.blocks()
    assert log.sample_period == pytest.approx(5e-4, rel=1e-9)
    assert np.abs(block.time - recording.time).max() < (1e-6 if dtype == "float64" else 1e-12)
    assert "dates" in kinds(log)


def test_rows_without_a_number_cut_the_run(recording) -> None:
    """NaN and infinity in any column that is used: left out, counted apart, a new run after them."""
    x, f = recording.position.copy(), recording.force.copy()
    x[100:110], f[2000] = np.nan, np.inf
    log = zw.Log.from_arrays(time=recording.time, position=x, hand_force=f)
    assert {f.kind: f.samples for f in log.findings if f.samples} == {"missing": 10, "infinite": 1, "gap": 11}
    assert [b.time.size for b in log.blocks()] == [100, 1890, 1999]
    mostly = np.where(np.arange(4000) % 3 == 0, recording.force, np.nan)
    with pytest.raises(zw.InputError, match="different rates"):
        zw.Log.from_arrays(time=recording.time, position=x, hand_force=mostly)


@seeds(12)
def test_every_gap_is_found_behind_jitter(seed: int) -> None:
    """Gaps of any length, wherever they fall, and stamps off by up to T/5: runs as they were.

    Times are too, to within a sample: a period that such stamps leave open is rounded.
    """
    random = np.random.default_rng(seed)
    count, period = int(random.integers(1000, 20000)), 10 ** random.uniform(-4, -2)
    kept = np.ones(count, dtype=bool)
    for start in random.integers(10, count - 60, random.integers(0, 12)):
        kept[start : start + random.integers(1, 40)] = False
    spread = random.choice([0.0, 0.02, 0.1, 0.2])
    (rows,) = np.nonzero(kept)
    stamps = (rows + spread * random.uniform(-1, 1, rows.size)) * period
    log = zw.Log.from_arrays(time=stamps, position=random.normal(size=rows.size))
    assert log.runs == 1 + np.count_nonzero(np.diff(rows) > 1)
    time = np.concatenate([b.time for b in log.blocks()])
    assert np.abs(time - rows * period).max() < period
