"""Compensation of friction before one wall: covered by a stiffer demand, and refuted beyond it."""

from __future__ import annotations

from fractions import Fraction

import pytest

import zwidth as zw
from zwidth.model.rendering import PassivityController, SlewLimit
from zwidth.passivity.covering_wall import covering

TINY = Fraction(1, 10**9)
DEVICE = zw.Device(damping=1, coulomb_friction="0.1", resolution=0, delay=0, rate="1 kHz")
COUNTED = DEVICE.replace(resolution="1e-4")


def asked(device: zw.Device, **law: object) -> zw.Verdict:
    """A spring of 400 N/m, whose hold takes 0.2 N·s/m and an encoder of 0.1 mm 0.02 N."""
    return zw.check(device, zw.render(zw.Wall(400), zw.FrictionCompensation(**law)))


@pytest.mark.parametrize(
    ("device", "law"),
    [
        (DEVICE, {"viscous": "0.8"}),
        (DEVICE, {"coulomb": "0.1"}),
        (COUNTED, {"coulomb": "0.08"}),
        (DEVICE.replace(coulomb_friction=0), {"coulomb": "0.3", "speed": "0.5", "viscous": "0.2"}),
    ],
    ids=["C", "sign", "sign and encoder", "slope at rest"],
)
def test_both_sides_of_what_friction_pays_for(device, law):
    """C + F/v_s ≤ b − KT/2 without friction, F ≤ f_c − e of the sign of the speed."""
    verdict = asked(device, **law)
    assert verdict.outcome == "passive"
    assert verdict.certificate.verify()
    dry = "coulomb" in law and device.exact("coulomb_friction")
    assert verdict.scope.law == (("covered with less friction" if dry else "covered by a wall"),)
    first = next(iter(law))
    more = {**law, first: Fraction(law[first]) + TINY}
    assert asked(device, **more).outcome != "passive"


def test_a_line_between():
    """Friction of half of F is left: the wall has the slope of the line, the device less friction."""
    law = zw.FrictionCompensation(coulomb="0.2", speed="0.5")
    less, wall = covering(DEVICE, zw.render(zw.Wall(400), law))
    assert less.exact("coulomb_friction") == pytest.approx(0, abs=1e-11)
    assert 0 < wall.damping < Fraction("0.4")
    rubbed = DEVICE.replace(coulomb_friction=1)
    less, wall = covering(rubbed, zw.render(zw.Wall(400), law))
    assert (less.exact("coulomb_friction"), wall.damping) == (Fraction("0.8"), 0)


def test_laws_beside_it_are_added():
    """What each adds at most; with one that is not bounded, or with two of these, there is no such wall."""
    law = zw.FrictionCompensation(viscous="0.1")
    controller = PassivityController(largest_damping="0.2")
    _, wall = covering(DEVICE, zw.render(zw.Wall(400), controller, law))
    assert wall.damping.fraction == Fraction("0.3")
    assert covering(DEVICE, zw.render(zw.Wall(400), law, SlewLimit(10))) is None
    assert covering(DEVICE, zw.render(zw.Wall(400), law, law)) is None


def test_more_than_friction_is_refuted_by_a_motion():
    paddle = zw.catalogue.device("haptic-paddle")
    law = zw.FrictionCompensation(coulomb="0.5", speed="0.01")
    verdict = zw.check(paddle, zw.render(zw.Wall(20), law))
    assert verdict.outcome == "active"
    assert verdict.witness.verify()
