"""A Dynamixel servo of the X series in its current control mode, over a serial bus with Protocol 2.0.

    τ = k I,   I = n u

k [N·m/A] is not published:  ROBOTIS gives a curve of torque over current for each servo, gears and all, and
says that it is no constant; it is asked for.  u [A] is the unit of the register, by the model.

Each sample is two packets: a question whose answer is waited for, and a current that nobody answers.
Position, watchdog and torque enable are read together, through indirect addresses.  Questions ask for 6, 7
and 8 bytes in turn, so that an answer to one of the two questions before is known.

Source: ROBOTIS e-Manual, "XM430-W350" and the pages of the other models, control tables.
"""

from __future__ import annotations

import math
from contextlib import suppress
from typing import Any, ClassVar, Literal

from zwidth.errors import InputError
from zwidth.machine.servo.connection import (
    CLOSED,
    DESCRIPTOR,
    FORCE,
    GOOD,
    LEAVES,
    OWN,
    READING,
    REFUSED,
    REFUSES,
    RESTORES,
    SETS,
    TELLS,
    UNTIL,
    Opened,
    Setting,
    exchanged,
)
from zwidth.machine.servo.devices.dynamixel_packets import ALERT, put_read, put_write, receive
from zwidth.machine.servo.devices.frames import counted_on, get_signed, unwritten
from zwidth.machine.servo.devices.serial_port import BusServo, check_watchdog
from zwidth.machine.servo.posix import Bytes, discard, write_all
from zwidth.native.compiled import Array
from zwidth.quantity.text import shown
from zwidth.quantity.units import in_si

# What it remembers: the servo; where the registers that are asked for stand together; how many questions it
# has asked; the position before [counts] and whether there is one; counts of current per N·m and at most; the
# watchdog that is still to be set.
SERVO, TOGETHER, ASKED, BEFORE, SEEN, PER_TORQUE, MOST, WATCHDOG = range(OWN, OWN + 8)

COUNTS = 4096.0
"""Of a turn of the output."""

_MODEL, _FIRMWARE, _RETURN_DELAY, _DRIVE_MODE, _OPERATING_MODE = 0, 6, 9, 10, 11
_PWM_LIMIT, _CURRENT_LIMIT, _GOAL_PWM = 36, 38, 100
_TORQUE_ENABLE, _REGISTERED, _HARDWARE_ERROR, _BUS_WATCHDOG, _GOAL_CURRENT = 64, 69, 70, 98, 102
_PRESENT_POSITION, _INDIRECT_ADDRESS = 132, 168

_ASKED_FOR = (
    *range(_PRESENT_POSITION, _PRESENT_POSITION + 4),
    _BUS_WATCHDOG,
    _TORQUE_ENABLE,
    _HARDWARE_ERROR,
    _REGISTERED,
)
"""In this order; the last two only make the questions differ. (There is no LED, 65, on the XW models.)"""

_SHORTEST, _LENGTHS = 6, 3
_WATCHDOG_UNIT, _LONGEST_WATCHDOG, _WATCHDOG_SINCE = 0.02, 127, 38
_EXPIRED = 0xFF
_REVERSE, _SLAVE, _ON_BY_GOAL = 1, 2, 8
"""Bits of the drive mode."""
_FULL_PWM = 885

_UNITS = {
    1020: ("XM430-W350", 2.69e-3),
    1030: ("XM430-W210", 2.69e-3),
    1110: ("XH540-W150", 2.69e-3),
    1120: ("XM540-W270", 2.69e-3),
}
"""Model number: name, unit of goal current [A]; ROBOTIS e-Manual, the page of each model.

The page of the XL330-M288 gives two units; the XC330 measures the current of its supply, not of its motor.
"""

_INDIRECT_DATA = (224, 208)
"""Where the first register of indirect data may be: on most models, on those of the 330 size."""


