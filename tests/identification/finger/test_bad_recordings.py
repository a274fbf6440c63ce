"""Faulty recordings of a finger: the answer holds the truth and says so, or there is none and the cause is
named."""

from __future__ import annotations

import numpy as np
import pytest
from recordings import paddle
from scipy.signal import lfilter
from shaken import shaken

import zwidth as zw

NAMES = ("mass", "damping", "stiffness")
FINGER = (0.011, 1.9, 640.0)
STEP = FINGER[0] / (FINGER[0] + 0.036)
"""Part of a step of the actuator that the hand's force makes at once."""


@pytest.fixture(scope="module")
def arrays():
    """Fifteen seconds of a finger that trembles."""
    return shaken(paddle(), FINGER, 15.0, seed=11, tremor=0.05)


def identified(arrays, device=None, without=(), **others):
    """What a recording says, some columns replaced."""
    kept = {name: values for name, values in {**arrays, **others}.items() if name not in without}
    return zw.identification.identify_finger(
        zw.Log.from_arrays(resolution=22.4e-6, sample_period=1e-3, **kept), device
    )


def holds(found):
    """Whether every interval holds the truth."""
    intervals = [found.estimates[name].interval(0.99) for name in NAMES]
    return all(low < true < high for (low, high), true in zip(intervals, FINGER, strict=True))


def kinds(found):
    return {finding.kind for finding in found.findings}


def later(force, samples):
    return np.concatenate([np.full(samples, force[0]), force[:-samples]])


def test_a_late_load_cell_is_refused_and_its_lateness_said(arrays):
    """Three milliseconds, with and without the actuator's force."""
    late = later(arrays["hand_force"], 3)
    for without in ((), ("actuator_force",)):
        with pytest.raises(zw.InputError, match=r"recorded late, by .* ms"):
            identified(arrays, without=without, hand_force=late)


def test_a_load_cells_filter_is_refused(arrays):
    """Of the first order, two milliseconds."""
    keep = np.exp(-0.5)
    with pytest.raises(zw.InputError, match="recorded late"):
        identified(arrays, hand_force=lfilter([1 - keep], [1, -keep], arrays["hand_force"]))


@pytest.mark.parametrize("without", [(), ("actuator_force",)])
def test_a_sample_late_or_read_before_the_step(arrays, without):
    """The two look alike, and the interval of the damping holds both; that of the stiffness stays as it
    was."""
    before = arrays["hand_force"] - STEP * np.diff(arrays["actuator_force"], prepend=0.0)
    plain = identified(arrays, without=without)
    for force in (later(arrays["hand_force"], 1), before):
        found = identified(arrays, without=without, hand_force=force)
        assert "late, or read before the step" in kinds(found)
        assert holds(found)
        assert found.estimates["damping"].shift > 0.9 * FINGER[2] * 1e-3
    assert "late, or read before the step" not in kinds(plain)
    assert holds(plain)


def test_the_delay_that_is_stated_tells_the_two_apart(arrays):
    """An actuator that steps just after the sample is read before its step: nothing is late then."""
    before = arrays["hand_force"] - STEP * np.diff(arrays["actuator_force"], prepend=0.0)
    log = zw.Log.from_arrays(resolution=22.4e-6, sample_period=1e-3, **{**arrays, "hand_force": before})
    found = zw.identification.identify_finger(log, delay=1e-6)
    assert "late, or read before the step" not in kinds(found)
    assert holds(found)


def test_with_the_device_known_a_late_load_cell_is_not_needed(arrays):
    """The numbers are those without it, and a finding says why."""
    found = identified(arrays, paddle(), hand_force=later(arrays["hand_force"], 4))
    alone = identified(arrays, paddle(), without=("hand_force",))
    assert found.estimates == alone.estimates
    assert "load cell not used" in kinds(found)


def test_a_load_cell_at_its_end_stop(arrays):
    """A tenth of the samples: refused, or by the actuator where the device is known; a few: left out."""
    force = arrays["hand_force"]
    middle = np.median(force)
    ends = [np.quantile(np.abs(force - middle), 1 - share) for share in (0.1, 0.002)]
    hard, little = (np.clip(force, middle - end, middle + end) for end in ends)
    with pytest.raises(zw.InputError, match="the sensor is at the end of its range"):
        identified(arrays, hand_force=hard)
    assert "load cell not used" in kinds(identified(arrays, paddle(), hand_force=hard))
    found = identified(arrays, hand_force=little)
    assert "saturated" in kinds(found)
    assert found.pieces < identified(arrays).pieces
    assert holds(found)


@pytest.mark.parametrize(
    ("turned", "named"),
    [
        (("hand_force",), "sign of the hand force looks"),
        (("actuator_force",), "sign of the actuator force looks"),
        (("position",), "sign of the hand force and actuator force looks"),
    ],
)
def test_the_sign_that_is_turned_round_is_named(arrays, turned, named):
    """No finger pushes the harder the more it is moved away; what to type stands in the message."""
    with pytest.raises(zw.InputError, match=named) as error:
        identified(arrays, **{name: -arrays[name] for name in turned})
    assert '": "-1"}' in str(error.value)


@pytest.mark.parametrize("factor", [1e3, 1e-3])
def test_units_that_are_off_by_a_thousand(arrays, factor):
    """Two forces that do not agree; one that no hand has."""
    force = factor * arrays["hand_force"]
    with pytest.raises(zw.InputError, match="the two forces are not of one finger"):
        identified(arrays, hand_force=force)
    with pytest.raises(zw.InputError, match="most likely a unit is off by 1000"):
        identified(arrays, without=("actuator_force",), hand_force=force)


def test_holes_cost_pieces_and_nothing_else(arrays):
    """Four tenths of a second lost, twice: the stamps tell."""
    kept = np.ones(arrays["time"].size, dtype=bool)
    kept[4000:4400] = kept[9100:9500] = False
    found = identified({name: values[kept] for name, values in arrays.items()})
    assert "gap" in kinds(found)
    assert holds(found)
    assert 50 < found.pieces < 60


def test_a_zero_that_drifts_changes_nothing(arrays):
    """Two newtons in the whole recording."""
    drift = np.linspace(0.0, 2.0, arrays["time"].size)
    plain, drifting = identified(arrays), identified(arrays, hand_force=arrays["hand_force"] + drift)
    for name in NAMES:
        assert drifting.estimates[name].value == pytest.approx(plain.estimates[name].value, rel=1e-6)
