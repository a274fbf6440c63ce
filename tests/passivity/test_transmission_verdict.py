"""What `check` and `limit` say of a device whose motor and hand move apart."""

from __future__ import annotations

import json
from fractions import Fraction

import pytest

import zwidth as zw
from zwidth.checker import judge

CABLE = zw.Transmission(stiffness=2132, handle_damping="0.09", handle_mass="30 g")
IDEAL = {"coulomb_friction": 0, "resolution": 0, "delay": 0}
DEVICE = zw.Device(mass="30 g", damping="0.06", rate="1 kHz", transmission=CABLE, **IDEAL)


def of(**changes: object) -> zw.Device:
    return DEVICE.replace(transmission=CABLE.replace(**changes))


@pytest.mark.parametrize(
    ("device", "stiffness", "outcome", "transmission"),
    [
        (DEVICE, 120, "passive", "any"),
        (DEVICE, 120.5, "passive in contact", "as given"),
        (DEVICE, 121, "active", "as given"),
        (DEVICE.replace(coulomb_friction="0.01"), 120.5, "undecided", "as given"),
        (of(stiffness=None), 120, "passive", "any"),
        (of(stiffness=None), 121, "undecided", "as given"),
        (of(damping=("0.5", 2)), 270, "passive", "any"),
        (of(encoder="handle"), 50, "passive in contact", "as given"),
        (of(encoder="handle", stiffness=None), 1, "undecided", "as given"),
    ],
)
def test_what_is_decided(device, stiffness, outcome, transmission):
    """By what the motor feels for every cable, else exactly; and the checker accepts no other claim."""
    verdict = zw.check(device, zw.Wall(stiffness))
    assert (verdict.outcome, verdict.scope.transmission) == (outcome, transmission)
    if outcome == "undecided":
        return
    saved = json.loads(json.dumps(verdict.to_dict()))
    assert judge(saved).faults == ()
    assert all(part.verification.valid for part in judge(saved).parts)
    wrong = {**saved, "scope": {**saved["scope"], "transmission": "any"}}
    assert (transmission == "any") == all(part.verification.valid for part in judge(wrong).parts)
    with_a_word = judge({**saved, "scope": {**saved["scope"], "transmission": "loose"}})
    assert with_a_word.faults


def test_what_two_dampers_in_a_row_let_through():
    """b + c b₂/(c + b₂), exactly, and 2b/T of it."""
    verdict = zw.check(of(damping="0.18"), zw.Wall(240))
    assert (verdict.outcome, verdict.at_limit) == ("passive", True)
    assert Fraction(verdict.certificate.to_dict()["loop"]["damping_N_s_per_m"]) == Fraction(12, 100)


def test_advice_is_about_what_lacks():
    """More damping where damping lacks, more Coulomb friction where encoder steps are not covered."""
    soft = zw.check(DEVICE.replace(resolution="20 um"), zw.Wall(100))
    assert [(a.parameter, a.to) for a in soft.advice] == [("coulomb_friction", 0.001)]
    stiff = zw.check(DEVICE, zw.Wall((100, 130)))
    assert [(a.parameter, a.to) for a in stiff.advice] == [("stiffness", 120), ("damping", 0.065)]


def test_a_bracket_is_accepted_as_it_is_saved():
    bracket = zw.limit(DEVICE, zw.Wall(100))
    assert bracket.proved_passive <= 120 < 120.75 < bracket.proved_active
    saved = judge(json.loads(json.dumps(bracket.to_dict())))
    assert len(saved.parts) == 2
    assert all(part.verification.valid for part in saved.parts)


@pytest.mark.parametrize("name", ["handle_mass", "handle_coulomb_friction"])
def test_what_plays_no_part_has_no_limit(name):
    with pytest.raises(zw.InputError, match="plays no part, so it has no limit"):
        zw.limit(DEVICE, zw.Wall(100), f"transmission.{name}")


@pytest.mark.parametrize("delay", [0, "0.5 ms", "1.3 ms"])
@pytest.mark.parametrize("stiffness", [2131.8, 28657, 5.33e6])
def test_without_friction_behind_the_motor_its_own_decides(delay, stiffness):
    """Whatever the cable is: the limit is that of one mass with b₁, above it a violation that is checked."""
    between = zw.Transmission(stiffness=stiffness, handle_mass=0.03)
    device = zw.Device(mass=0.03, damping=0.06, rate=1000, delay=delay, transmission=between)
    limit = zw.check(device.motor_side, zw.Wall(stiffness=1)).max_stiffness
    below, above = (zw.check(device, zw.Wall(stiffness=limit * factor)) for factor in (0.999, 1.001))
    assert (below.outcome, below.scope.transmission) == ("passive", "any")
    assert (above.outcome, above.scope.transmission) == ("active", "as given")
    assert above.violation.verify()
    assert above.certificate is None


def test_without_friction_behind_the_motor_a_hand_gains_just_above_its_limit():
    """Replayed in the simulator, where 2b₁/T = 120 N/m."""
    between = zw.Transmission(stiffness=28657, handle_mass=0.03)
    device = zw.Device(mass=0.03, damping=0.06, rate=1000, transmission=between)
    assert zw.check(device, zw.Wall(stiffness=121.2)).witness.energy > 0
    handle = device.replace(transmission=between.replace(encoder="handle"))
    assert zw.check(handle, zw.Wall(stiffness=121.2)).outcome == "undecided"
