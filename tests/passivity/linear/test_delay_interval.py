"""A delay known only within an interval, with laws that have memory."""

from __future__ import annotations

from fractions import Fraction
from random import Random

import pytest

import zwidth as zw

PADDLE = zw.Device(damping="0.15", coulomb_friction="0.12", resolution="22.4 um", rate="1 kHz")
LAWS = {
    "damped": (zw.Wall(70, "0.03"), "0.0009"),
    "filtered": (zw.Wall(40, "0.08", zw.rendering.OnePole("0.002")), "0.0021"),
    "window": (zw.Wall(45, "0.04", zw.rendering.Window(4)), "0.0017"),
    "solid": (zw.StandardLinearSolid(50, 20, "0.3"), "0.0013"),
    "coupling": (zw.VirtualCoupling(90, "0.02", zw.Wall(300, "0.01")), "0.0006"),
    "fixed H(z)": (zw.PulseTransferFunction([40, -20], [1, "-0.3"]), "0.0013"),
}


@pytest.mark.parametrize("name", LAWS)
def test_every_delay_of_a_proved_interval_is_passive(name):
    law, longest = LAWS[name]
    verdict = zw.check(PADDLE.replace(delay=("0.0001", longest)), law, contact="kept")
    assert verdict.outcome == "passive"
    assert verdict.certificate.kind == "delays"
    assert verdict.certificate.verify()
    random = Random(7)
    for _ in range(12):
        delay = Fraction(random.randint(100, int(float(longest) * 1e6)), 10**6)
        assert zw.check(PADDLE.replace(delay=delay), law, contact="kept").outcome == "passive"


@pytest.mark.parametrize("name", LAWS)
def test_an_interval_that_reaches_too_far_is_not_proved(name):
    law, _ = LAWS[name]
    verdict = zw.check(PADDLE.replace(delay=("0.0001", "0.02")), law, contact="kept")
    assert verdict.outcome == "undecided"
    assert verdict.certificate is None


def test_a_worse_delay_between_passive_ends_is_found():
    law = zw.PulseTransferFunction([90, 0], [1, "0.8"])
    ends = ("0.001", "0.003")
    needs = [
        zw.check(PADDLE.replace(delay=d), law, contact="kept").required_damping for d in (*ends, "0.002")
    ]
    assert needs[2] > max(needs[:2])
    device = PADDLE.replace(damping=(max(needs[:2]) + needs[2]) / 2)
    assert all(zw.check(device.replace(delay=d), law, contact="kept").outcome == "passive" for d in ends)
    assert zw.check(device.replace(delay="0.002"), law, contact="kept").outcome == "active"
    assert zw.check(device.replace(delay=ends), law, contact="kept").outcome == "undecided"
