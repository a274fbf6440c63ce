"""What all adapters of a line owe: each sample of its own question, and force 0 after a fault of the line."""

import math
import random
from collections.abc import Callable
from functools import partial
from typing import Any, NamedTuple

import numpy as np
import pytest
from servo.drive import changing, drive, drive_into
from servo.emulators.dynamixel import DynamixelEmulator
from servo.emulators.faults import Fault
from servo.emulators.feetech import FeetechEmulator
from servo.emulators.hapkit import HapkitEmulator
from servo.emulators.haply import HaplyEmulator
from servo.emulators.inverse import InverseEmulator
from servo.emulators.moteus import MoteusEmulator
from servo.emulators.odrive import ODriveEmulator

from zwidth.errors import InputError
from zwidth.machine.servo.connection import CLOSED, GARBLED, GOOD, REFUSED, SILENT, STALE
from zwidth.machine.servo.devices.dynamixel import Dynamixel
from zwidth.machine.servo.devices.feetech import Feetech
from zwidth.machine.servo.devices.force_dimension import ForceDimension
from zwidth.machine.servo.devices.hapkit import Hapkit
from zwidth.machine.servo.devices.haply import HaplyJoint, HaplyPantograph
from zwidth.machine.servo.devices.inverse import Inverse
from zwidth.machine.servo.devices.moteus import Moteus
from zwidth.machine.servo.devices.odrive import ODrive

COUNTS = [round(2048 + 900 * math.sin(0.017 * k)) for k in range(2_100)]
TURNS = [0.4 * math.sin(0.013 * k) + 0.07 for k in range(2_100)]
COUNT = 13e-6
NOBODY = "/dev/null"


def counts(exchange):
    """Anywhere in 32 bits, at every exchange somewhere else."""
    return random.Random(exchange).randrange(-(2**31), 2**31)


def place(exchange):
    draw = random.Random(exchange)
    return draw.uniform(-0.02, 0.06), draw.uniform(0.07, 0.11)


class Line(NamedTuple):
    """The other side of a line, its adapter, and what a position asked for at an exchange should read."""

    emulator: Callable[..., Any]  # of a fault and the exchange that it begins with
    adapter: Callable[[Any], Any]
    reading: Callable[[Any, int], float]
    right: Callable[[Any], bool]  # in the end: the motor is off, and nothing was heard amiss
    opening: int  # exchanges
    zeros: int = 1  # commands of opening
    each: int = 1  # exchanges of a period
    law: Callable[[float], float] = lambda reading: 0.3
    within: float = 0.0  # relatively, what is read
    away: float = 0.0  # and absolutely
    given: Callable[[float], float] = lambda force: force  # what is commanded of a force
    rounded: float = 0.0  # by so much

    def at(self, period):
        return self.opening + self.each * period

    def reads(self, run, other, periods):
        wanted = [self.reading(other, self.at(k)) for k in periods]
        return [run.readings[k] for k in periods] == pytest.approx(wanted, rel=self.within, abs=self.away)


