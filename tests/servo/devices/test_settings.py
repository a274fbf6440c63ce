"""What is listed of a controller is what is done: what opening and closing read, set and put back."""

import re

import pytest
from servo.drive import drive
from servo.emulators.dynamixel import DynamixelEmulator
from servo.emulators.feetech import FeetechEmulator
from servo.emulators.moteus import MoteusEmulator
from servo.emulators.odrive import ODriveEmulator

from zwidth.machine.servo.connection import DONE, LEAVES, RESTORES, SETS
from zwidth.machine.servo.devices.dynamixel import Dynamixel
from zwidth.machine.servo.devices.feetech import Feetech
from zwidth.machine.servo.devices.moteus import Moteus
from zwidth.machine.servo.devices.odrive import ODrive
from zwidth.machine.servo.devices.registry import CONNECTIONS

POSITIONS = {132, 224, 69} | {56}
"""Registers of a Dynamixel and of a Feetech servo: their positions, and what only makes questions differ."""


def named(connection, *done):
    """The names in its list of which one of these is done."""
    return {name for name, _, _, what, _ in connection.settings if what in done}


def addresses(connection, *done):
    """Registers in its list, "name 40", "name 168 to 182" in steps of 2."""
    found = set()
    for name in named(connection, *done):
        if match := re.search(r" (\d+)(?: to (\d+))?$", name):
            found |= set(range(int(match[1]), int(match[2] or match[1]) + 1, 2))
    return found


def touched(servo, emulator):
    """Registers that were read or written, also behind an indirect address; those that are not as before."""
    before = bytes(emulator.table)
    drive(servo, 5)
    changed = {at for at in range(len(before)) if emulator.table[at] != before[at]}
    reached = set(emulator.touched)
    if 168 in reached:
        reached |= {emulator.value(168 + 2 * i, 2) for i in range(8)}
        reached -= {133, 134, 135}
    return reached, changed


@pytest.mark.parametrize("name", list(CONNECTIONS))
def test_every_connection_lists_what_can_change_its_force(name):
    """Whose words they are, what is done, and where it stands; no name twice."""
    made = CONNECTIONS[name].made
    assert made.maker
    assert len(made.settings) > 5
    assert len(named(made, *DONE)) == len(made.settings)
    assert all(effect and source for _, _, effect, _, source in made.settings)


@pytest.mark.parametrize(
    ("emulator", "servo", "options"),
    [
        (DynamixelEmulator, Dynamixel, {"torque_per_current": 1.0}),
        (FeetechEmulator, Feetech, {"full_duty_torque": 1.0}),
    ],
)
def test_the_registers_of_a_servo_are_those_of_its_list(emulator, servo, options):
    """Every one that is listed as read or set is reached, and no other."""
    with emulator([2048] * 20) as other:
        if servo is Dynamixel:
            other.put(10, 1, 8)
        reached, changed = touched(servo(other.port, **options), other)
    assert reached - POSITIONS == addresses(servo, *set(DONE) - {LEAVES})
    assert not changed & addresses(servo, *set(DONE) - {SETS})


def test_the_properties_of_an_odrive_are_those_of_its_list():
    with ODriveEmulator() as other:
        drive(ODrive(other.port), 40)
    said = [line.split() for line in other.lines if line[:1] in ("r", "w")]
    reached = {words[1].removeprefix("axis0.") for words in said}
    written = {words[1].removeprefix("axis0.") for words in said if words[0] == "w"}
    assert reached - {"current_state"} == named(ODrive, *set(DONE) - {LEAVES})
    assert written == named(ODrive, RESTORES)


def test_the_configuration_of_a_moteus_that_is_read_is_that_of_its_list():
    with MoteusEmulator([0.1]) as other:
        drive(Moteus(other.port), 5)
    assert other.asked_for == named(Moteus, *set(DONE) - {LEAVES, SETS})
