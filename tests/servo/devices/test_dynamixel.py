"""A Dynamixel servo, emulated at a pseudo-terminal."""

import math

import pytest
from servo.drive import changing, drive
from servo.emulators.dynamixel import DynamixelEmulator

from zwidth.errors import InputError
from zwidth.machine.servo.connection import GOOD, READING, REFUSED, UNTIL
from zwidth.machine.servo.devices.dynamixel import Dynamixel

OPENING = 1
"""Exchanges that opening makes."""

BEFORE = 1
"""Commands that opening gives, all 0."""

AT = 31
K = 1.8
"""Torque per current of these tests [N·m/A]."""

COUNTS = [round(2048 + 900 * math.sin(0.017 * k)) for k in range(2_100)]


def wall(reading):
    return -1.5 * max(0.0, reading - 3.5)


def in_radians(counts, periods):
    return [2 * math.pi * x / 4096 for x in counts[OPENING : OPENING + periods]]


def servo(other, **options):
    return Dynamixel(other.port, torque_per_current=K, **options)


def test_two_thousand_exchanges_of_a_dynamixel():
    with DynamixelEmulator(COUNTS) as other:
        run = drive(servo(other), 2_000, wall)
    assert run.statuses == [GOOD] * 2_000
    assert run.readings == pytest.approx(in_radians(COUNTS, 2_000), rel=1e-14)
    given = [command.force for command in other.commands[BEFORE:]]
    assert given[-1] == 0
    counts = [force / K / 2.69e-3 for force in run.forces]
    assert given[: len(counts)] == pytest.approx(counts, abs=0.5 + 1e-9)
    assert min(given) < -100


def test_a_dynamixel_is_left_as_it_was_found():
    with DynamixelEmulator(COUNTS) as other:
        run = drive(servo(other, watchdog=0.05), 20, lambda reading: 0.5)
        table = other.table
    assert run.statuses == [GOOD] * 20
    assert [command.force for command in other.commands[:BEFORE]] == [0]
    assert (table[64], table[11], table[9], table[98]) == (0, 3, 250, 0)


def test_the_watchdog_of_a_dynamixel_begins_with_the_first_torque():
    """In steps of 20 ms, the next longer one."""
    with DynamixelEmulator(COUNTS) as other:
        device = servo(other, watchdog=0.05)
        memory, inbox, outbox = device.open(1e-3)
        before = other.table[98]
        memory[UNTIL] = 2.0**62
        assert Dynamixel.apply(memory, inbox, outbox) == GOOD
        assert Dynamixel.measure(memory, inbox, outbox) == GOOD
        during = other.table[98]
        device.close()
    assert (before, during) == (0, 3)
    assert "0.06 s" in device.on_silence


def test_a_dynamixel_whose_watchdog_has_expired_is_served_again():
    """As a host that died has left it; and one shorter than two sample periods opens no port."""
    with DynamixelEmulator(COUNTS) as other:
        other.put(98, 1, -1)
        run = drive(servo(other), 10, lambda reading: 0.5)
    assert run.statuses == [GOOD] * 10
    assert other.table[98] == 0
    with pytest.raises(InputError, match="two sample periods"):
        Dynamixel("/dev/null", torque_per_current=K).open(0.021)


def test_positions_that_look_like_a_header():
    """FF FF FD in the answer is told from a header by the FD put in behind it, and taken out again."""
    counts = [-131073, -131073, -131072, -131074, -131073, -1, -65793]
    counts = [count + 0 for count in counts]
    with DynamixelEmulator(counts) as other:
        memory, inbox, outbox = (device := servo(other)).open(1e-3)
        readings = []
        for _ in range(4):
            memory[UNTIL] = 2.0**62
            assert Dynamixel.measure(memory, inbox, outbox) == GOOD
            readings.append(memory[READING] * 4096 / (2 * math.pi))
        device.close()
    assert readings == pytest.approx([-131073, -131072, -131074, -131073])


def test_a_dynamixel_is_counted_on_over_its_turns():
    with DynamixelEmulator([4000, 4000, 4090, 5, 100, 4091, 3990]) as other:
        run = drive(servo(other), 6)
    counts = [reading * 4096 / (2 * math.pi) for reading in run.readings]
    assert counts == pytest.approx([4000, 4090, 4101, 4196, 4091, 3990])