LINES = {
    "dynamixel": Line(
        partial(DynamixelEmulator, COUNTS),
        lambda other: Dynamixel(other.port, torque_per_current=1.8),
        lambda other, k: math.tau * COUNTS[k] / 4096,
        lambda other: [other.table[at] for at in (64, 11, 9, 98)] == [0, 3, 250, 0],  # mode, delay, watchdog
        opening=1,
        law=lambda reading: -1.5 * max(0.0, reading - 3.5),
        given=lambda force: force / 1.8 / 2.69e-3,
        within=1e-14,
        rounded=0.5 + 1e-9,  # of a count of current
    ),
    "feetech": Line(
        partial(FeetechEmulator, COUNTS),
        lambda other: Feetech(other.port, full_duty_torque=2.9),
        lambda other, k: math.tau * COUNTS[k] / 4096,
        lambda other: [other.table[at] for at in (40, 33, 7, 55)] == [0, 0, 250, 0] and not other.saved,
        opening=0,
        law=lambda reading: -1.5 * max(0.0, reading - 3.5),
        given=lambda force: force / 2.9,
        within=1e-14,
        rounded=0.5e-3 + 1e-9,
    ),
    "moteus": Line(
        partial(MoteusEmulator, TURNS, checksums=True),
        lambda other: Moteus(other.port, checksums=True),
        lambda other, k: math.tau * float(np.float32(TURNS[k])),
        lambda other: other.mode == 0 and not other.complaints,
        opening=2,
        zeros=2,
        law=lambda reading: -2.0 * max(0.0, reading - 0.5),
        given=lambda force: float(np.float32(force)),
    ),
    "odrive": Line(
        ODriveEmulator,
        lambda other: ODrive(other.port),
        lambda other, k: other.positions[k],
        lambda other: other.properties["axis0.current_state"] == "1",
        opening=0,
        law=lambda reading: -0.2 * max(0.0, reading - 1.0),
        within=1e-15,
        rounded=0.6e-6,
    ),
    "hapkit": Line(
        partial(HapkitEmulator, counts),
        lambda other: Hapkit(other.port, COUNT),
        lambda other, k: COUNT * counts(k),
        lambda other: other.wrong == 0 and other.starts == 1,
        opening=1,
        zeros=0,
        law=lambda reading: 1e-2 * reading,
        given=lambda force: max(-32.767, min(32.767, force)),
        rounded=5.01e-4,
    ),
    "inverse": Line(
        InverseEmulator,
        lambda other: Inverse(address=other.address),
        lambda other, k: other.positions[k]["z"],
        lambda other: other.closed_by_client and all(force == {"x": 0, "y": 0} for force in other.others),
        opening=1,
        zeros=2,
        law=lambda reading: -300.0 * max(0.0, reading - 0.010),
        rounded=0.6e-6,
    ),
    "haply": Line(
        partial(HaplyEmulator, place),
        lambda other: HaplyPantograph(other.port),
        lambda other, k: place(k)[0],
        lambda other: True,
        opening=1,
        each=2,
        away=2e-4,
    ),
}

TOLD = {
    Fault.CLOSED: [CLOSED],
    Fault.HALF_FRAME: [GARBLED, GARBLED],
    Fault.GARBAGE: [GARBLED, GARBLED],
    Fault.SILENCE: [SILENT, SILENT],
    Fault.WRONG_CHECKSUM: [GARBLED, GARBLED],
    Fault.LATE_ANSWERS: [SILENT, STALE],
}
ALL = [(name, fault) for name in LINES if name != "haply" for fault in TOLD]
ALL.remove(("inverse", Fault.WRONG_CHECKSUM))  # it has none
ONCE = [("odrive", fault) for fault in TOLD if fault is not Fault.CLOSED]
ONCE += [("haply", Fault.HALF_FRAME), ("haply", Fault.GARBAGE), ("haply", Fault.LATE_ANSWERS)]
ONCE += [("inverse", Fault.LATE_ANSWERS)]

TURNED = {
    "feetech": LINES["feetech"]._replace(
        adapter=lambda other: Feetech(other.port, full_duty_torque=2.9, reverse=True),
        given=lambda force: -force / 2.9,
    ),
    "moteus": LINES["moteus"]._replace(
        emulator=partial(MoteusEmulator, TURNS), adapter=lambda other: Moteus(other.port, watchdog=0.08)
    ),
    "hapkit": LINES["hapkit"]._replace(
        adapter=lambda other: Hapkit(other.port, -COUNT),
        reading=lambda other, k: -COUNT * counts(k),
        given=lambda force: max(-32.767, min(32.767, -force)),
    ),
}
"""In the other sense; a moteus without checksums."""


