"""Bus servos and the code of their makers: it is the client of our emulators, and the bus of our clients."""

import math
import re

import dynamixel_sdk
import numpy as np
import pytest
import scservo_sdk
from dynamixel_easy_sdk.connector import Connector
from dynamixel_easy_sdk.control_table import ControlTable
from dynamixel_easy_sdk.data_types import OperatingMode
from hypothesis import given
from hypothesis import strategies as st
from servo.drive import drive
from servo.emulators import dynamixel, feetech
from servo.emulators.dynamixel import DynamixelEmulator
from servo.emulators.feetech import FeetechEmulator

from zwidth.machine.servo.connection import GOOD
from zwidth.machine.servo.devices import dynamixel_packets
from zwidth.machine.servo.devices import feetech as feetech_packets
from zwidth.machine.servo.devices.dynamixel import _UNITS, Dynamixel
from zwidth.machine.servo.devices.feetech import Feetech

ROBOTIS = dynamixel_sdk.PacketHandler(2.0)
FEETECH = scservo_sdk.PacketHandler(0)


class Line:
    """A port as both SDKs want it, at whose other end an emulator has answered before anybody looks."""

    is_using = False

    def __init__(self, other=None):
        self.sent, self.came, self.other = b"", b"", other
        if other:
            other.write = self.answered

    def answered(self, data):
        self.came += data

    def clearPort(self):
        self.came = b""

    def writePort(self, packet):
        self.sent += bytes(packet)
        if self.other:
            self.other.hear(bytes(packet))
        return len(packet)

    def readPort(self, count):
        first, self.came = self.came[:count], self.came[count:]
        return first

    def getBaudRate(self):
        return 1_000_000

    def setPacketTimeout(self, length):
        """Nothing is waited for."""

    setPacketTimeoutMillis = setPacketTimeout

    def isPacketTimeout(self):
        return True


def patient(sdk, port):
    """The port of this SDK, opened; a busy machine is given a minute, not 34 ms."""
    opened = sdk.PortHandler(port)
    opened.setPacketTimeout = lambda length: opened.setPacketTimeoutMillis(60_000.0)
    assert opened.openPort()
    return opened


def of_robotis(identifier, body):
    """A packet that ROBOTIS' functions make."""
    whole = [0xFF, 0xFF, 0xFD, 0, identifier, *(len(body) + 2).to_bytes(2, "little"), *body, 0, 0]
    whole = ROBOTIS.addStuffing(whole)[:-2]
    return bytes(whole) + ROBOTIS.updateCRC(0, whole, len(whole)).to_bytes(2, "little")


def of_feetech(identifier, body):
    """A packet that Feetech's functions make."""
    line = Line()
    FEETECH.txPacket(line, [0, 0, identifier, len(body) + 1, *body, 0])
    return line.sent


BUSES = {
    # sdk, its packets, emulator, model, what LeRobot's buses write, position, goal
    "dynamixel": (
        dynamixel_sdk,
        ROBOTIS,
        DynamixelEmulator,
        1020,
        [(64, 0), (9, 0), (11, 3), (64, 1), (64, 0)],
        (132, 4),
        (116, 4),
    ),
    "feetech": (
        scservo_sdk,
        FEETECH,
        FeetechEmulator,
        777,
        [(40, 0), (55, 0), (7, 0), (85, 254), (41, 254), (33, 0), (40, 1), (55, 1), (40, 0), (55, 0)],
        (56, 2),
        (42, 2),
    ),
}


@pytest.mark.parametrize("bus", list(BUSES))
def test_the_maker_as_the_client_of_our_bus(bus):
    """Over a pseudo-terminal, in the order in which LeRobot's bus classes use the makers' functions."""
    sdk, maker, emulator, model, writes, (position, size), (goal, goal_size) = BUSES[bus]
    with emulator([2049]) as other:
        port = patient(sdk, other.port)
        assert maker.ping(port, 1) == (model, 0, 0)
        for address, value in writes:
            assert maker.write1ByteTxRx(port, 1, address, value) == (0, 0)
            assert maker.read1ByteTxRx(port, 1, address) == (value, 0, 0)
        reader = sdk.GroupSyncRead(port, maker, position, size)
        reader.addParam(1)
        assert reader.txRxPacket() == 0
        assert reader.getData(1, position, size) == 2049
        writer = sdk.GroupSyncWrite(port, maker, goal, goal_size)
        writer.addParam(1, list((1234).to_bytes(goal_size, "little")))
        assert writer.txPacket() == 0
        assert maker.read2ByteTxRx(port, 1, goal) == (1234, 0, 0)
        port.closePort()


@pytest.mark.parametrize(("bus", "level"), [("dynamixel", 68), ("feetech", 8)])
def test_a_servo_that_is_told_to_answer_reads_alone(bus, level):
    """It obeys a write and does not answer it; ours never waits for such an answer."""
    sdk, maker, emulator, model, *_ = BUSES[bus]
    with emulator([0]) as other:
        other.table[level] = 1 if bus == "dynamixel" else 0
        line = Line(other)
        assert maker.write1ByteTxRx(line, 1, 33, 1)[0] == sdk.COMM_RX_TIMEOUT
        assert maker.read1ByteTxRx(line, 1, 33) == (1, 0, 0)
        assert maker.ping(line, 1) == (model, 0, 0)


def test_what_a_dynamixel_does_not_take_is_told_to_its_maker():
    """A value beyond a limit, EEPROM while the torque is on; an alert; and who is there at all."""
    with DynamixelEmulator([0], firmware=46) as other:
        line = Line(other)
        assert ROBOTIS.broadcastPing(line) == ({1: [1020, 46]}, 0)
        assert ROBOTIS.write2ByteTxRx(line, 1, 102, 1194) == (0, 4)
        assert ROBOTIS.write1ByteTxRx(line, 1, 64, 1) == (0, 0)
        assert ROBOTIS.write1ByteTxRx(line, 1, 11, 0) == (0, 7)
        other.alert = True
        assert ROBOTIS.read1ByteTxRx(line, 1, 64) == (1, 0, 0x80)


