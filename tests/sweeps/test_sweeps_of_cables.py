"""Sweeps over the numbers of a transmission: each loop answered as by itself."""

from functools import partial
from itertools import product

import numpy as np
import pytest

import zwidth as zw

CABLE = zw.Transmission(stiffness=28657, handle_damping="0.09")
IDEAL = {"coulomb_friction": 0, "resolution": 0, "delay": 0}
DEVICE = zw.Device(mass="30 g", damping="0.06", rate="1 kHz", transmission=CABLE, **IDEAL)
swept = partial(zw.sweep, workers=1, progress=lambda *_: None)


@pytest.mark.parametrize("contact", ["made and broken", "kept"])
def test_each_loop_is_answered_as_by_itself(contact):
    """On both sides of what holds for any cable, and of what holds for this one."""
    values = {"transmission.stiffness": [2132, 28657], "stiffness": [100, 120.5, 125, 140]}
    found = swept(DEVICE, zw.Wall(100), vary=values, contact=contact)
    assert found["transmission.stiffness"].attrs["units"] == "N/m"
    for k, wall in product(*values.values()):
        device = DEVICE.replace(transmission=CABLE.replace(stiffness=k))
        verdict = zw.check(device, zw.Wall(wall), contact=contact)
        cell = found.sel({"transmission.stiffness": k, "stiffness": wall})
        told = verdict.outcome, verdict.scope.contact, verdict.scope.transmission
        assert tuple(str(cell[n].item()) for n in ("outcome", "contact", "transmission")) == told
        assert float(cell["max_stiffness"]) == verdict.max_stiffness


def test_limits_of_each_cable():
    """That of any cable is one number, the exact one another for each."""
    of = {"of": "limit", "parameter": "stiffness", "vary": {"transmission.stiffness": [2132, 28657]}}
    any_cable = swept(DEVICE, zw.Wall(100), **of)
    assert np.ptp(any_cable["proved_passive"].values) == 0
    assert set(any_cable["transmission"].values) == {"as given"}  # so is the motion beside it
    exact = swept(DEVICE, zw.Wall(100), contact="kept", **of)
    for low, true, high in zip(
        exact["proved_passive"].values, (120.7538, 129.926), exact["proved_active"].values, strict=True
    ):
        assert low <= true <= high
        assert high - low < 0.01 * true


def test_of_one_mass_nothing_is_varied_between():
    with pytest.raises(zw.InputError, match="no number"):
        swept(DEVICE.motor_side, zw.Wall(100), vary={"transmission.stiffness": [1, 2]})
