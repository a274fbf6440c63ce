"""How far each number of a device with a transmission may go, for both kinds of contact."""

import json

import pytest

import zwidth as zw
from zwidth.checker import judge
from zwidth.machine.servo.checkup import doctor
from zwidth.machine.servo.lateness import stiffness_cost
from zwidth.passivity.transmission import as_one_body

CABLE = zw.Transmission(stiffness=28657, handle_damping="0.09")
IDEAL = {"coulomb_friction": 0, "resolution": 0, "delay": 0}
DEVICE = zw.Device(mass="30 g", damping="0.06", rate="1 kHz", transmission=CABLE, **IDEAL)


def limit(stiffness, parameter, device=DEVICE, contact="kept"):
    return zw.limit(device, zw.Wall(stiffness), parameter, contact=contact, progress=lambda *_: None)


@pytest.mark.parametrize(
    ("parameter", "stiffness"),
    [
        ("stiffness", 125),
        ("transmission.stiffness", 125),
        ("transmission.handle_damping", 125),
        ("transmission.damping", 150),
        ("device.damping", 125),
    ],
)
def test_both_sides_while_contact_is_kept(parameter, stiffness):
    """Close together, and each accepted by the checker."""
    bracket = limit(stiffness, parameter)
    assert bracket.relative_width < 0.01
    assert (bracket.scope.contact, bracket.scope.transmission) == ("kept", "as given")
    saved = judge(json.loads(json.dumps(bracket.to_dict())))
    assert [part.verification.valid for part in saved.parts] == [True, True]


@pytest.mark.parametrize(
    ("parameter", "stiffness", "changes"),
    [
        ("transmission.stiffness", 120, {}),
        ("transmission.damping", 120, {}),
        ("transmission.handle_damping", 120, {}),
        ("transmission.handle_damping", 120, {"damping": "0.02"}),
        ("device.damping", 20, {"damping": "0.2"}),
    ],
)
def test_every_value_is_proved(parameter, stiffness, changes):
    """Where a proof at the least value is one of all; and one newton per metre above there is a limit."""
    device = DEVICE.replace(transmission=CABLE.replace(**changes))
    contact = "kept" if changes else "made and broken"
    bracket = limit(stiffness, parameter, device, contact)
    assert bracket.every_value
    assert "every value is proved passive" in bracket.describe()
    assert bracket.proved_active is None
    assert not limit(140, parameter, device, contact).every_value


def test_what_is_proved_at_0_and_not_of_all_is_said_of_0():
    """This cable bears 125 N/m without damping inside: of more inside it nothing follows."""
    bracket = limit(125, "transmission.damping")
    assert (bracket.every_value, bracket.proved_passive) == (False, 0)


def test_a_hint_where_only_contact_that_is_kept_is_proved():
    bracket = limit(125, "transmission.stiffness", contact="made and broken")
    assert bracket.proved_passive is None
    assert "--contact kept" in bracket.describe()


def test_contact_kept_is_of_one_mass_too():
    """Of a damped wall K = 2(b − B)/T either way; beyond it the motion keeps contact."""
    paddle = zw.catalogue.device("haptic-paddle")
    bracket = zw.limit(paddle, zw.Wall(100, "0.05"), contact="kept")
    assert bracket.proved_passive <= 200 <= bracket.proved_active
    with pytest.raises(zw.InputError, match="no contact that is kept"):
        zw.limit(paddle, zw.Wall(100), contact="kept", speed=1)


def test_lateness_costs_what_holds_for_every_cable():
    """2b₁/(T + L); with the encoder at the handle that proves nothing, which is said before the wait."""
    assert stiffness_cost(as_one_body(DEVICE), zw.Wall(100), 0.0).nominal == 120
    at_handle = DEVICE.replace(transmission=CABLE.replace(encoder="handle"))
    with pytest.raises(zw.InputError, match="proves nothing where the encoder is at the handle"):
        doctor(at_handle, zw.Wall(100), duration=60)


def test_of_what_may_be_worse_with_more_it_is_said():
    """Of the cable's numbers and the motor's damping, and not of the handle's."""
    for name in ("transmission.stiffness", "transmission.damping", "device.damping"):
        bracket = limit(125, name)
        assert bracket.beyond.startswith("a larger one is not always safer: zwidth sweep --vary ")
        assert bracket.beyond.split("--vary ")[1].startswith(name.removeprefix("device.") + "=")
    assert not limit(125, "transmission.handle_damping").beyond
