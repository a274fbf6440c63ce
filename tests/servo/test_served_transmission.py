"""Motor and handle with a transmission between them, served: as they are simulated, and what is claimed."""

import numpy as np
import pytest
from played import Played

import zwidth as zw
from zwidth.machine.servo import Servo
from zwidth.machine.servo.devices import Simulated
from zwidth.machine.servo.proving import Measured, NotProved, claimed, judged, least_friction
from zwidth.machine.servo.recording import replay
from zwidth.machine.servo.recording.recording import read_recording
from zwidth.machine.servo.serving import serve

pytestmark = pytest.mark.real_time

CABLE = zw.Transmission(stiffness=2131.8, damping=0.02, handle_mass=0.03, handle_damping=0.09)
DEVICE = zw.Device(mass=0.03, damping=0.06, rate=1000, transmission=CABLE)
TOLD = {
    "true_position_m": "position",
    "true_velocity_m_per_s": "velocity",
    "position_m": "measured_position",
    "force_N": "commanded_force",
    "hand_work_J": "hand_work",
    "actuator_work_J": "actuator_work",
    "viscous_loss_J": "viscous_loss",
    "coulomb_loss_J": "coulomb_loss",
    "transmission_energy_J": "transmission_energy",
    "transmission_loss_J": "transmission_loss",
    "motor_position_m": "motor_position",
    "motor_velocity_m_per_s": "motor_velocity",
}
"""Columns of the loop, and what a trace calls them."""


def at_handle(device):
    return device.replace(transmission=device.transmission.replace(encoder="handle"))


STICKING = DEVICE.replace(coulomb_friction=0.02, resolution=1e-5, delay="0.0013")


@pytest.mark.parametrize("device", [DEVICE, at_handle(DEVICE), STICKING], ids=["motor", "handle", "dry"])
def test_served_touch_of_two_masses_is_the_simulated_one_to_the_last_bit(device):
    law, finger = zw.Wall(stiffness=90), zw.operators.Finger()
    simulated = Simulated(device=device, hand=finger, duration="0.4 s")
    with Servo(device, law, simulated) as servo:
        servo.start(anyway=True)
        servo.wait()
    told = servo.rows.after(0)[1]
    told = told[told[:, servo.rows.column("phase")] == 2]
    taken = told[:, servo.rows.column("sample")].astype(int)
    late, missed = np.zeros(simulated.samples + 1), np.ones(simulated.samples + 1, bool)
    late[taken], missed[taken] = told[:, servo.rows.column("late_s")], False
    timing = zw.simulation.Timing(lateness=late, missed=missed)
    trace = zw.simulate(device, law, simulated.scripted, "0.4", timing=timing)
    assert taken.size > 300
    assert np.ptp(trace["transmission_force"].values) > 0.01
    for column, variable in TOLD.items():
        served = told[:, servo.rows.column(column)]
        assert np.array_equal(served, trace[variable].values[taken]), column


def test_a_mass_alone_tells_of_no_motor():
    one = Simulated(device=DEVICE.motor_side, hand=zw.operators.Finger(), duration="0.1 s")
    assert not any("motor" in name or "transmission" in name for name in one.tells)


@pytest.mark.parametrize(("stiffness", "served"), [(119, True), (125, False)])
def test_a_device_that_is_met_is_judged_as_one_with_its_transmission(stiffness, served):
    """As one piece it would have 300 N/m."""
    device = DEVICE.replace(transmission=CABLE.replace(damping=0, stiffness=None, handle_mass=None))
    link = Measured(100, 0, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), 0)
    verdict = judged(zw.check, device, zw.Wall(stiffness=stiffness), link, simulated=False)
    assert verdict.outcome == ("passive" if served else "undecided")
    with Servo(device, zw.Wall(stiffness=stiffness), Played(np.full(200, -1e-3)), decide=zw.check) as servo:
        servo.measured = link
        if served:
            assert servo.prove().scope.transmission == "any"
            assert claimed(servo.prove()).endswith("It holds for any stiffness between motor and hand.")
        else:
            with pytest.raises(NotProved, match="not known"):
                servo.prove()


def test_a_proof_of_one_transmission_says_so_and_an_active_law_claims_nothing():
    device = DEVICE.replace(transmission=CABLE.replace(damping=0))
    one = zw.check(device, zw.Wall(stiffness=120.5), contact="kept")
    assert claimed(one) == f"{one.claim} It holds for a transmission of the numbers given."
    active = zw.check(device, zw.Wall(stiffness=125))
    assert (active.outcome, claimed(active)) == ("active", active.claim)


def test_a_delay_is_judged_at_both_its_ends():
    """Behind a transmission what is passive with the delay of the link need not be so without it."""
    asked = []

    def decide(device, law):
        asked.append((float(device.exact("delay")), float(device.exact("sample_period"))))
        return zw.check(device, law)

    link = Measured(100, 0, (1e-5, 1e-5, 1e-5), (2e-5, 2e-5, 2e-5), 0)
    judged(decide, DEVICE, zw.Wall(stiffness=50), link, simulated=False)
    assert asked == [(2e-5, 1e-3), (2e-5, 1.01e-3), (0, 1e-3)]


def test_a_law_reckons_with_what_the_motor_feels():
    """b₁ + c b₂/(c + b₂), the ends of an interval apart."""
    device = DEVICE.replace(damping="0.06 .. 0.07 N*s/m")
    assert float(least_friction(device).exact("damping")) == pytest.approx(
        0.06 + 0.02 * 0.09 / 0.11, rel=1e-12
    )
    assert least_friction(device).transmission is None


@pytest.mark.parametrize("device", [DEVICE, at_handle(DEVICE)], ids=["motor", "handle"])
def test_what_was_recorded_is_replayed(device, tmp_path):
    path = tmp_path / "touch.mcap"
    report = serve(
        device, zw.Wall(stiffness=80), decide=lambda d, law: zw.check(d, law, contact="kept"),
        duration="0.3 s", record=path,
    )  # fmt: skip
    assert replay(read_recording(path)).different == 0
    blind = device.transmission.encoder == "handle"
    assert (report.least is None) == blind == ("does not see the motor" in str(report))
    assert (report.to_dict()["energy_out_J"] is None) == blind
