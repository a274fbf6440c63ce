"""A serial port opened so that compiled code can read and write its descriptor without waiting.

A read of a terminal that finds nothing must differ from the end of the line: with VMIN = 1 it is an error
(EAGAIN) in the first case and 0 bytes in the second; with VMIN = 0, which pyserial takes for a timeout of 0
alone, it is 0 bytes in both (termios(3), non-canonical mode).  `inter_byte_timeout` = 0 asks for VMIN = 1.
"""

from __future__ import annotations

import importlib
import os
from abc import abstractmethod
from contextlib import suppress
from typing import Any

from zwidth import installing
from zwidth.errors import InputError
from zwidth.machine.servo.connection import (
    CLOSED,
    DESCRIPTOR,
    FORCE,
    GOOD,
    SILENT,
    STATUS,
    CompiledConnection,
    Opened,
    blank,
)
from zwidth.machine.servo.devices.frames import get_unsigned
from zwidth.machine.servo.posix import Bytes, check_supported, discard, now
from zwidth.native.compiled import Array
from zwidth.quantity.text import shown


def open_port(port: str, baud: int) -> Any:
    """The port, open for this process alone; its `fileno()` neither blocks on reading nor on writing.

    What had come before is thrown away.  Where a USB adapter gathers bytes before it hands them on (FTDI: for
    16 ms) and its driver can be told not to, it is told.  A pseudo-terminal has no baud rate, and USB devices
    that only look like serial ports ignore it [1/s].
    """
    check_supported()
    serial = installing.imported("serial", "pyserial, which opens serial ports,", "serve")
    try:
        opened = serial.Serial(port, baud, timeout=0, write_timeout=0, inter_byte_timeout=0, exclusive=True)
    except (serial.SerialException, ValueError, OSError) as error:
        raise InputError(_refused(port, baud, error)) from None
    with suppress(
        AttributeError, NotImplementedError, OSError, ValueError
    ):  # not every system and driver has it
        opened.set_low_latency_mode(True)
    opened.reset_input_buffer()
    return opened


def _refused(port: str, baud: int, error: Exception) -> str:
    """What to try, by the system's own reason where it gave one."""
    if isinstance(error, ValueError):
        return f"{port} does not take {baud} baud; give one of the rates that its adapter has"
    match getattr(error, "errno", None):
        case 2:
            return f"there is no port {port}{_others()}; is the device plugged in and powered?"
        case 13:
            return (
                f"{port} may not be opened by this user; on most Linux systems: "
                "sudo usermod -a -G dialout $USER, then log in again"
            )
        case 11 | 16 | 35:
            return f"{port} is in use; end the other program that has it open"
        case _:
            return f"{port} is no serial port that can be opened{_others()}"


def _others() -> str:
    """Which ports there are."""
    tools: Any = importlib.import_module("serial.tools.list_ports")
    found = sorted(port.device for port in tools.comports())
    return f" (there are: {', '.join(found)})" if found else " (no serial port is there at all)"


# A servo on a bus: a register is written without an answer and read back.  So it is the same whether a servo
# answers writes or not, and what it did not take is seen.


_TRIES = 3
_WAIT = 200_000_000
"""For an answer before the loop [ns]: an adapter may hold bytes back for 16 ms, a servo writes its EEPROM."""

_REMEMBERED = 16
"""Numbers of the compiled functions."""


