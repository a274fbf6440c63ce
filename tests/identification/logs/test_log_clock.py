"""The clock of a log and the step of its encoder; lost and repeated samples, counters that overflow."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr
from hypothesis import given
from hypothesis import strategies as st
from strategies import seeds

import zwidth as zw
from zwidth.data.logs.table import BLOCK_SIZE


def kinds(log: zw.Log) -> set[str]:
    return {finding.kind for finding in log.findings}


def drift(count: int) -> np.ndarray:
    """[m] a position without steps."""
    return np.cumsum(np.random.default_rng(2).normal(0, 1e-5, count))


def test_even_stamps_are_the_time(recording):
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


def test_blocks_may_be_read_twice_and_are_no_longer_than_said():
    count = 2 * BLOCK_SIZE + 1000
    log = zw.Log.from_arrays(time=np.arange(count) * 1e-3, position=drift(count))
    first, second = list(log.blocks()), list(log.blocks())
    assert [b.time.size for b in first] == [b.time.size for b in second]
    assert max(b.time.size for b in first) <= BLOCK_SIZE
    assert {b.run for b in first} == {0}
    time = np.concatenate([b.time for b in first])
    assert np.abs(np.diff(time) - 1e-3).max() < 1e-9


@pytest.mark.parametrize("spread", [2e-5, 1.5e-4, 4e-4])
def test_jitter_of_the_stamps_is_said_and_the_row_is_the_clock(spread):
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


def test_a_late_stamp_is_no_lost_sample_and_a_lost_sample_is():
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


def test_gaps_on_the_border_of_a_piece_are_found():
    count = 2 * BLOCK_SIZE
    for place in (BLOCK_SIZE - 1, BLOCK_SIZE, BLOCK_SIZE + 1):
        time = np.delete(np.arange(count) * 1e-3, slice(place, place + 5))
        log = zw.Log.from_arrays(time=time, position=drift(count - 5))
        assert log.runs == 2
        ends = [b.time[-1] for b in log.blocks() if b.run == 0]
        assert ends[-1] == pytest.approx((place - 1) * 1e-3)
        assert sum(b.time.size for b in log.blocks()) == count - 5


def packets(k: np.ndarray) -> np.ndarray:
    """Eight samples with the stamps of their packet."""
    return (k // 8 * 8 + 7) / 4000 + k % 8 * 1e-7


@pytest.mark.parametrize(
    ("stamps", "rate"),
    [
        *[((lambda k, rate=rate: np.round(k / rate, 3)), rate) for rate in (1003, 1010, 1050, 1500, 2200)],
        *[
            ((lambda k, unit=unit: np.floor(k / 3000 / unit + 1e-9) * unit), 3000)
            for unit in (1e-3, 1.1e-3, 5e-3)
        ],
        (packets, 4000),
    ],
)
def test_where_stamps_are_coarse_the_rows_are_the_clock(stamps, rate):
    """Whole ms of a loop between 1 and 2 kHz come once or twice; or a clock ticks every few ms."""
    log = zw.Log.from_arrays(time=stamps(np.arange(30_000)), position=drift(30_000))
    assert (log.samples, log.runs) == (30_000, 1)
    assert log.sample_period == pytest.approx(1 / rate, rel=1e-3)
    assert "grouped stamps" in kinds(log) or rate != 3000


def test_a_lost_packet_shows():
    arrival = np.delete(packets(np.arange(40_000)), slice(16_000, 16_800))
    assert zw.Log.from_arrays(time=arrival, position=drift(arrival.size)).runs == 2


def test_a_row_written_twice_is_left_out(recording):
    rows = np.sort(np.append(np.arange(4000), [700, 2500]))
    log = zw.Log.from_arrays(time=recording.time[rows], position=recording.position[rows])
    (block,) = log.blocks()
    assert next(f for f in log.findings if f.kind == "repeated").samples == 2
    assert np.abs(block.position - recording.position).max() < 1e-17


def test_time_that_starts_again_is_a_new_run(recording):
    log = zw.Log.from_arrays(time=np.tile(recording.time, 3), position=np.tile(recording.position, 3))
    assert log.runs == 3
    assert "restart" in kinds(log)
    assert [b.time[0] for b in log.blocks()] == [0.0, 0.0, 0.0]


@pytest.mark.parametrize(
    ("stamps", "message"),
    [
        # set back by 0.3 s in the middle of a recording: nobody knows which samples follow which
        ((lambda k: k / 2000 - 0.3 * (k >= 15_000)), "goes back"),
        ((lambda k: (k + np.maximum(k - 9999, 0)) / 2000), "period"),  # 2 kHz, then 1 kHz
        ((lambda k: np.minimum(k, 9999) / 2000 + np.maximum(k - 9999, 0) / 2100), "period"),
        ((lambda k: np.cumsum(np.random.default_rng(1).uniform(0, 0.01, k.size))), "no common period"),
    ],
    ids=["back", "half the rate", "another rate", "no clock"],
)
def test_stamps_that_are_no_clock_are_refused(stamps, message):
    with pytest.raises(zw.InputError, match=message):
        zw.Log.from_arrays(time=stamps(np.arange(20_000)), position=drift(20_000))


def test_a_stated_rate_is_held_against_the_stamps(recording):

    def stated(factor: float) -> zw.Log:
        return zw.Log.from_arrays(
            time=recording.time * factor, position=recording.position, sample_rate="2 kHz"
        )

    assert "stated period" not in kinds(stated(1))
    log = stated(1.005)
    assert "0.5 % more" in next(f.text for f in log.findings if f.kind == "stated period")
    assert log.sample_period == 5e-4
    with pytest.raises(zw.InputError, match="stated are"):
        stated(1.05)


def test_of_a_log_with_most_cut_out_the_stated_rate_is_the_clock():
    """Two tenths of each second, where nobody holds the handle: as far as the stamps say that is no clock."""
    time = (np.arange(40)[:, None] + 1e-3 * np.arange(200)).ravel()
    with pytest.raises(zw.InputError, match="where most was cut out, state it"):
        zw.Log.from_arrays(time=time, position=drift(time.size))
    log = zw.Log.from_arrays(time=time, position=drift(time.size), sample_rate="1 kHz")
    assert (log.sample_period, log.runs, log.samples) == (1e-3, 40, 8000)


def test_without_time_the_rate_is_needed_and_is_the_clock(recording):
    """A row has no other clock than its number."""
    log = zw.Log.from_arrays(position=recording.position, sample_period="0.5 ms")
    (block,) = log.blocks()
    assert np.abs(block.time - recording.time).max() < 1e-15
    with pytest.raises(zw.InputError, match="sample_rate"):
        zw.Log.from_arrays(position=recording.position)
    with pytest.raises(zw.InputError, match="say the same"):
        zw.Log.from_arrays(position=recording.position, sample_period=1e-3, sample_rate=1000)


@pytest.mark.parametrize("dtype", ["float64", "datetime64[ns]", "int64"])
def test_dates_are_counted_from_the_first(dtype, recording):
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


def test_rows_without_a_number_cut_the_run(recording):
    x, f = recording.position.copy(), recording.force.copy()
    x[100:110], f[2000] = np.nan, np.inf
    log = zw.Log.from_arrays(time=recording.time, position=x, hand_force=f)
    assert {f.kind: f.samples for f in log.findings if f.samples} == {"missing": 10, "infinite": 1, "gap": 11}
    assert [b.time.size for b in log.blocks()] == [100, 1890, 1999]
    mostly = np.where(np.arange(4000) % 3 == 0, recording.force, np.nan)
    with pytest.raises(zw.InputError, match="different rates"):
        zw.Log.from_arrays(time=recording.time, position=x, hand_force=mostly)


@seeds(12)
def test_every_gap_is_found_behind_jitter(seed):
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


def short_log(samples=2000, period=1e-3, resolution=2e-5, force=True, shift=0.0):
    time = np.arange(samples) * period
    position = np.floor((0.01 * np.sin(12 * time + shift)) / resolution) * resolution
    arrays = {"time": time, "position": position, "hand_force": np.cos(time + shift) if force else None}
    return zw.Log.from_arrays(resolution=resolution, sample_period=period, **arrays)


def test_runs_follow_each_other_and_nothing_is_lost():
    logs = [short_log(), short_log(3000, shift=1.0), short_log(2500, shift=2.0)]
    joined = zw.Log.concatenate(logs)
    assert joined.samples == 7500
    assert joined.runs == 3
    for _ in range(2):
        blocks = list(joined.blocks())
        assert [block.run for block in blocks] == [0, 1, 2]
        for block, log in zip(blocks, logs, strict=True):
            assert np.array_equal(block.position, next(log.blocks()).position)
            assert np.array_equal(block.hand_force, next(log.blocks()).hand_force)


def test_what_was_odd_is_still_said_with_where():
    odd = short_log()
    joined = zw.Log.concatenate([odd, short_log(shift=1.0)])
    assert len(joined.findings) == 2 * len(odd.findings)
    assert all(finding.text.startswith("arrays: ") for finding in joined.findings)


@pytest.mark.parametrize(
    ("logs", "message"),
    [
        ([{}, {"period": 1.002e-3}], "sample period"),  # half a part in a thousand is a clock
        ([{}, {"resolution": 4e-5}], "resolution"),
        ([{}, {"force": False}], "channels"),
        ([], "no log"),
    ],
)
def test_logs_that_differ_are_not_joined(logs, message):
    """Another rate, encoder or sensor is another experiment."""
    with pytest.raises(zw.InputError, match=message):
        zw.Log.concatenate([short_log(**each) for each in logs])
    assert zw.Log.concatenate([short_log(), short_log(period=1.0005e-3)]).samples == 4000


def walk(count: int = 3000, seed: int = 4) -> np.ndarray:
    random = np.random.default_rng(seed)
    return np.rint(np.cumsum(np.cumsum(random.normal(0, 0.05, count)) * 0.3)).astype(int)


@given(st.floats(1e-8, 1e-3), st.integers(0, 50), st.floats(-1.0, 1.0))
def test_any_step_is_found(step, seed, start):
    """Whole multiples of any number, wherever the first one lies, give that number back."""
    counts = walk(seed=seed)
    log = zw.Log.from_arrays(position=counts * step + start * 400 * step, sample_rate=1000)
    assert log.resolution == pytest.approx(step, rel=1e-9)
    blocks = np.concatenate([b.position for b in log.blocks()])
    assert np.abs(blocks / log.resolution - np.rint(blocks / log.resolution)).max() < 1e-6
    assert (np.rint(np.diff(blocks) / step) == np.diff(counts)).all()


def test_a_step_is_found_behind_single_precision_and_decimals():
    x = walk() * 22.4e-6
    for position in (x.astype(np.float32), np.round(x, 6)):
        log = zw.Log.from_arrays(position=position, sample_rate=1000)
        assert log.resolution == pytest.approx(22.4e-6, rel=1e-4)


def test_positions_without_a_step_have_none():
    """Smooth numbers, also in single precision, are no encoder's; decimals are steps of their own."""
    x = np.cumsum(np.random.default_rng(0).normal(0, 1e-5, 5000))
    for position in (x, x.astype(np.float32)):
        log = zw.Log.from_arrays(position=position, sample_rate=1000)
        assert log.resolution == 0.0
        assert "no step" in kinds(log)
        assert (next(iter(log.blocks())).position == position).all()
    decimals = zw.Log.from_arrays(position=np.round(x, 6), sample_rate=1000)
    assert decimals.resolution == pytest.approx(1e-6, rel=1e-9)


