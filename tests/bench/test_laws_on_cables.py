"""Laws on a device with a transmission: touched at its handle, judged by what holds for every cable."""

import pytest

import zwidth as zw
from zwidth.study.bench.bench import standard_laws

CABLE = zw.Transmission(stiffness=28657, handle_mass="0.03", handle_damping="0.09")
IDEAL = {"coulomb_friction": 0, "resolution": 0, "delay": 0}
DEVICE = zw.Device(mass="30 g", damping="0.06", rate="1 kHz", transmission=CABLE, name="cable", **IDEAL)


@pytest.mark.parametrize(
    ("stiffness", "status", "transmission"), [(120, "passive", "any"), (250, "active", "as given")]
)
def test_a_wall_is_judged_as_check_does(stiffness, status, transmission):
    wall = zw.Wall(stiffness)
    found = zw.compare(DEVICE, wall, {"wall": wall}, progress=lambda *_: None)
    known = found.standings["wall"]
    assert (known.status, known.scope.transmission) == (status, transmission)
    series = stiffness * 28657 / (stiffness + 28657)
    assert float(found.scores["static_stiffness"].sel(law="wall")) == pytest.approx(series, rel=0.02)
    alone = "is passive on this device" if status == "passive" else "renders 120 N/m passively"
    assert alone in found.advice


def test_with_the_encoder_at_the_handle_nothing_is_proved_for_every_cable():
    wall = zw.Wall(100)
    device = DEVICE.replace(transmission=CABLE.replace(encoder="handle"))
    known = zw.compare(device, wall, {"wall": wall}, progress=lambda *_: None).standings["wall"]
    assert known.status == "undecided"
    assert "contact" in known.evidence


def test_laws_that_are_computed_from_one_mass_are_left_out():
    rigid, apart = (set(standard_laws(device, zw.Wall(100))) for device in (DEVICE.motor_side, DEVICE))
    assert {"wall", "virtual-damping", "passivity-controller", "rate-term"} <= apart < rigid
    assert "pole-matched" in rigid - apart