class BusServo(CompiledConnection):
    """A servo at a serial port."""

    def __init__(self, port: str, identifier: int, baud: int) -> None:
        self.port = port
        self.identifier = identifier
        self.baud = baud
        self._line: Any = None
        self._opened: Opened | None = None
        self._before: list[tuple[int, int, int]] = []

    def open(self, sample_period: float) -> Opened:
        """Reach the servo, read what it is, set it up; force 0."""
        self._line = open_port(self.port, self.baud)
        self._opened = blank(_REMEMBERED)
        self._opened.memory[DESCRIPTOR] = self._line.fileno()
        self._before = []
        try:
            self._prepare(self._opened.memory)
        except InputError:
            self.close()
            raise
        return self._opened

    def close(self) -> None:
        """Force 0, the motor off, the registers as they were before."""
        if self._line is None or self._opened is None:
            return
        memory = self._opened.memory
        memory[FORCE] = 0.0
        # before the first change the servo may be another program's, holding up an arm
        if self._before and type(self).apply(*self._opened) != CLOSED:
            with suppress(InputError):
                self._leave()
                for address, count, value in reversed(self._before):
                    self._set(address, count, value)
        with suppress(OSError):
            self._line.close()
        self._line = None

    @property
    @abstractmethod
    def _name(self) -> str:
        """Which kind of servo, and which one."""

    @abstractmethod
    def _question(self, out: Bytes, address: int, count: int) -> int:
        """Write the packet that asks for registers; how many bytes."""

    @abstractmethod
    def _order(self, out: Bytes, address: int, count: int, value: int) -> int:
        """Write the packet that sets one; how many bytes."""

    @abstractmethod
    def _receive(self, descriptor: int, inbox: Bytes, count: int, until: int) -> int:
        """Wait for the answer: inbox[0] is then the state of the servo, the registers follow."""

    @abstractmethod
    def _prepare(self, memory: Array) -> None:
        """Make the servo ready to give a force, and write what the compiled functions need."""

    @abstractmethod
    def _leave(self) -> None:
        """The motor off."""

    @abstractmethod
    def _fault(self, state: int) -> str:
        """What the state of the servo says, in words."""

    def _change(self, address: int, count: int, value: int) -> None:
        self._before.append((address, count, self._read(address, count)))
        self._set(address, count, value)

    def _set(self, address: int, count: int, value: int) -> None:
        """Write a register until it reads so, whatever fault the servo reports: it may have to be left."""
        mask = (1 << 8 * count) - 1
        for _ in range(_TRIES):
            self._send(address, count, value)
            if self._read(address, count, faulty=True) == value & mask:
                return
        raise InputError(
            f"{self._name} does not take {value} in its register {address}; it may be of another series, or "
            "the register locked"
        )

    def _send(self, address: int, count: int, value: int) -> None:
        """Write a register, and let nothing be known of what became of it."""
        assert self._opened is not None
        out = self._opened.outbox
        with suppress(OSError):  # seen when the register is read
            os.write(self._line.fileno(), bytes(out[: self._order(out, address, count, value)]))

    def _read(self, address: int, count: int, *, faulty: bool = False) -> int:
        """A register; of a servo that reports a fault only where `faulty` says so."""
        assert self._opened is not None
        inbox, out, descriptor = self._opened.inbox, self._opened.outbox, self._line.fileno()
        status = SILENT
        for _ in range(_TRIES):
            discard(descriptor, inbox)
            with suppress(OSError):
                os.write(descriptor, bytes(out[: self._question(out, address, count)]))
            status = self._receive(descriptor, inbox, count, now() + _WAIT)
            if status in (GOOD, CLOSED):
                break
        if status != GOOD:
            raise InputError(
                f"{self._name} does not answer: {STATUS[status]}; is it powered, has it this identifier and "
                "rate, and does it answer reads?"
            )
        if inbox[0] != 0 and not faulty:
            raise InputError(
                f"{self._name} reports a fault: {self._fault(int(inbox[0]))}; switch it off and on"
            )
        return int(get_unsigned(inbox, 1, count))


def check_watchdog(watchdog: float, sample_period: float) -> None:
    """Refuse a watchdog [s], which ends a force by itself, that one late sample would set off."""
    if watchdog < 2 * sample_period:
        raise InputError(
            f"watchdog must be at least two sample periods, {shown(2 * sample_period, 's', 6)}, or one late "
            f"sample ends the force; got {shown(watchdog, 's', 6)}"
        )