def test_robotis_own_motor_in_the_current_mode(monkeypatch):
    """Its class of a motor sets the mode and the current that ours sets, of the same sign."""
    monkeypatch.setattr(Connector, "_packet_handler", ROBOTIS)
    with DynamixelEmulator([166]) as other:
        bus = Connector.__new__(Connector)  # made by its own hand it gives an answer 34 ms
        bus._port_handler = Line(other)
        motor = bus.createMotor(1)
        motor.setOperatingMode(OperatingMode.CURRENT)
        motor.enableTorque()
        motor.setGoalCurrent(-300)
        assert motor.getPresentPosition() == 166
        assert motor.getCurrentLimit() == 1193
    assert (other.table[11], other.commands[-1].force) == (0, -300)


CASES = {
    "dynamixel": (
        type("RobotisServo", (DynamixelEmulator,), {"packet": staticmethod(of_robotis)}),
        lambda port: Dynamixel(port, torque_per_current=1.8),
        1.8 * 2.69e-3,
        [-131073 + k % 5 for k in range(301)],  # opening asks for one
        64,
    ),
    "feetech": (
        type("FeetechServo", (FeetechEmulator,), {"packet": staticmethod(of_feetech)}),
        lambda port: Feetech(port, full_duty_torque=2.9),
        2.9,
        [round(900 * math.sin(0.05 * k)) for k in range(300)],
        40,
    ),
}


@pytest.mark.parametrize("bus", list(CASES))
def test_our_client_on_a_bus_whose_packets_are_the_makers(bus):
    """What we send is to the byte what the maker makes of it; each of its answers is understood.

    The position −131073 has FF FF FD in it.
    """
    emulator, adapter, unit, counts, torque = CASES[bus]
    with emulator(counts) as other:
        run = drive(adapter(other.port), 300, lambda reading: 0.5 * math.cos(reading))
    turned = [reading * 4096 / (2 * math.pi) for reading in run.readings]
    assert run.statuses == [GOOD] * 300
    assert turned == pytest.approx(counts[-300:], rel=1e-14, abs=1e-9)
    given_forces = [command.force * unit for command in other.commands[1:301]]
    resolution = unit if bus == "dynamixel" else unit / 1000
    assert given_forces == pytest.approx(run.forces, abs=0.5 * resolution + 1e-9)
    assert other.commands[-1].force == other.table[torque] == 0


@given(body=st.binary(min_size=1, max_size=12) | st.lists(st.sampled_from([0xFF, 0xFD, 0, 1]), min_size=1))
def test_any_packet_is_the_makers(body):
    """With headers among its parameters, too."""
    assert dynamixel.packet(1, bytes(body)) == of_robotis(1, bytes(body))
    assert feetech.packet(1, bytes(body[:240])) == of_feetech(1, bytes(body[:240]))


@given(
    identifier=st.integers(0, 252),
    address=st.integers(0, 255),
    count=st.integers(1, 8),
    value=st.integers(-(2**15), 2**15 - 1),
)
def test_what_we_send_is_what_the_makers_functions_send(identifier, address, count, value):
    """A read, and a sync write to one servo."""
    out, two = np.zeros(64, np.uint8), list(value.to_bytes(2, "little", signed=True))
    for ours, sdk, maker in [
        (dynamixel_packets, dynamixel_sdk, ROBOTIS),
        (feetech_packets, scservo_sdk, FEETECH),
    ]:
        line = Line()
        maker.readTx(line, identifier, address, count)
        assert out[: ours.put_read(out, identifier, address, count)].tobytes() == line.sent
        line = Line()
        writer = sdk.GroupSyncWrite(line, maker, address, 2)
        writer.addParam(identifier, two)
        writer.txPacket()
        start = (0,) if ours is dynamixel_packets else ()
        assert out[: ours.put_write(out, *start, identifier, address, 2, value)].tobytes() == line.sent


TABLES = {number: ControlTable.getControlTable(number) for number in ControlTable.parsingModelList()}
X = [
    number
    for number, table in TABLES.items()
    if "Goal Current" in table and "Bus Watchdog" in table and table["Bus Watchdog"].address == 98
]
"""Models with a current and a watchdog where the X series has them."""


@pytest.mark.parametrize("number", X)
def test_registers_are_those_of_the_makers_control_table(number):
    """Of every model that can be served: those that are listed, and all that are read or written."""
    table = TABLES[number]
    named = [re.fullmatch(r"(.+) (\d+)", name) for name, *_ in Dynamixel.settings]
    listed = {match[1]: int(match[2]) for match in named if match and match[1] in table}
    assert listed == {name: table[name].address for name in listed}
    assert {"Goal Current", "Torque Enable", "Bus Watchdog", "Operating Mode", "Current Limit"} <= set(listed)
    with DynamixelEmulator([0], model=number) as other:
        drive(Dynamixel(other.port, torque_per_current=1.0, current_unit=1e-3), 2)
    together = {other.value(168 + 2 * i, 2) for i in range(8)} - {133, 134, 135}  # the rest of the position
    reached = (other.touched | together) - {*range(170, 184), 224}
    assert reached <= {item.address for item in table.values()}


def test_models_are_named_as_by_their_maker():
    """Those whose unit of the current is known."""
    assert set(_UNITS) <= set(X)
    for number, (name, _) in _UNITS.items():
        assert ControlTable.getModelName(number) == name.lower().replace("-", "_") + ".model"