@pytest.mark.parametrize(
    ("line", "periods"),
    [(line, 2_000) for name, line in LINES.items() if name != "haply"]
    + [(line, 1_000) for line in TURNED.values()],
    ids=[*(name for name in LINES if name != "haply"), *(f"{name} turned" for name in TURNED)],
)
def test_two_thousand_exchanges(line, periods):
    """Each position is that of its own exchange; each force arrives, to the last digit of the protocol."""
    with line.emulator() as other:
        run = drive(line.adapter(other), periods, line.law)
    assert run.statuses == [GOOD] * periods
    assert line.reads(run, other, range(periods))
    forces = [command.force for command in other.commands]
    begin, end = line.zeros, line.zeros + periods
    assert forces[:begin] == [0.0] * line.zeros
    assert forces[begin:end] == pytest.approx([line.given(f) for f in run.forces], rel=0, abs=line.rounded)
    asked = [command.exchange for command in other.commands[begin:end]]
    assert asked == [line.at(k) + 1 for k in range(periods)]
    assert forces[end:] == [0.0] * len(forces[end:])
    assert len(forces) > end
    assert min(run.forces) < -0.01
    assert line.right(other)


@pytest.mark.parametrize(("name", "fault"), ALL)
def test_a_fault_is_told_at_its_first_exchange_and_ends_the_force(name, fault):
    """It is held for one period at most, then 0 arrives; a Haply board's is in its own file."""
    line, good, told = LINES[name], 30, TOLD[fault]

    def attempt(wait):
        with line.emulator(fault=fault, at=line.at(good)) as other:
            return other, drive(line.adapter(other), 100, line.law, wait=wait)

    other, run = drive_into([GOOD] * good + told, attempt)
    assert run.statuses == [GOOD] * good + told
    assert line.reads(run, other, range(good))
    assert run.forces[good - 1] != 0.0
    assert run.forces[good:] == [run.forces[good - 1]] * (len(told) - 1) + [0.0]
    assert run.zeroed_after == len(told) - 1
    if fault is not Fault.CLOSED:
        assert [command.force for command in other.commands[-3:]] == [0.0] * 3
        assert line.right(other)


@pytest.mark.parametrize("fault", [Fault.DUPLICATE, Fault.SLOW])
@pytest.mark.parametrize("name", LINES)
def test_answers_that_come_twice_or_in_pieces_are_no_fault(name, fault):
    """No later sample is old by them."""
    line = LINES[name]
    with line.emulator(fault=fault, at=line.at(20)) as other:
        run = drive(line.adapter(other), 300, line.law)
    assert run.statuses == [GOOD] * 300
    assert line.reads(run, other, range(300))


@pytest.mark.parametrize(("name", "fault"), ONCE)
def test_one_bad_exchange_costs_one_sample(name, fault):
    """The next question waits for the old answer, or finds where the next one begins, and has its own."""
    line, good = LINES[name], 21
    expected = [GOOD] * good + [TOLD[fault][0]] + [GOOD] * (59 - good)

    def attempt(wait):
        with line.emulator(fault=fault, at=line.at(good)) as other:
            other.until = other.at + 1
            return other, drive(line.adapter(other), 60, line.law, wait=wait)

    other, run = drive_into(expected, attempt)
    assert run.statuses == expected
    assert line.reads(run, other, [*range(good), *range(good + 1, 60)])


def sets(**attributes):
    return lambda other: vars(other).update(attributes)


def has(name, value):
    return lambda other: other.properties.update({f"axis0.{name}": value})


def leaves(mode, code):
    def change(other):
        other.mode, other.fault_code = mode, code
        other._command = lambda values, written: other.command(values.get(0x022, 0.0))

    return change


