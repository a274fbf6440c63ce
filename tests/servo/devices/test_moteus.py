"""mjbots' moteus, emulated at a pseudo-terminal."""

import math

import pytest
from servo.drive import drive
from servo.emulators.moteus import MoteusEmulator

from zwidth.errors import InputError
from zwidth.machine.servo.connection import GOOD, REFUSED, TOLD, UNTIL
from zwidth.machine.servo.devices import moteus
from zwidth.machine.servo.devices.moteus import Moteus

OPENING = 2
"""Exchanges that opening makes: the controller operates at the second."""

TURNS = [0.4 * math.sin(0.013 * k) + 0.07 for k in range(30)]


def wall(reading):
    return -2.0 * max(0.0, reading - 0.5)


def test_the_watchdog_of_a_moteus_runs_only_in_the_loop():
    """Torque 0 without a watchdog before the first sample; then its time with each torque."""
    with MoteusEmulator(TURNS) as other:
        drive(Moteus(other.port, watchdog=0.08), 20, wall)
    assert all(math.isnan(time) for time in other.watchdogs[:OPENING])
    assert other.watchdogs[OPENING:] == pytest.approx([0.08] * 22)
    assert [command.force for command in other.commands[:OPENING]] == [0.0] * OPENING


@pytest.mark.parametrize("mode", [0, 10, 12, 13, 15, None])
@pytest.mark.parametrize("speed", [-3.0, 0.7])
def test_what_is_said_of_a_moteus_after_its_watchdog_is_what_it_does(mode, speed):
    """It is limp if and only if its motor gives no torque; without an answer all that it may do is said."""
    with MoteusEmulator(TURNS) as other:
        if mode is None:
            del other.configuration["servo.timeout_mode"]
        else:
            other.configuration["servo.timeout_mode"] = mode
        drive(device := Moteus(other.port, watchdog=0.08), 20, wall)
    if mode is None:
        assert all(f"with {number}" in device.on_silence for number in (0, 10, 15))
        return
    other.mode = 11
    assert f"(servo.timeout_mode {mode})" in device.on_silence
    assert ("goes limp" in device.on_silence) == (other.torque(speed) == 0.0)
    assert ("brakes" in device.on_silence) == (mode == 15)


def test_an_answer_without_the_checksum_that_was_asked_for_is_garbled(monkeypatch):
    """A UART that lost the end of its lines is not believed."""
    monkeypatch.setattr("zwidth.machine.servo.devices.moteus._START_TIME", 0.0)
    monkeypatch.setattr("zwidth.machine.servo.devices.moteus._ONE_TRY", 0.1e9)
    with MoteusEmulator(TURNS, checksums=True) as other:
        other.line = lambda text: text + b"\r\n"
        with pytest.raises(InputError, match="does not answer"):
            Moteus(other.port, checksums=True).open(1e-3)


def test_what_limits_the_torque_of_a_moteus_is_recorded():
    """A fault code in the operating mode is no fault: it goes to the rows of the loop."""
    with MoteusEmulator(TURNS) as other:
        memory, inbox, outbox = (device := Moteus(other.port)).open(1e-3)
        told = []
        for code in (0, 99, 102, 0):
            other.fault_code = code
            memory[UNTIL] = 2.0**62
            assert Moteus.measure(memory, inbox, outbox) == GOOD
            told.append(memory[TOLD])
        device.close()
    assert told == [0, 99, 102, 0]
    assert Moteus.tells == ("fault_code",)


def test_a_moteus_is_counted_on_where_its_position_begins_anew():
    """From 32768 turns at −32768; and a quick turn between two samples is no jump."""
    turns = [32767.5, 32767.5, 32767.5, 32767.75, -32768.0, -32767.5, -32766.25]
    with MoteusEmulator(turns) as other:
        run = drive(Moteus(other.port), 5)
    read = [32767.5, 32767.75, 32768, 32768.5, 32769.75]
    assert run.readings == pytest.approx([math.tau * x for x in read])


def test_a_position_that_is_no_number_is_refused():
    with MoteusEmulator([0.1] * 10 + [math.nan]) as other:
        run = drive(Moteus(other.port), 20)
    assert run.statuses == [GOOD] * (10 - OPENING) + [REFUSED]


def test_a_moteus_that_has_heard_a_checksum_is_told_from_one_whose_bus_is_off(monkeypatch):
    """It wants them until it is switched off."""
    monkeypatch.setattr("zwidth.machine.servo.devices.moteus._START_TIME", 0.0)
    refused = pytest.raises(InputError, match="give checksums = true")
    with MoteusEmulator(TURNS, checksums=True) as other, refused:
        Moteus(other.port).open(1e-3)


def test_a_configuration_that_bears_on_the_torque_of_a_moteus_is_told():
    """What its firmware does not know is left out."""
    with MoteusEmulator(TURNS) as other:
        other.configuration["motor.cogging_dq_scale"] = 0.25
        del other.configuration["servo.inertia_feedforward"]
        drive(device := Moteus(other.port), 3)
    assert "servo.max_current_A 100, motor.cogging_dq_scale 0.25;" in device.describe()


def test_every_fault_of_a_moteus_has_a_name():
    """As fw/error.h numbers them."""
    assert set(range(32, 51)) <= set(moteus._FAULTS)


def test_closing_a_moteus_twice():
    device = Moteus("/dev/null")
    device.close()
    with MoteusEmulator(TURNS) as other:
        device = Moteus(other.port)
        device.open(1e-3)
        device.close()
        device.close()
    assert other.mode == 0
    assert "emulator" in device.describe()
