"""Maps of devices with a transmission: each cell as it is decided by itself, and what is between proofs."""

import json
from fractions import Fraction

import numpy as np
import pytest

import zwidth as zw
from zwidth.passivity.linear.transmission import ElasticProof, decide_elastic, holds_between
from zwidth.passivity.transmission import elastic_of
from zwidth.quantity.exact import Exact
from zwidth.study.maps.certificates import z_width_certificate
from zwidth.study.maps.request import request

CABLE = zw.Transmission(stiffness=28657, handle_mass="0.03", handle_damping="0.09")
IDEAL = {"coulomb_friction": 0, "resolution": 0, "delay": 0}
DEVICE = zw.Device(mass="30 g", damping="0.06", rate="1 kHz", transmission=CABLE, **IDEAL)
WALLS = ((0, 320), ("-0.02", "0.1"))


def holds(device, wall):
    return isinstance(decide_elastic(elastic_of(device, wall)), ElasticProof)


@pytest.mark.parametrize(
    ("changes", "velocity"),
    [
        ({}, None),
        ({"delay": "0.7 ms"}, zw.rendering.OnePole("3 ms")),
        ({"transmission": CABLE.replace(encoder="handle", damping="0.02")}, zw.rendering.Window(3)),
        ({"transmission": CABLE.replace(stiffness="5.33e6")}, None),
    ],
)
def test_each_cell_is_as_decided_by_itself(changes, velocity):
    """Of this transmission by the exact criterion, of every one by the verdict; for both encoders."""
    device = DEVICE.replace(**changes)
    found = zw.z_width(device, *WALLS, cells=(16, 6), velocity_filter=velocity)
    assert found.attrs["transmission"] == "as given"
    assert 0 < found["passive_sustained"].values.sum() < 96
    for k in found["stiffness"].values:
        for b in found["virtual_damping"].values:
            wall = zw.Wall(k, b, *(() if velocity is None else (velocity,)))
            cell = found.sel(stiffness=k, virtual_damping=b)
            assert bool(cell["passive_sustained"]) == holds(device, wall)
            verdict = zw.check(device, wall, iterate=False)
            if velocity is None or b == 0:  # a filter whose response ends: both conditions are known
                assert bool(cell["passive"]) == (verdict.scope.transmission == "any")


def test_what_each_region_is_about():
    found = zw.z_width(DEVICE, *WALLS, cells=(4, 4))
    scopes = {name: json.loads(found[name].attrs["scope"]) for name in found["region"].values}
    told = {name: (scope["contact"], scope["transmission"]) for name, scope in scopes.items()}
    assert told == {"passive": ("made and broken", "any"), "passive_sustained": ("kept", "as given")}
    assert (found["quiet"] == found["passive"]).all()
    assert float(found["free_mass"]) == pytest.approx(0.06)
    assert float(found["free_damping"]) == pytest.approx(0.15)
    assert z_width_certificate(DEVICE, found).verify()


def test_with_dry_friction_only_what_holds_for_every_transmission():
    """The exact criterion is of viscous friction and a known cable: elsewhere it is not used."""
    for device in (
        DEVICE.replace(coulomb_friction="0.01"),
        DEVICE.replace(transmission=CABLE.replace(stiffness=None)),
    ):
        found = zw.z_width(device, *WALLS, cells=(16, 6))
        assert found.attrs["transmission"] == "any"
        assert float(found["largest_stiffness"].max()) == 90
        assert (found["passive_sustained"] >= found["passive"]).all()


def test_a_hand_is_refused():
    with pytest.raises(zw.InputError, match="transmission"):
        zw.z_width(DEVICE, *WALLS, cells=(4, 4), hands={"finger": zw.operators.Finger()})


def test_another_transmission_is_another_map():
    devices = DEVICE, DEVICE.replace(transmission=CABLE.replace(encoder="handle")), DEVICE.motor_side
    digests = {request(device, *WALLS, (4, 4), None, None).layout.digest for device in devices}
    assert len(digests) == 3


def test_between_two_proofs_a_gap_is_seen():
    """With the encoder at the motor a quadratic of K may fall below 0 between two walls that hold."""
    device = DEVICE.replace(transmission=CABLE.replace(stiffness=2132))

    def elastic(stiffness):
        return elastic_of(device, zw.Wall(Exact(Fraction(stiffness))))

    def between(low, high):
        return holds_between(*(elastic(k) for k in (low, Fraction(low + high) / 2, high)))

    assert between(1, 120)
    assert between(60, Fraction("120.7"))
    assert not between(100, 5000)  # far beyond, where the criterion does not hold
    sums = [elastic(1).sums(Fraction(c)) for c in np.linspace(-0.99, 0.99, 9)]
    assert all(abs(complex(s[3])) ** 2 > float(s[2]) for s in sums)  # it opens upwards: no proof by ends