@pytest.mark.parametrize(
    ("name", "change"),
    [
        ("dynamixel", lambda other: other.put(98, 1, -1)),  # its watchdog has expired
        ("dynamixel", lambda other: other.put(64, 1, 0)),  # somebody puts its torque off
        ("dynamixel", sets(alert=True)),
        ("feetech", sets(state=0b100)),
        ("moteus", leaves(1, 38)),  # a fault
        ("moteus", leaves(11, 0)),  # its watchdog
        ("moteus", leaves(12, 0)),
        ("moteus", leaves(0, 0)),  # a stop
        ("moteus", lambda other: other.write(other.line(b"ERR no such thing"))),  # to a torque
        ("hapkit", sets(cut_at=0)),
        ("inverse", sets(not_ready_from=0)),
    ],
)
def test_a_device_that_reports_that_it_gives_no_force_any_more_is_refused_at_once(name, change):
    line = LINES[name]
    with line.emulator() as other:
        run = drive(line.adapter(other), 100, changing(28, lambda: change(other)))
    assert run.statuses == [GOOD] * 28 + [REFUSED]
    assert (run.forces[-1], run.zeroed_after) == (0.0, 0)
    assert other.commands[-1].force == 0.0 or name == "dynamixel"
    assert line.right(other) or name == "moteus"


LEFT = {
    "dynamixel": lambda other: other.table[64] == 0,
    "feetech": lambda other: other.table[40] == 1,
    "moteus": lambda other: other.commands == [],
    "odrive": lambda other: other.frozen or not any(line[:1] in ("w", "c") for line in other.lines),
}
"""Nothing was set before it was refused."""


@pytest.mark.parametrize(
    ("name", "change", "said"),
    [
        (
            "dynamixel",
            lambda other: (other.put(70, 1, 0b100100), setattr(other, "alert", True)),
            "overheating, overload",
        ),
        ("dynamixel", lambda other: other.put(0, 2, 999), "current unit of .*999.*current_unit"),
        ("feetech", sets(state=0b100001), "supply voltage, overload"),
        ("feetech", lambda other: other.table.__setitem__(30, 3), "angular resolution 3"),  # coarser counts
        (
            "moteus",
            sets(_command=lambda *_: None, mode=1, fault_code=36),
            r"mode 1, fault 36 \(motor not configured",
        ),
        ("moteus", sets(bus_is_off=True), "ERR"),
        (
            "moteus",
            lambda other: other.configuration.update({"servo.fixed_voltage_mode": 1}),
            "gives no torque",
        ),
        ("odrive", has("config.enable_sensorless_mode", "1"), "spins the motor"),
        ("odrive", has("motor.config.motor_type", "2"), "is volts"),
        (
            "odrive",
            lambda other: other.frozen.add("axis0.config.watchdog_timeout"),
            "watchdog_timeout .* stays 0.000000 when set to 0.05",
        ),
    ],
)
def test_what_is_wrong_with_a_device_is_said_when_it_is_opened(name, change, said, monkeypatch):
    monkeypatch.setattr(
        "zwidth.machine.servo.devices.moteus._START_TIME", 0.0
    )  # given up at the first answer
    with LINES[name].emulator() as other:
        change(other)
        with pytest.raises(InputError, match=said):
            LINES[name].adapter(other).open(1e-3)
        assert LEFT[name](other)


@pytest.mark.parametrize(
    ("name", "alone", "shorter", "said"),
    [
        (
            "dynamixel",
            {"identifier": 7},
            {"serial_port._WAIT": 10**8},
            "Dynamixel servo 1 .* does not answer",
        ),
        ("feetech", {"identifier": 7}, {"serial_port._WAIT": 10**8}, "Feetech servo 1 .* does not answer"),
        (
            "moteus",
            {"identifier": 2},
            {"moteus._START_TIME": 0.0, "moteus._ONE_TRY": 1e8},
            r"moteus 1 .* does not answer.*id\.id",
        ),
        ("haply", {"fault": Fault.SILENCE}, {"haply._FIRST_ANSWER": 1e8}, "no answer in time.*firmware"),
        ("hapkit", {"fault": Fault.CLOSED}, {}, "other side has closed.*examples/hapkit"),
    ],
)
def test_nobody_at_the_other_end_is_told_with_what_to_look_at(name, alone, shorter, said, monkeypatch):
    for setting, value in shorter.items():
        monkeypatch.setattr(f"zwidth.machine.servo.devices.{setting}", value)
    with LINES[name].emulator(**alone) as other, pytest.raises(InputError, match=said):
        LINES[name].adapter(other).open(1e-3)


