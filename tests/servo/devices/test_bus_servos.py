"""What a Dynamixel and a Feetech servo have of their own, emulated at a pseudo-terminal."""

import math

import pytest
from servo.drive import changing, drive
from servo.emulators.dynamixel import DynamixelEmulator
from servo.emulators.feetech import FeetechEmulator

from zwidth.errors import InputError
from zwidth.machine.servo.connection import GOOD, READING, REFUSED, UNTIL
from zwidth.machine.servo.devices.dynamixel import Dynamixel
from zwidth.machine.servo.devices.feetech import Feetech

COUNTS = [2048] * 40 + [2500]


def servo(other, **options):
    return Dynamixel(other.port, torque_per_current=1.8, **options)


def feetech(other):
    return Feetech(other.port, full_duty_torque=2.9)


@pytest.mark.parametrize(
    ("emulator", "adapter", "counts", "on"),
    [
        (DynamixelEmulator, servo, [4000, 4000, 4090, 5, 100, 4091, 3990], [4090, 4101, 4196, 4091, 3990]),
        (  # a magnitude with a sign
            FeetechEmulator,
            feetech,
            [4000, 4090, 5, 100, 4091, -6, -100],
            [4090, 4101, 4196, 4091, 4090, 3996],
        ),
    ],
)
def test_turns_are_counted_on(emulator, adapter, counts, on):
    """In either sense, where the counts jump by almost a turn; Feetech's are a magnitude with a sign."""
    with emulator(counts) as other:
        run = drive(adapter(other), 1 + len(on))
    assert [reading * 4096 / math.tau for reading in run.readings] == pytest.approx([4000, *on])


def test_a_torque_beyond_the_limit_of_a_dynamixel_is_given_as_the_limit():
    """Without that the servo would refuse it, unseen; of two registers of its voltage the lower is told."""
    with DynamixelEmulator(COUNTS) as other:
        other.put(38, 2, 200)
        other.put(100, 2, 177)
        drive(device := servo(other), 3, lambda reading: -50.0)
    assert {command.force for command in other.commands} == {0, -200}
    assert "with 20 % of its supply's voltage" in device.describe()


def test_a_torque_beyond_the_limit_of_a_feetech_servo_is_given_as_the_limit():
    """The register that the servo itself limits its duty by; it has no watchdog."""
    with FeetechEmulator(COUNTS) as other:
        other.table[48:50] = (500).to_bytes(2, "little")
        device = feetech(other)
        assert "duty" in device.describe()
        drive(device, 3, lambda reading: 50.0)
    assert {command.force for command in other.commands} == {0.0, 0.5}
    assert "1.45 N·m at most" in device.describe()
    assert "no watchdog" in device.on_silence


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
    assert "60 ms" in device.on_silence


def test_a_dynamixel_whose_watchdog_has_expired_is_served_again():
    """As a host that died has left it."""
    with DynamixelEmulator(COUNTS) as other:
        other.put(98, 1, -1)
        run = drive(servo(other), 10, lambda reading: 0.5)
    assert run.statuses == [GOOD] * 10
    assert other.table[98] == 0


def test_positions_that_look_like_a_header():
    """FF FF FD in the answer is told from a header by the FD put in behind it, and taken out again."""
    counts = [-131073, -131073, -131072, -131074, -131073, -1, -65793]
    with DynamixelEmulator(counts) as other:
        memory, inbox, outbox = (device := servo(other)).open(1e-3)
        readings = []
        for _ in range(4):
            memory[UNTIL] = 2.0**62
            assert Dynamixel.measure(memory, inbox, outbox) == GOOD
            readings.append(memory[READING] * 4096 / (2 * math.pi))
        device.close()
    assert readings == pytest.approx([-131073, -131072, -131074, -131073])


@pytest.mark.parametrize("reverse", [None, False, True])
@pytest.mark.parametrize("drive_mode", range(16))
@pytest.mark.parametrize("model", [1020, 1120])
def test_a_wall_of_a_dynamixel_pushes_out_whatever_its_drive_mode(model, drive_mode, reverse):
    """Or the servo is refused: a slave always, one that is reversed unless its sense is given."""
    current_too = model == 1120 or not drive_mode & 1
    with DynamixelEmulator([1024], model=model) as other:
        other.put(10, 1, drive_mode)
        if drive_mode & 2 or (drive_mode & 1 and reverse is None):
            said = "slave" if drive_mode & 2 else "clear bit 0, or try by hand"
            with pytest.raises(InputError, match=said):
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
        run = drive(servo(other), 100, changing(28, lambda: other.put(64, 1, 0)))
    assert run.statuses == [GOOD] * 28 + [REFUSED]


def test_a_model_of_the_small_size():
    """Its unit is another, and its indirect data stand elsewhere; an unknown model is given its unit."""
    with DynamixelEmulator(COUNTS, model=1200, indirect_data=208) as other:
        run = drive(servo(other, current_unit=1e-3), 10, lambda reading: 0.36)
    assert run.statuses == [GOOD] * 10
    assert other.commands[3].force == 200
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
