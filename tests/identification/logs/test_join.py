"""Several logs as one."""

from __future__ import annotations

import numpy as np
import pytest

import zwidth as zw


def _log(samples=2000, period=1e-3, resolution=2e-5, force=True, shift=0.0):
    time = np.arange(samples) * period
    position = np.floor((0.01 * np.sin(12 * time + shift)) / resolution) * resolution
    return zw.Log.from_arrays(
        time=time,
        position=position,
        hand_force=np.cos(time + shift) if force else None,
        resolution=resolution,
        sample_period=period,
    )


def test_runs_follow_each_other_and_nothing_is_lost():
    """Every sample of every log is there, in runs of their own, as often as it is read."""
    logs = [_log(), _log(3000, shift=1.0), _log(2500, shift=2.0)]
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
    """Findings name the log they are of."""
    odd = _log()
    joined = zw.Log.concatenate([odd, _log(shift=1.0)])
    assert len(joined.findings) == 2 * len(odd.findings)
    assert all(finding.text.startswith("arrays: ") for finding in joined.findings)


@pytest.mark.parametrize(
    ("other", "message"),
    [
        ({"period": 2e-3}, "sample period"),
        ({"resolution": 4e-5}, "resolution"),
        ({"force": False}, "channels"),
    ],
)
def test_logs_that_differ_are_refused(other, message):
    """Another rate, encoder or sensor is another experiment."""
    with pytest.raises(zw.InputError, match=message):
        zw.Log.concatenate([_log(), _log(**other)])


def test_a_period_measured_twice_is_the_same():
    """Half a part in a thousand is a clock; two are another rate."""
    assert zw.Log.concatenate([_log(), _log(period=1.0005e-3)]).samples == 4000
    with pytest.raises(zw.InputError, match="sample period"):
        zw.Log.concatenate([_log(), _log(period=1.002e-3)])


def test_no_log_is_refused():
    """Nothing joined to nothing is no log."""
    with pytest.raises(zw.InputError, match="no log"):
        zw.Log.concatenate([])