@pytest.mark.parametrize("what", ["watchdog", "torque off", "hardware"])
def test_a_dynamixel_that_gives_no_torque_any_more_is_refused(what):
    with DynamixelEmulator(COUNTS) as other:

        def change():
            if what == "watchdog":
                other.put(98, 1, -1)
            elif what == "torque off":
                other.put(64, 1, 0)
            else:
                other.alert = True

        run = drive(servo(other), 100, changing(AT - OPENING, change))
    assert run.statuses == [GOOD] * (AT - OPENING) + [REFUSED]
    assert run.forces[-1] == 0.0
    assert (other.table[64], other.table[11], other.table[98]) == (0, 3, 0)


@pytest.mark.parametrize("reverse", [None, False, True])
@pytest.mark.parametrize("drive_mode", range(16))
@pytest.mark.parametrize("model", [1020, 1120])
def test_a_wall_of_a_dynamixel_pushes_out_whatever_its_drive_mode(model, drive_mode, reverse):
    """Or the servo is refused: a slave always, one that is reversed unless its sense is given."""
    current_too = model == 1120 or not drive_mode & 1
    with DynamixelEmulator([1024], model=model) as other:
        other.put(10, 1, drive_mode)
        if drive_mode & 2 or (drive_mode & 1 and reverse is None):
            with pytest.raises(
                InputError, match="slave" if drive_mode & 2 else "clear bit 0, or try by hand"
            ):
                servo(other, reverse=reverse).open(1e-3)
            assert other.table[64] == 0
            return
        drive(servo(other, reverse=reverse), 3, lambda reading: -math.copysign(0.5, reading))
        current = other.commands[-3].force
        assert (current < 0) == (bool(reverse) != current_too)  # on the shaft, which stands at +1024
        assert other.table[10] == drive_mode
        assert other.table[64] == 0


def test_a_dynamixel_whose_torque_somebody_puts_off_is_not_put_on_again_by_the_next_current():
    """As Torque On by Goal Update would."""
    with DynamixelEmulator(COUNTS) as other:
        other.put(10, 1, 8)
        run = drive(servo(other), 100, changing(AT - OPENING, lambda: other.put(64, 1, 0)))
    assert run.statuses == [GOOD] * (AT - OPENING) + [REFUSED]


def test_a_limit_of_the_voltage_of_a_dynamixel_is_told():
    """Of the two registers the lower one."""
    with DynamixelEmulator(COUNTS) as other:
        other.put(100, 2, 177)
        device = servo(other)
        drive(device, 3)
    assert "with 20 % of its supply's voltage" in device.describe()


def test_a_torque_beyond_the_current_limit_is_given_as_the_limit():
    """Without that the servo would refuse it, unseen, and keep the current before."""
    with DynamixelEmulator(COUNTS) as other:
        other.put(38, 2, 200)
        drive(servo(other), 3, lambda reading: -50.0)
        drive_commands = {command.force for command in other.commands}
    assert drive_commands == {0, -200}


def test_a_model_of_the_small_size():
    """Its unit is another, and its indirect data stand elsewhere; an unknown model needs its unit given."""
    with DynamixelEmulator(COUNTS, model=1200, indirect_data=208) as other:
        run = drive(servo(other, current_unit=1e-3), 10, lambda reading: 0.36)
    assert run.statuses == [GOOD] * 10
    assert other.commands[3].force == 200
    with DynamixelEmulator(COUNTS, model=999) as other:
        with pytest.raises(InputError, match=r"current unit of .*999.*current_unit"):
            servo(other).open(1e-3)
        assert other.table[64] == 0
    with DynamixelEmulator(COUNTS, model=999) as other:
        drive(servo(other, current_unit=2e-3), 5, lambda reading: 0.36)
    assert other.commands[3].force == 100


def test_a_dynamixel_that_is_not_to_be_served_is_left_alone():
    """Old firmware: nothing is written, for the servo may be holding something up."""
    with DynamixelEmulator(COUNTS, firmware=37) as other:
        other.put(64, 1, 1)
        before = bytes(other.table)
        with pytest.raises(InputError, match=r"firmware 37.*watchdog"):
            servo(other).open(1e-3)
        other.put(132, 4, int.from_bytes(before[132:136], "little"))
        assert bytes(other.table) == before


def test_what_is_wrong_with_a_dynamixel_is_said_when_it_is_opened():
    with DynamixelEmulator(COUNTS) as other:
        other.alert = True
        other.put(70, 1, 0b100100)
        with pytest.raises(InputError, match="overheating, overload"):
            servo(other).open(1e-3)
