"""An ODrive, emulated at the other end of a pseudo-terminal."""

from math import tau

import pytest
from servo.drive import drive, drive_into
from servo.emulators.faults import Fault, Handle
from servo.emulators.odrive import ODriveEmulator

from zwidth.errors import InputError
from zwidth.machine.servo.connection import GOOD, REFUSED, SILENT
from zwidth.machine.servo.devices.odrive import ODrive

AT = 21


def wall(reading):
    return -0.2 * max(0.0, reading - 1.0)


def served(motor, periods, **options):
    return drive(ODrive(motor.port), periods, wall, **options)


GAIN = "axis0.controller.config.vel_gain"


@pytest.mark.parametrize(
    ("line", "answer"),
    [
        ("r axis0.current_state", "1"),
        ("r axis0.motor.config.torque_lim*17", "inf*97"),
        (f"r {GAIN}*120", "0.166667*24"),
        (f"w {GAIN} 0.05*70\nr {GAIN}*120", "0.050000*27"),
        (f"w {GAIN} 100*108\nr {GAIN}*120", "100.00000*47"),
        (f"w {GAIN} 12345678.5\nr {GAIN}", "12345678."),
        (f"w {GAIN} -123456.7\nr {GAIN}", "-123456.7"),
        (f"w {GAIN} 1e9\nr {GAIN}", "100000000"),
        (f"w {GAIN} nan\nr {GAIN}", "nan"),
        (f"w {GAIN} -inf\nr {GAIN}", "-inf"),
        ("w axis0.error 2147483648\nr axis0.error", "214748364"),
        ("r axis0.nothing*50", "invalid property*86"),
        ("w axis0.nothing 1*38", "invalid property*86"),
        ("w axis0.config.enable_watchdog yes*122", "not implemented*59"),
        ("r*114", "invalid command format*21"),
        ("f*102", "invalid command format*21"),
        ("c 0*115", "invalid command format*21"),
        ("c 2 0*97", "invalid motor 2*40"),
        ("f 2*116", "invalid motor 2*40"),
        ("x*120", "unknown command*47"),
        ("", "unknown command"),
        ("r axis0.current_state*1", None),
    ],
)
def test_the_emulator_answers_as_the_firmware(line, answer):
    """What ascii_protocol.cpp of 0.5.6 (f9b5419c), compiled for a computer, answered on 2026-11-28."""
    said = []
    with ODriveEmulator() as motor:
        motor.write = said.append
        motor.hear(f"{line}\n".encode())
    assert said == ([] if answer is None else [f"{answer}\r\n".encode()])


def test_one_lost_answer_about_the_state_costs_one_sample():
    """No position is asked for before it comes, since an ODrive drops a second answer."""
    expected = [GOOD, SILENT] + [GOOD] * 58

    def attempt(wait):
        with ODriveEmulator() as motor:
            motor.lose_states = 1
            return motor, served(motor, 60, wait=wait)

    motor, run = drive_into(expected, attempt)
    assert run.statuses == expected
    assert run.readings[2:] == pytest.approx(motor.positions[1:], rel=1e-15)


@pytest.mark.parametrize("turns", [0.0, 1.0, -1.0, 2.2])
def test_the_motor_gives_the_torque_of_the_wall_whatever_its_speed(turns):
    """As delivered it would give (2 turn/s − v)/6 N·m at most; afterwards it does again."""
    with ODriveEmulator() as motor:
        motor.properties["axis0.motor.config.torque_constant"] = "0.5"
        motor.handle = Handle(mass=1e9, stiffness=0.0, damping=0.0, speed=turns * tau)
        drive(ODrive(motor.port), 40, lambda reading: 1.0)
        flag = motor.properties["axis0.controller.config.enable_torque_mode_vel_limit"]
    assert set(motor.torques[1:]) == {1.0}
    assert flag == "1"


