"""A touch served on a simulated device becomes a whole trace, equal to what the loop wrote down."""

import numpy as np
import pytest
from recordings import paddle
from written_rows import drawn

import zwidth as zw
from zwidth import InputError
from zwidth.loop.energy import ledger
from zwidth.machine.servo import Safety
from zwidth.machine.servo.devices import Simulated
from zwidth.machine.servo.recording import Recorder, read_recording, trace_of
from zwidth.machine.servo.session import Servo

SLOW = Safety(longest_gap="60 s", host_timeout="60 s")
"""A machine that stands still makes a loop miss samples, and does not end it."""

WALL = zw.Wall(stiffness=300, damping="0.2 N*s/m")


def tracking(size):
    times = 2e-3 * np.arange(151)
    return zw.operators.Tracking(
        -size * np.cos(30 * times) + 2e-3 * np.sin(61 * times), stiffness=300.0, damping=1.0
    )


@pytest.fixture(scope="module")
def served(tmp_path_factory):
    """In real time, with whatever lateness this machine has; a delay, and friction at rest."""
    path = tmp_path_factory.mktemp("served") / "run.mcap"
    device = paddle(rate="500 Hz", sample_period=None, stiction=0.2, delay="0.7 ms")
    simulated = Simulated(device=device, hand=tracking(2e-3), duration="300 ms")
    with Servo(device, WALL, simulated, safety=SLOW) as servo:
        servo.measure("20 ms")
        with Recorder(servo.rows, path):
            servo.start(anyway=True)
            servo.wait()
    return read_recording(path)


def test_the_trace_is_what_was_served(served):
    """Positions, velocities, forces and energies at the samples, bit by bit; and its energies add up."""
    trace = trace_of(served, tracking(2e-3))
    good = served.columns["phase"] == 2.0
    at = served.columns["sample"][good].astype(int)
    pairs = {
        "time": "time_s",
        "measured_position": "position_m",
        "commanded_force": "force_N",
        "position": "true_position_m",
        "velocity": "true_velocity_m_per_s",
        "hand_work": "hand_work_J",
        "viscous_loss": "viscous_loss_J",
        "coulomb_loss": "coulomb_loss_J",
    }
    for name, column in pairs.items():
        assert np.array_equal(trace[name].values[at], served.columns[column][good]), name
    assert trace.attrs["format"] == "zwidth trace 1"
    assert ledger(trace).closes


def test_another_hand_is_refused(served):
    with pytest.raises(InputError, match="with this hand the position is another"):
        trace_of(served, tracking(2.001e-3))


def test_a_real_device_has_no_such_trace(record):
    with pytest.raises(InputError, match="of a real device"):
        trace_of(record(drawn(10)), tracking(2e-3))