@pytest.mark.parametrize(
    ("make", "given", "said"),
    [
        (Dynamixel, {"torque_per_current": 0.0}, "torque per current must be > 0"),
        (Dynamixel, {"torque_per_current": math.nan}, "expected a finite number"),
        (Dynamixel, {"torque_per_current": 1.0, "identifier": 253}, "identifier must be 0 to 252"),
        (Dynamixel, {"torque_per_current": 1.0, "identifier": 1.5}, "identifier must be 0 to 252"),
        (Dynamixel, {"torque_per_current": 1.0, "watchdog": 0.0}, "watchdog must be 20 ms"),
        (Dynamixel, {"torque_per_current": 1.0, "watchdog": 2.56}, "watchdog must be 20 ms"),
        (Dynamixel, {"torque_per_current": 1.0, "watchdog": math.inf}, "expected a finite number"),
        (Dynamixel, {"torque_per_current": 1.0, "current_unit": -1.0}, "current unit must be > 0"),
        (Feetech, {"full_duty_torque": 0.0}, "full-duty torque must be > 0"),
        (Feetech, {"full_duty_torque": math.inf}, "expected a finite number"),
        (Feetech, {"full_duty_torque": 1.0, "identifier": 254}, "identifier must be 0 to 253"),
        (Moteus, {"identifier": 112}, "identifier must be 1 to 111"),
        (Moteus, {"identifier": 0}, "identifier must be 1 to 111"),
        (Moteus, {"watchdog": 0.0005}, "watchdog must be 1 ms"),
        (Moteus, {"watchdog": 40.0}, "watchdog must be 1 ms"),
        (Moteus, {"watchdog": math.nan}, "expected a finite number"),
        (ODrive, {"axis": 2}, "must be 0 or 1"),
        (ODrive, {"watchdog": 0.0}, "must be > 0"),
        (ODrive, {"watchdog": math.nan}, "expected a finite number"),
        (Hapkit, {"count": 0.0}, "not 0"),
        (Hapkit, {"count": math.nan}, "expected a finite number"),
        (Hapkit, {"count": COUNT, "baud": 0}, "baud is a whole number"),
        (HaplyPantograph, {"axis": "z"}, "axis is one of"),
        (HaplyPantograph, {"version": 1}, "version is one of"),
        (HaplyPantograph, {"number": 0}, "from 1 to 255"),
        (HaplyPantograph, {"joints": [HaplyJoint(1, "ccw", 0.0, 4880.0)]}, "2 joints"),
        (HaplyPantograph, {"joints": [HaplyJoint(1, "ccw", 0.0, 4880.0)] * 2}, "ports 1, 1"),
        (HaplyPantograph, {"links": (0.07, -0.09, 0.0)}, "links must be > 0"),
        (HaplyPantograph, {"links": (0.07, 0.09)}, "three lengths"),
    ],
)
def test_what_cannot_be_is_refused_before_a_port_is_opened(make, given, said):
    with pytest.raises(InputError, match=said):
        make(NOBODY, **given)


@pytest.mark.parametrize(
    ("connection", "period", "said"),
    [
        (Dynamixel(NOBODY, torque_per_current=1.8), 0.021, "two sample periods"),
        (Moteus(NOBODY, watchdog=0.01), 0.006, "two sample periods"),
        (ODrive(NOBODY), 0.02, "must be 80 ms or more"),  # four sample periods
        (Hapkit(NOBODY, COUNT), 10e-3, "below 10 ms"),  # two of them within 20 ms
        (Hapkit(NOBODY, COUNT, baud=115_200), 1e-3, "1.39 ms, more than half"),  # (7 + 9) bytes of 10 bits
        (ForceDimension(), 10e-3, "below 10 ms"),
    ],
)
def test_a_period_that_the_watchdog_or_the_line_forbids_opens_no_port(connection, period, said):
    with pytest.raises(InputError, match=said):
        connection.open(period)