def test_what_limits_the_torque_of_an_odrive_is_told():
    """The motor's limits as a torque; 1.2 · 2 turn/s, above which the axis is dropped, and dropped it is."""
    with ODriveEmulator() as motor:
        motor.handle = Handle(mass=1e9, stiffness=0.0, damping=0.0, speed=2.5 * tau)
        connection = ODrive(motor.port)
        run = drive(connection, 40, lambda reading: 1.0)
    assert "at most 0.4 N·m" in connection.describe()
    assert "lets the motor go above 15.1 rad/s" in connection.describe()
    assert run.statuses[-1] == REFUSED
    with ODriveEmulator() as motor:  # as firmware 0.5.1 names the limit of the speed, and 0.6 those of torque
        new, old = ODrive.settings[0][0], "controller.config.enable_current_mode_vel_limit"
        motor.properties[f"axis0.{old}"] = motor.properties.pop(f"axis0.{new}")
        most = motor.properties.pop("axis0.motor.config.current_lim")
        motor.properties["axis0.config.motor.current_soft_max"] = most
        connection = ODrive(motor.port)
        connection.open(1e-3)
        assert motor.properties[f"axis0.{old}"] == "0"
        connection.close()
        assert motor.properties[f"axis0.{old}"] == "1"
    assert "at most 0.4 N·m" in connection.describe()


def test_an_axis_that_leaves_closed_loop_control_is_refused():
    """Within the 16 samples between two questions for the state."""
    with ODriveEmulator() as motor:
        motor.disarm_at = AT
        run = served(motor, 100)
    assert AT < len(run.statuses) <= AT + 17
    assert run.statuses == [GOOD] * (len(run.statuses) - 1) + [REFUSED]
    assert run.forces[-1] == 0.0


def test_the_watchdog_runs_while_the_torque_is_not_0():
    """Each torque finds it as the one before left it; it is told again in every 16th period."""
    torques = [0.0] * 5 + [0.1] * 40 + [0.0] * 3 + [-0.1] * 3
    given = iter(torques)
    with ODriveEmulator() as motor:
        motor.properties["axis0.controller.config.enable_overspeed_error"] = "0"
        drive(ODrive(port=motor.port, watchdog=0.08), len(torques), lambda reading: next(given))
    opening, *found = motor.watchdog_on
    assert not opening
    assert found[1 : len(torques) + 1] == [torque != 0 for torque in torques]
    assert not found[-1]
    assert "w axis0.config.watchdog_timeout 0.08" in motor.lines
    told = motor.lines.count("w axis0.config.enable_watchdog 1")
    assert told == 2 + 2  # where a torque begins, and with the 17th and the 33rd


def test_closing_leaves_the_settings_as_they_were():
    with ODriveEmulator() as motor:
        motor.properties["axis0.config.enable_watchdog"] = "1"
        before = dict(motor.properties)
        connection = ODrive(motor.port)
        connection.close()
        connection.open(1e-3)
        names = ("current_state", "controller.config.control_mode", "controller.config.input_mode")
        assert [motor.properties[f"axis0.{name}"] for name in names] == ["8", "1", "1"]
        connection.close()
        connection.close()
    assert motor.properties == {**before, "axis0.requested_state": "1"}


def test_it_can_be_served_again_behind_a_pause():
    with ODriveEmulator() as motor:
        connection = ODrive(motor.port)
        first, second = drive(connection, 20, wall), drive(connection, 20, wall)
    assert first.statuses == second.statuses == [GOOD] * 20
    assert first.readings + second.readings == pytest.approx(motor.positions, rel=1e-15)


def test_what_has_not_answered_is_told_to_do_nothing(monkeypatch):
    """Another device may be at the port: it is asked, and not commanded."""
    monkeypatch.setattr("zwidth.machine.servo.devices.odrive._ANSWER_TIME", 0.1)
    with ODriveEmulator(Fault.SILENCE) as motor, pytest.raises(InputError, match="no ODrive answers"):
        ODrive(motor.port).open(1e-3)
    assert motor.lines == ["", "r axis0.current_state"]


def test_an_axis_that_does_not_start_is_told_with_its_errors(monkeypatch):
    monkeypatch.setattr("zwidth.machine.servo.devices.odrive._START_TIME", 0.1)
    with ODriveEmulator(starts=False) as motor:
        motor.properties["axis0.error"] = "2048"
        with pytest.raises(InputError, match="its state is 1; error 2048"):
            ODrive(motor.port).open(1e-3)


def test_an_odrive_without_that_axis():
    with ODriveEmulator() as motor, pytest.raises(InputError, match=r"has no axis1\.current_state"):
        ODrive(port=motor.port, axis=1).open(1e-3)


def test_what_it_says_of_itself():
    connection = ODrive(port="/dev/ttyACM0", watchdog=0.1)
    assert "ODrive axis 0 at /dev/ttyACM0" in connection.describe()
    assert "only an emulator" in connection.describe()
    assert "100 ms" in connection.on_silence
