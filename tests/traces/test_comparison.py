"""Traces beside each other."""

from __future__ import annotations

import numpy as np
import pytest

import zwidth as zw


def test_the_numbers_are_those_of_the_traces(dowel, finger) -> None:
    rows = zw.traces.compare_traces({"dowel": dowel, "finger": finger}).rows
    assert rows["dowel"]["deepest_position"] == dowel.position.values.max()
    assert rows["finger"]["peak_actuator_force"] == finger.actuator_force.values.max()
    assert rows["dowel"]["energy_extracted"] == pytest.approx((-dowel.hand_work.values).max())
    inside = dowel.measured_position.values > 0
    assert rows["dowel"]["contacts"] == np.count_nonzero(inside[1:] > inside[:-1])
    last = finger.position.values[-(1 + finger.sizes["time"] // 4) :]
    assert rows["finger"]["last_swing"] == last.max() - last.min()


def test_chatter_is_what_is_quicker_than_30_hz() -> None:
    """A force of 2 N + 0.3 N at 10 Hz + 0.4 N at 100 Hz has a chatter of 0.4/√2 N."""
    t = np.arange(1001) / 1000
    force = 2 + 0.3 * np.sin(2 * np.pi * 10 * t) + 0.4 * np.sin(2 * np.pi * 100 * t)
    device = zw.Device(mass=0.1, damping=0.1, rate=1000)
    trace = zw.simulate(device, zw.Wall(1000.0), zw.operators.PrescribedMotion(force / 1000), 1.0)
    chatter = zw.traces.compare_traces(trace).rows.popitem()[1]["chatter"]
    assert chatter == pytest.approx(0.4 / np.sqrt(2), rel=2e-2)


def test_the_dowel_chatters_and_the_finger_does_not(dowel, finger) -> None:
    rows = zw.traces.compare_traces({"dowel": dowel, "finger": finger}).rows
    assert rows["dowel"]["energy_extracted"] > 0 >= rows["finger"]["energy_extracted"]
    assert rows["dowel"]["chatter"] > 20 * rows["finger"]["chatter"]
    assert rows["finger"]["last_swing"] < 1e-4 < rows["dowel"]["last_swing"]


def test_it_shows_itself_everywhere(dowel, finger) -> None:
    comparison = zw.traces.compare_traces(dowel, finger)
    assert "deepest [m]" in repr(comparison)
    assert comparison._repr_html_().startswith("<table>")
    assert comparison.to_xarray().deepest_position.attrs["units"] == "m"
    assert "peak_actuator_force_N" in next(iter(comparison.to_dict().values()))
    assert len(comparison.rows) == 2
    assert len(zw.traces.compare_traces(dowel, dowel).rows) == 2  # no label is shared


def test_what_cannot_be_compared_is_refused(dowel, knob) -> None:
    with pytest.raises(zw.InputError, match="one trace at least"):
        zw.traces.compare_traces()
    with pytest.raises(zw.InputError, match="rotary"):
        zw.traces.compare_traces(dowel, knob)
    with pytest.raises(zw.InputError, match="lacks hand_work"):
        zw.traces.compare_traces(dowel.drop_vars("hand_work"))
