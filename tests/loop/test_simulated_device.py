"""A device that is stepped with a force of one's own: the same loop as `simulate`, the ledger closed."""

from __future__ import annotations

import subprocess
import sys
from typing import Any

import numpy as np
import pytest
import xarray as xr

import zwidth as zw

PADDLE = zw.catalogue.device("haptic-paddle")
LATE = PADDLE.replace(delay="1.3 ms", rate="1 kHz", force_limit=2)


def spring(x: float) -> float:
    """A wall of 770 N/m."""
    return 770.0 * x if x > 0.0 else 0.0


def stepped(device: zw.Device = PADDLE, **asked: Any) -> zw.simulation.SimulatedDevice:
    """A dowel on a device for 0.2 s."""
    return zw.simulation.SimulatedDevice(device, zw.operators.Dowel(), 0.2, **asked)


def assert_same(found: xr.Dataset, expected: xr.Dataset) -> None:
    """To the last bit."""
    assert set(found) == set(expected)
    for name in expected:
        assert np.array_equal(found[name].values, expected[name].values), name


@pytest.mark.parametrize(
    ("device", "asked"),
    [
        (PADDLE, {}),
        (LATE, {"points_per_sample": 2, "encoder_phase": 0.3, "initial_velocity": 0.1}),
        (
            LATE,
            {"timing": zw.simulation.Timing(lateness=1e-4, missed=0.1), "amplifier": zw.amplifiers.Ideal()},
        ),
    ],
)
def test_with_the_force_of_a_wall_it_is_the_simulation_of_that_wall(device, asked):
    expected = zw.simulate(device, zw.Wall(770), zw.operators.Dowel(), 0.2, **asked)
    found = stepped(device, stored_at_start=0.0, **asked).run(spring)
    assert_same(found, expected)
    assert found.zwidth.energy.closes
    assert found.zwidth.energy.extracted == expected.zwidth.energy.extracted


def test_force_bounding_stands_behind_it():
    law = zw.rendering.ForceBounding()
    expected = zw.simulate(PADDLE, zw.render(zw.Wall(770), law), zw.operators.Dowel(), 0.2)
    assert_same(stepped(bounding=law).run(spring), expected)
    assert not np.array_equal(stepped().run(spring).position.values, expected.position.values)


def test_a_law_with_a_state_is_stepped_by_hand():
    """A membrane that tears: read, force, read; half of it is the first half of all of it."""
    half, whole = stepped(), stepped()
    torn = False
    for touch in (half, whole):
        torn, x = False, touch.measured_position
        while not touch.finished and (touch is whole or touch.time < 0.1):
            torn = torn or x > 1e-3
            x = touch.step(0.05 if torn else spring(x))
            assert x == touch.measured_position
    assert torn
    first, all_of_it = half.trace(), whole.trace()
    assert_same(first, all_of_it.isel(time=slice(first.sizes["time"])))
    assert all_of_it.zwidth.energy.closes
    assert (whole.position, whole.velocity) == (all_of_it.position[-1], all_of_it.velocity[-1])
    assert whole.time == all_of_it.time[-1]


def test_a_script_that_does_nothing_else_has_the_ledger_too():
    script = (
        "import zwidth as zw; "
        "paddle = zw.catalogue.device('haptic-paddle'); "
        "touch = zw.simulation.SimulatedDevice(paddle, zw.operators.Dowel(), 0.01); "
        "touch.step(0.0); touch.step(0.0); assert touch.trace().zwidth.energy.closes"
    )
    assert subprocess.run([sys.executable, "-c", script], check=False).returncode == 0


def test_what_the_law_holds_is_not_supposed():
    energy = stepped().run(spring).zwidth.energy
    assert np.isnan(energy.extracted)
    assert not energy.active
    assert "stored_at_start" in energy.unknown
    assert energy.got_out > 0


def test_what_cannot_be_stepped_is_refused():
    """A force that is none, a sample too many, nothing yet, another law, less than nothing stored."""
    touch = stepped()
    with pytest.raises(zw.InputError, match="nothing has happened yet"):
        touch.trace()
    with pytest.raises(zw.InputError, match="force at 0 s must be finite"):
        touch.step(float("nan"))
    with pytest.raises(zw.InputError, match="is a number"):
        touch.step("much")
    touch.run(spring)
    with pytest.raises(zw.InputError, match="samples have their force"):
        touch.step(0.0)
    with pytest.raises(zw.InputError, match="bounding is"):
        stepped(bounding=zw.rendering.Saturation())
    with pytest.raises(zw.InputError, match="≥ 0 J"):
        stepped(stored_at_start=-1)
