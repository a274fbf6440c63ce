"""A motor that swings on its cable: named with it where the cable is why, and not where it is not."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest

import zwidth as zw
from zwidth.model.operator.operator import LinearHand, Operator, Signals

CABLE = zw.Transmission(stiffness=2131.8, handle_mass=0.03, handle_damping=0.09, handle_coulomb_friction=0.01)
CAPSTAN = zw.Device(mass=0.03, damping=0.06, coulomb_friction=0.01, rate=1000, transmission=CABLE)
IN_ONE = zw.Device(mass=0.06, damping=0.15, coulomb_friction=0.02, rate=1000)


@dataclass(frozen=True, kw_only=True)
class Knocked(Operator):
    """A hand of 0.3 kg that holds, 3000 N/m and 0.5 N·s/m, given 0.5 m/s within one sample."""

    hand: LinearHand = LinearHand(0.3, 3000.0, 0.5)  # noqa: RUF009

    def signals(self, times):
        force = np.where(np.arange(times.size - 1) == 20, 165.0, 0.0)
        return Signals(force=force, anchor=np.zeros_like(times))

    def describe(self, motion="linear"):
        return "a hand that is knocked"


def knocked(device, stiffness, seconds=2.5):
    law = zw.PulseTransferFunction([stiffness], [1])
    return zw.simulate(device, law, Knocked(), seconds, initial_position=0.0)


def forces_of(trace, *names):
    return trace[["measured_position", *names]]


BOTH = ("commanded_force", "actuator_force")


def test_one_knock_of_what_is_promised_as_one_body():
    """276 N/m is PASSIVE of both sides in one; on the cable a passive hand takes energy without end."""
    assert zw.check(IN_ONE, zw.Wall(276)).outcome == "passive"
    assert zw.check(CAPSTAN, zw.Wall(276)).outcome == "active"
    assert zw.check(CAPSTAN, zw.Wall(110)).outcome == "passive"
    swung, rests = (knocked(CAPSTAN, k, 5) for k in (276, 110))
    taken = swung.hand_work.values
    assert taken[-1] < taken[-1001] - 1  # joules, in the last second
    assert np.ptp(rests.motor_position.values[-500:]) < 1e-6


@pytest.mark.parametrize("forces", [BOTH, BOTH[:1], BOTH[1:]])
def test_it_is_named_with_its_cable(forces):
    found = zw.diagnose(forces_of(knocked(CAPSTAN, 276), *forces), CAPSTAN)
    assert found.cause == "structural resonance"
    said = " ".join(found.evidence)
    for text in ("46.9 Hz", "held it does at 42.4 Hz", "nobody there at 60 Hz", "120.8 N/m on this cable"):
        assert text in said
    assert "120 N/m on any" in said
    assert found.change.parameter == "stiffness"
    assert found.change.to < 120
    assert found.change.outcome == "passive"


def test_the_damping_inside_that_would_do_does():
    """c = b₂ s/(b₂ − s), s = KT/2 − b₁: b₁ + c b₂/(c + b₂) is then KT/2."""
    found = zw.diagnose(forces_of(knocked(CAPSTAN, 276), *BOTH), CAPSTAN)
    assert found.evidence[-1].startswith("0.585 N·s/m of damping inside the cable")
    for c, outcome in ((0.586, "passive"), (0.5, "active")):
        damped = CAPSTAN.replace(coulomb_friction=0, transmission=CABLE.replace(damping=c))
        assert zw.check(damped, zw.Wall(276)).outcome == outcome


def test_numbers_in_intervals_are_taken_by_their_middles():
    wide = CAPSTAN.replace(damping=(0.055, 0.065), transmission=CABLE.replace(stiffness=(2000, 2300)))
    found = zw.diagnose(forces_of(knocked(CAPSTAN, 276), *BOTH), wide)
    assert found.cause == "structural resonance"
    assert found.change.to < 110


def test_a_late_force_on_a_cable_is_a_delay():
    """A stiffness that the cable bears, and a force that comes three samples late."""
    found = zw.diagnose(forces_of(knocked(CAPSTAN.replace(delay=0.003), 100), *BOTH), CAPSTAN)
    assert found.cause == "delay"
    assert found.seen.delay == pytest.approx(0.003, abs=2e-4)
    assert found.change.outcome == "passive"


def test_of_the_command_alone_a_late_force_is_not_called_the_cable():
    late = forces_of(knocked(CAPSTAN.replace(delay=0.003), 100), "commanded_force")
    found = zw.diagnose(late, CAPSTAN)
    assert found.cause is None
    assert found.record


def test_what_the_cable_bears_is_not_named_its_fault():
    assert zw.diagnose(forces_of(knocked(CAPSTAN, 110), *BOTH), CAPSTAN).cause is None


def test_what_one_body_would_not_bear_either_is_sampling():
    found = zw.diagnose(forces_of(knocked(CAPSTAN, 450, 1.5), *BOTH), CAPSTAN)
    assert found.cause == "sampling"
    assert found.change.to < 120


def test_told_as_one_piece_it_is_a_structure_and_what_to_record_is_said():
    stiff = CAPSTAN.replace(transmission=CABLE.replace(stiffness=4263.7))
    found = zw.diagnose(forces_of(knocked(stiff, 276), *BOTH), IN_ONE)
    assert found.cause == "structural resonance"
    assert "nobody at the handle, and identify both sides" in found.record[0]
    assert found.change is None
