"""A Feetech servo, emulated at a pseudo-terminal."""

import math

import pytest
from servo.drive import changing, drive
from servo.emulators.feetech import FeetechEmulator

from zwidth.errors import InputError
from zwidth.machine.servo.connection import GOOD, REFUSED
from zwidth.machine.servo.devices.feetech import Feetech

BEFORE = 1
"""Commands that opening gives, all 0."""

AT = 30
FULL = 2.9
"""Torque at full duty of these tests [N·m]."""

COUNTS = [round(2048 + 900 * math.sin(0.017 * k)) for k in range(2_100)]


def wall(reading):
    return -1.5 * max(0.0, reading - 3.5)


def in_radians(counts, periods):
    return [2 * math.pi * x / 4096 for x in counts[:periods]]


def servo(other, **options):
    return Feetech(other.port, full_duty_torque=FULL, **options)


@pytest.mark.parametrize("reverse", [False, True])
def test_two_thousand_exchanges_of_a_feetech_servo(reverse):
    periods = 1_000 if reverse else 2_000
    with FeetechEmulator(COUNTS) as other:
        run = drive(servo(other, reverse=reverse), periods, wall)
    assert run.statuses == [GOOD] * periods
    assert run.readings == pytest.approx(in_radians(COUNTS, periods), rel=1e-14)
    sense = -1 if reverse else 1
    given = [sense * command.force for command in other.commands[BEFORE:]]
    assert given[:periods] == pytest.approx([force / FULL for force in run.forces], abs=0.5e-3 + 1e-9)
    assert given[periods:] == [0.0, 0.0]
    assert min(given) < -0.1


def test_a_feetech_servo_is_left_as_it_was_found():
    """Its mode, delay and lock; nothing is written where it would stay; no duty but 0 before the loop."""
    with FeetechEmulator(COUNTS) as other:
        run = drive(servo(other), 20, lambda reading: 0.5)
        table = other.table
    assert run.statuses == [GOOD] * 20
    assert [command.force for command in other.commands[:BEFORE]] == [0.0]
    assert (table[40], table[33], table[7], table[55]) == (0, 0, 250, 0)
    assert other.saved == []


def test_a_feetech_servo_is_counted_on_over_its_turns():
    """In either sense, where the counts jump by almost a turn; and where they are a magnitude with a sign."""
    with FeetechEmulator([4000, 4090, 5, 100, 4091, -6, -100]) as other:
        run = drive(servo(other), 7)
    counts = [reading * 4096 / (2 * math.pi) for reading in run.readings]
    assert counts == pytest.approx([4000, 4090, 4101, 4196, 4091, 4090, 3996])


def test_a_feetech_servo_that_reports_a_fault_is_refused():
    with FeetechEmulator(COUNTS) as other:

        def change():
            other.state = 0b100

        run = drive(servo(other), 100, changing(AT, change))
    assert run.statuses == [GOOD] * AT + [REFUSED]
    assert run.forces[-1] == 0.0
    with FeetechEmulator(COUNTS) as other:
        other.state = 0b100001
        with pytest.raises(InputError, match="supply voltage, overload"):
            servo(other).open(1e-3)
        assert other.table[40] == 1


def test_a_torque_beyond_the_torque_limit_is_given_as_the_limit():
    """The register that the servo itself limits its duty by."""
    with FeetechEmulator(COUNTS) as other:
        other.table[48:50] = (500).to_bytes(2, "little")
        device = servo(other)
        drive(device, 3, lambda reading: 50.0)
    assert {command.force for command in other.commands} == {0.0, 0.5}
    assert "1.45 N·m at most" in device.describe()


def test_what_a_feetech_servo_does_when_the_host_dies_is_said():
    device = Feetech("/dev/null", full_duty_torque=FULL)
    assert "no watchdog" in device.on_silence
    assert "duty" in device.describe()
    device.close()


def test_counts_that_are_no_4096th_of_a_turn_are_refused():
    """The register that makes them coarser."""
    with FeetechEmulator(COUNTS) as other:
        other.table[30] = 3
        with pytest.raises(InputError, match="angular resolution 3"):
            servo(other).open(1e-3)
        assert other.table[40] == 1
