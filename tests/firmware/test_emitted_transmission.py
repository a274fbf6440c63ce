"""A law for a device with a transmission: what its header claims, and what pays for rounding."""

from fractions import Fraction

import pytest

import zwidth as zw
from zwidth.machine.firmware.emit import NotEmitted, emit
from zwidth.machine.firmware.verdict import judged

CABLE = zw.Transmission(stiffness=2131.8, damping=0.02, handle_mass=0.03, handle_damping=0.09)
DEVICE = zw.Device(
    mass=0.03, damping=0.06, coulomb_friction=0.05, resolution=1e-5, rate=1000, transmission=CABLE
)
BARE = DEVICE.replace(transmission=CABLE.replace(damping=0))
IDEAL = BARE.replace(coulomb_friction=0, resolution=0)
TRAVEL = (-0.02, 0.02)
HANDLE = CABLE.replace(encoder="handle")


def said(found):
    return " ".join(found.text.replace("\n * ", " ").split())


def kept(device, law):
    return zw.check(device, law, contact="kept")


@pytest.mark.parametrize("number", ["double", "float", "fixed"])
def test_a_header_says_of_which_transmission_it_is_proved(number):
    found = emit(DEVICE, zw.Wall(stiffness=140), number=number, force_unit="1e-6")
    assert (found.judged.proved, found.judged.counted) == (True, True)
    assert "It holds for any stiffness between motor and hand." in said(found)
    assert found.verdict.scope.transmission == "any"


def test_what_rounding_costs_is_of_the_motor_s_friction():
    """f_c ≥ K Δ/2 is what the encoder's steps need of it."""
    coarse = DEVICE.replace(resolution="0.3 mm", coulomb_friction="0.02 N")
    found = emit(coarse, zw.Wall(stiffness=100), number="float").judged
    assert found.cost(coarse, found.verdict.environment) == pytest.approx(
        2 * found.machine.error / 3e-4, rel=1e-3
    )


def test_a_proof_of_one_transmission_leaves_rounding_out():
    """Coulomb friction changes how the motor moves: it pays for nothing there."""
    found = emit(IDEAL, zw.Wall(stiffness=120.5), travel=TRAVEL, decide=kept)
    assert not found.judged.counted
    assert "It holds for a transmission of the numbers given." in said(found)
    with pytest.raises(NotEmitted, match="proved in real numbers, not in float"):
        emit(IDEAL, zw.Wall(stiffness=120.5), travel=TRAVEL, number="float", decide=kept)


def test_friction_that_is_used_up_does_not_turn_one_proof_into_the_other():
    """Left without Coulomb friction the loop would be ideal, and passive with this very transmission."""
    law, stiff = (
        zw.Wall(stiffness=120.5),
        emit(IDEAL, zw.Wall(stiffness=120.5), travel=TRAVEL, decide=kept).machine,
    )
    dry = IDEAL.replace(coulomb_friction=Fraction(stiff.error))
    proved = zw.check(IDEAL, zw.Wall(stiffness=100))

    def decide(device, environment):
        return kept(device, environment) if device.coulomb_friction.fraction == 0 else proved

    assert kept(IDEAL, law).outcome in ("passive", "passive in contact")
    found = judged(dry, law, stiff, decide)
    assert (found.counted, "of one transmission" in found.reason) == (False, True)


def test_with_the_encoder_at_the_handle_force_bounding_is_not_proved():
    law = zw.render(zw.Wall(stiffness=100), zw.rendering.ForceBounding())
    here = DEVICE.replace(force_resolution=1e-3, force_limit=5)
    assert emit(here, law, number="float").verdict.scope.transmission == "any"
    with pytest.raises(NotEmitted, match="the encoder on the hand's side"):
        emit(here.replace(transmission=HANDLE), law, number="float")


@pytest.mark.parametrize(("stiffness", "outcome"), [(120.5, "undecided"), (300, "active")])
def test_what_a_transmission_does_not_bear_is_not_emitted(stiffness, outcome):
    with pytest.raises(NotEmitted, match=f"it is {outcome}"):
        emit(BARE, zw.Wall(stiffness=stiffness))