@pytest.mark.parametrize(("stated", "used", "kind"), [
    ("22.4 um", 22.4e-6, "resolution"),
    ("11.2 um", 22.4e-6, "stated resolution"),
    ("44.8 um", 22.4e-6, "stated resolution"),
    ("20 um", 22.4e-6, "stated resolution"),
])  # fmt: skip
def test_a_stated_step_is_held_against_the_data(stated, used, kind):
    """What the positions do is believed, and a contradiction is said."""
    log = zw.Log.from_arrays(position=walk() * 22.4e-6, sample_rate=1000, resolution=stated)
    assert log.resolution == pytest.approx(used, rel=1e-9)
    assert kind in kinds(log)


def test_filtered_positions_stay_as_they_are():
    """A step is stated but the positions lie between: they were filtered, and are not rounded again."""
    x = np.convolve(walk() * 22.4e-6, np.full(7, 1 / 7), mode="same")
    log = zw.Log.from_arrays(position=x, sample_rate=1000, resolution="22.4 um")
    assert log.resolution == 22.4e-6
    assert "no step" in kinds(log)
    assert (next(iter(log.blocks())).position == x).all()


@pytest.mark.parametrize("bits", [10, 12, 16])
@pytest.mark.parametrize("signed", [False, True])
def test_a_counter_that_overflows_is_continued(bits, signed):
    """The jumps of nearly the full range are no motion, over borders of blocks too."""
    size = 2**bits
    motion = 0.9 * size * np.sin(np.linspace(0, 40, 600_000)) + np.linspace(0, 3 * size, 600_000)
    counts = np.rint(motion).astype(int)
    read = (counts + size // 2) % size - size // 2 if signed else counts % size
    log = zw.Log.from_arrays(position=read * 1e-5, sample_rate=1000)
    assert "overflow" in kinds(log)
    x = np.concatenate([b.position for b in log.blocks()])
    assert (np.rint(np.diff(x) / 1e-5) == np.diff(counts)).all()


def test_an_angle_that_starts_again_after_a_turn_is_continued():
    """Degrees from 0 to 360, as many encoders give them."""
    angle = np.linspace(0, 20, 5000) ** 1.5
    log = zw.Log.from_arrays(
        position=np.rint(angle / 1e-3) * 1e-3 % (2 * np.pi), sample_rate=1000, motion="rotary"
    )
    x = np.concatenate([b.position for b in log.blocks()])
    assert x[-1] - x[0] == pytest.approx(angle[-1], abs=0.01)


def test_a_large_fast_motion_is_no_overflow():
    """A jump by half the range only, or a range that the jumps do not fill, is left alone."""
    x = walk() * 1e-5
    x[1500:] += 0.55 * (x.max() - x.min())
    log = zw.Log.from_arrays(position=x, sample_rate=1000)
    assert "overflow" not in kinds(log)


@pytest.mark.parametrize(("arguments", "message"), [
    ({"position": np.full(500, 0.3)}, "never changes"),
    ({"position": walk() * 1e-5, "hand_force": np.full(3000, 1.5)}, "hand force never changes"),
    ({"position": walk() * 1e-5, "hand_force": np.ones(7)}, "hand_force\" has 7 samples"),
    ({"position": ["a", "b"]}, "list of numbers"),
    ({"position": [1.0]}, "fewer than two"),
    ({"position": np.ones((4, 4))}, "2 dimensions"),
    ({"position": walk() * 1e-5, "motion": "sideways"}, "motion"),
    ({"position": walk() * 1e-5, "resolution": "1 deg"}, "resolution"),
    ({"position": walk() * 1e-5, "resolution": -1e-6}, "resolution"),
    ({"position": walk() * 1e-5, "scale": {"positon": 2}}, "positon"),
    ({}, "position"),
])  # fmt: skip
def test_arrays_that_say_nothing_are_refused(arguments, message):
    with pytest.raises(zw.InputError, match=message):
        zw.Log.from_arrays(sample_rate=1000, **arguments)


def test_counts_per_turn_stand_for_what_a_dataset_states_itself():
    """What is typed comes before the resolution of the file, as for a resolution that is typed."""
    step = 2 * np.pi / 4096
    angle = ("time", walk() * step, {"units": "rad"})
    data = xr.Dataset({"position": angle}, attrs={"resolution_rad": 2 * step})
    log = zw.Log.from_arrays(data, counts_per_turn=4096, sample_rate=1000)
    assert log.motion == "rotary"
    assert log.resolution == pytest.approx(step, rel=1e-12)