@exchanged
def _measure(memory: Array, inbox: Bytes, outbox: Bytes) -> int:
    """Ask for the position; whatever came before is old."""
    descriptor, servo = int(memory[DESCRIPTOR]), int(memory[SERVO])
    count = _SHORTEST + int(memory[ASKED]) % _LENGTHS
    memory[ASKED] += 1.0
    if discard(descriptor, inbox) == -2:
        return CLOSED
    if not write_all(descriptor, outbox, put_read(outbox, servo, int(memory[TOGETHER]), count)):
        return unwritten(descriptor, inbox)
    status = receive(descriptor, inbox, servo, count, int(memory[UNTIL]))
    if status != GOOD:
        return status
    if inbox[0] != 0 or inbox[5] == _EXPIRED or inbox[6] != 1:  # hardware, watchdog, torque enable
        return REFUSED
    position = float(get_signed(inbox, 1, 4))
    memory[READING] = counted_on(memory, BEFORE, position, COUNTS) * (2.0 * math.pi / COUNTS)
    return GOOD


@exchanged
def _apply(memory: Array, inbox: Bytes, outbox: Bytes) -> int:
    """Set the goal current; a value beyond the limit would be refused, unseen, and the old one stay.

    With the first one the watchdog begins.
    """
    descriptor, servo = int(memory[DESCRIPTOR]), int(memory[SERVO])
    most = memory[MOST]
    current = math.floor(min(max(memory[FORCE] * memory[PER_TORQUE], -most), most) + 0.5)
    count = put_write(outbox, 0, servo, _GOAL_CURRENT, 2, int(current))
    if memory[WATCHDOG] > 0.0:
        count = put_write(outbox, count, servo, _BUS_WATCHDOG, 1, int(memory[WATCHDOG]))
        memory[WATCHDOG] = 0.0
    return GOOD if write_all(descriptor, outbox, count) else unwritten(descriptor, inbox)


class Dynamixel(BusServo):
    """``τ = k I``; angle of the output [rad], counted on over the turns.

    Its watchdog begins with the first torque of the loop.

    Parameters
    ----------
    port
        Of the adapter: "/dev/ttyUSB0".
    torque_per_current
        k at the output [N·m/A], > 0: of your own measurement, or the slope of the model's performance graph.
    identifier
        Of the servo on the bus, 0 to 252.
    baud
        Of the bus [1/s].
    watchdog
        After so long without any packet on the bus the servo stops [s]: a multiple of 20 ms, up to 2.54 s.
    current_unit
        u [A], of a model that is not known here, or another than the e-Manual's.
    reverse
        True where a positive current turns the servo towards smaller positions.  None: not, and a servo whose
        drive mode is Reverse is refused, for by the e-Manual that inverts positions alone on most models.
    """

    motion: ClassVar[Literal["linear", "rotary"]] = "rotary"
    maker: ClassVar[str] = (
        "ROBOTIS e-Manual, the model's page; ROBOTIS-GIT/emanual, _includes/en/dxl/control_table_: drivemode "
        "at 028a13d2, buswatchdog at 01a2df19, goal_pwm at 0b774a35"
    )
    settings: ClassVar[tuple[Setting, ...]] = (
        ("Model Number 0", "", "size: the unit of the current", REFUSES, "Model Number, Goal Current"),
        ("Firmware Version 6", "", "end: before 38 there is no watchdog", REFUSES, "buswatchdog.md:20"),
        ("Drive Mode 10", "0", "sign: Reverse, bit 0, inverts positions, on the X540 and XW540 currents too; "
         "Slave, bit 1, ignores a goal; with bit 3 a goal puts on a torque that is off", REFUSES,
         "drivemode.md:17, 21, 23, 37, 57"),
        ("Operating Mode 11", "3", "what is controlled: 0, the current", RESTORES, "page of the model"),
        ("Return Delay Time 9", "250", "delay of the position, 0.5 ms", RESTORES, "page of the model"),
        ("Current Limit 38", "of the model", "size: a goal beyond is refused, the last one stays", TELLS,
         "current_limit.md"),
        ("PWM Limit 36", "885", "size: less than 885 is less voltage, and less torque at a speed", TELLS,
         "goal_pwm.md:1"),
        ("Goal PWM 100", "PWM Limit", "size: as PWM Limit", TELLS, "goal_pwm.md:1"),
        ("Goal Current 102", "0", "the torque; 0 before the torque is on", SETS, "goal_current.md"),
        ("Torque Enable 64", "0", "whether there is a torque; 0 in the end", SETS, "page of the model"),
        ("Bus Watchdog 98", "0", "end: how long the last current acts; 0 in the end", SETS,
         "buswatchdog.md:6 to 14"),
        ("Indirect Address 168 to 182", "224 and on", "what is read in one piece; they stay", SETS,
         "indirect_data.md"),
        ("Hardware Error Status 70", "0", "end: an alert", TELLS, "hardware_error_status.md"),
        ("Shutdown 63", "of the model", "end: which alerts put the torque off", LEAVES, "page of the model"),
        ("Temperature, Voltage Limit 31 to 34", "of the model", "end: an alert", LEAVES, "page of the model"),
        ("Secondary ID 12", "255", "goals of another servo with this identifier act here too", LEAVES,
         "page of the model"),
        ("PWM Slope 62", "140", "delay of the torque, of the 330 size", LEAVES, "page of the model"),
        ("Homing Offset 20", "0", "where the zero is", LEAVES, "homingoffset.md"),
    )  # fmt: skip
    measure: ClassVar[Any] = staticmethod(_measure)
    apply: ClassVar[Any] = staticmethod(_apply)

    def __init__(
        self,
        port: str,
        *,
        torque_per_current: float | str,
        identifier: int = 1,
        baud: int = 1_000_000,
        watchdog: float | str = 0.04,
        current_unit: float | str | None = None,
        reverse: bool | None = None,
    ) -> None:
        if not (isinstance(identifier, int) and 0 <= identifier <= 252):
            raise InputError(f"identifier must be 0 to 252, those of a Dynamixel, got {identifier!r}")
        torque_per_current = in_si(torque_per_current, "N*m/A", "torque_per_current")
        watchdog = in_si(watchdog, "s", "watchdog")
        current_unit = None if current_unit is None else in_si(current_unit, "A", "current_unit")
        if torque_per_current <= 0:
            raise InputError(
                f"torque per current must be > 0, got {torque_per_current!r} N·m/A: with it forces become "
                "currents; measure it, or take the slope of the servo's performance graph"
            )
        if not 0 < watchdog <= _LONGEST_WATCHDOG * _WATCHDOG_UNIT:
            raise InputError(
                f"watchdog must be 20 ms to 2.54 s, what the register holds, got {watchdog!r} s; "
                "take the shortest that the loop keeps up with"
            )
        if current_unit is not None and current_unit <= 0:
            raise InputError(f"current unit must be > 0, got {current_unit!r} A: the register counts in it")
        super().__init__(
            port, identifier, baud, put_read, lambda out, *order: put_write(out, 0, *order), receive
        )
        self.torque_per_current = torque_per_current
        self._steps = math.ceil(watchdog / _WATCHDOG_UNIT - 1e-9)  # 0.14/0.02 is a little more than 7
        self.watchdog = self._steps * _WATCHDOG_UNIT
        self.current_unit = current_unit
        self.reverse = reverse
        self._model = "servo"
        self._most_torque = math.nan
        self._pwm = _FULL_PWM

    def _check_period(self, sample_period: float) -> None:
        check_watchdog(self.watchdog, sample_period)

    @property
    def on_silence(self) -> str:
        """What the servo does by itself."""
        return (
            f"after {shown(self.watchdog, 's', 6)} without a packet on the bus, to any servo, it stops and "
            "takes no current until its watchdog is cleared (firmware 38 and later)"
        )

    def describe(self) -> str:
        """Which servo, its numbers, and what has been met of it."""
        limit = "" if math.isnan(self._most_torque) else f", {shown(self._most_torque, 'N*m', 3)} at most"
        if self._pwm < _FULL_PWM:
            limit += f", with {shown(self._pwm / _FULL_PWM, '%', 3)} of its supply's voltage"
        constant = shown(self.torque_per_current, "N*m/A", 6)
        return f"{self._name}, {constant}{limit}; tried against an emulator only"

    @property
    def _name(self) -> str:
        return f"Dynamixel {self._model} {self.identifier} at {self.port}"

    def _prepare(self, opened: Opened) -> None:
        """Torque off for what stands in the EEPROM; the goal is 0 before it is on again.

        A change of the operating mode sets the goal current to the current limit.
        """
        memory = opened.memory
        memory[SERVO] = self.identifier
        unit = self._unit()
        limit, mode = self._read(_CURRENT_LIMIT, 2), self._drive_mode()
        self._set(_TORQUE_ENABLE, 1, 0)
        self._set(_BUS_WATCHDOG, 1, 0)
        self._change(_RETURN_DELAY, 1, 0)
        if mode & _ON_BY_GOAL:
            self._change(_DRIVE_MODE, 1, mode & ~_ON_BY_GOAL)
        self._change(_OPERATING_MODE, 1, 0)
        for i, address in enumerate(_ASKED_FOR):
            self._set(_INDIRECT_ADDRESS + 2 * i, 2, address)
        self._set(_GOAL_CURRENT, 2, 0)
        self._set(_TORQUE_ENABLE, 1, 1)
        if self._read(_GOAL_CURRENT, 2) != 0:
            raise InputError(f"{self._name} has a goal current of its own as soon as its torque is on")
        memory[TOGETHER] = self._together()
        memory[PER_TORQUE] = (-1.0 if self.reverse else 1.0) / (self.torque_per_current * unit)
        memory[MOST], memory[WATCHDOG] = limit, self._steps
        self._most_torque = limit * unit * self.torque_per_current
        self._pwm = min(self._read(_PWM_LIMIT, 2), self._read(_GOAL_PWM, 2))

    def _drive_mode(self) -> int:
        """Refused where the goal current is ignored, or its sense is not known."""
        mode = self._read(_DRIVE_MODE, 1)
        if mode & _SLAVE:
            raise InputError(
                f"{self._name} is a slave by its Drive Mode {_DRIVE_MODE}: it follows the cable of its "
                "master and ignores every goal current; serve the master, or clear bit 1"
            )
        if mode & _REVERSE and self.reverse is None:
            raise InputError(
                f"{self._name} is reversed by its Drive Mode {_DRIVE_MODE}, which inverts positions, and "
                "currents on X540 and XW540 alone: on others a wall pulls in; clear bit 0, or try by hand "
                "which way a current turns it and give reverse = true or false"
            )
        return mode

    def _together(self) -> int:
        """Where position, watchdog and torque enable are now read in one piece: the last two are 0 and 1."""
        for address in _INDIRECT_DATA:
            with suppress(InputError):  # there may be no register
                if self._read(address, _SHORTEST) >> 32 == 0x0100:
                    return address
        raise InputError(
            f"{self._name} has no indirect data where the X series has them; it may be of another one"
        )

    def _unit(self) -> float:
        """Of the currents [A]; checked on the way: a model that is known, with a watchdog."""
        number = self._read(_MODEL, 2)
        self._model, unit = _UNITS.get(number, (f"model {number}", self.current_unit))
        if self.current_unit is not None:
            unit = self.current_unit
        if unit is None:
            known = ", ".join(name for name, _ in _UNITS.values())
            raise InputError(
                f"the current unit of {self._name} is not known here (known are {known}); give current_unit: "
                "it stands on the model's page of the e-Manual, under Goal Current"
            )
        firmware = self._read(_FIRMWARE, 1)
        if firmware < _WATCHDOG_SINCE:
            raise InputError(
                f"{self._name} has the firmware {firmware}, and the bus watchdog needs {_WATCHDOG_SINCE}: "
                "without it a servo keeps its last current when the host dies; update it with Dynamixel "
                "Wizard"
            )
        return unit

    def _leave(self) -> None:
        """The torque off before the watchdog: whether the goal comes back with that is not documented."""
        self._set(_TORQUE_ENABLE, 1, 0)
        self._set(_BUS_WATCHDOG, 1, 0)

    def _fault(self, state: int) -> str:
        if state & ALERT == 0:
            return f"error {state} of the e-Manual"
        bits = self._read(_HARDWARE_ERROR, 1, faulty=True)
        words = [word for bit, word in _HARDWARE.items() if bits >> bit & 1]
        return ", ".join(words) or f"hardware error status {bits}"


_HARDWARE = {
    0: "input voltage",
    2: "overheating",
    3: "encoder",
    4: "electrical shock or too little power",
    5: "overload",
}
"""Bits of the hardware error status; ROBOTIS e-Manual, "Shutdown"."""
