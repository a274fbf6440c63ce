"""A serial port opened so that compiled code can read and write its descriptor without waiting.

A read of a terminal that finds nothing must differ from the end of the line: with VMIN = 1 it is an error
(EAGAIN) in the first case and 0 bytes in the second; with VMIN = 0, which pyserial takes for a timeout of 0
alone, it is 0 bytes in both (termios(3), non-canonical mode).  `inter_byte_timeout` = 0 asks for VMIN = 1.
"""

from __future__ import annotations

import importlib
import os
from abc import abstractmethod
from collections.abc import Callable
from contextlib import suppress
from typing import Any, ClassVar

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
from zwidth.machine.servo.posix import check_supported, discard, now
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


_TRIES = 3
_WAIT = 200_000_000
"""For an answer before the loop [ns]: an adapter may hold bytes back for 16 ms, a servo writes its EEPROM."""

_REMEMBERED = 24
"""Numbers of the compiled functions, the most that any device has."""


class SerialConnection(CompiledConnection):
    """A device at a serial port."""

    port: str
    baud: int
    taken: ClassVar[int] = 512
    """Bytes that are taken at once."""

    _line: Any = None
    _opened: Opened | None = None

    def open(self, sample_period: float) -> Opened:
        """Reach the device, read what it is, set it up; force 0."""
        self._check_period(sample_period)
        self._line = open_port(self.port, self.baud)
        self._opened = blank(_REMEMBERED, inbox=self.taken)
        self._opened.memory[DESCRIPTOR] = self._line.fileno()
        try:
            self._prepare(self._opened)
        except InputError:
            self.close()
            raise
        return self._opened

    def close(self) -> None:
        """Force 0, the device as it was before; then the port."""
        if self._line is None or self._opened is None:
            return
        self._opened.memory[FORCE] = 0.0
        with suppress(OSError, InputError):
            self._end(self._opened)
        with suppress(OSError):
            self._line.close()
        self._line = None

    def _check_period(self, sample_period: float) -> None:
        """Refuse a sample period with which a device would end the force by itself."""

    @abstractmethod
    def _prepare(self, opened: Opened) -> None:
        """Make the device ready to give a force, and write what the compiled functions need."""

    @abstractmethod
    def _end(self, opened: Opened) -> None:
        """Give force 0, which stands in the memory, and put back what was set."""


Packet = Callable[..., int]


class BusServo(SerialConnection):
    """A servo on a bus: a register is written without an answer and read back.

    So it is the same whether a servo answers writes or not, and what it did not take is seen.
    """

    def __init__(
        self, port: str, identifier: int, baud: int, put_read: Packet, put_write: Packet, receive: Packet
    ) -> None:
        """`put_read` and `put_write` write the packet that asks for registers, or sets one, and say of how
        many bytes; `receive` waits for the answer, inbox[0] is then the state, the registers follow."""
        self.port, self.identifier, self.baud = port, identifier, baud
        self._put_read, self._put_write, self._receive = put_read, put_write, receive
        self._before: list[tuple[int, int, int]] = []

    def _end(self, opened: Opened) -> None:
        # before the first change the servo may be another program's, holding up an arm
        before, self._before = self._before, []
        if before and type(self).apply(*opened) != CLOSED:
            self._leave()
            for register in reversed(before):
                self._set(*register)

    @property
    @abstractmethod
    def _name(self) -> str:
        """Which kind of servo, and which one."""

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
        size = self._put_write(out, self.identifier, address, count, value)
        with suppress(OSError):  # seen when the register is read
            os.write(self._line.fileno(), bytes(out[:size]))

    def _read(self, address: int, count: int, *, faulty: bool = False) -> int:
        """A register; of a servo that reports a fault only where `faulty` says so."""
        assert self._opened is not None
        inbox, out, descriptor = self._opened.inbox, self._opened.outbox, self._line.fileno()
        status = SILENT
        for _ in range(_TRIES):
            discard(descriptor, inbox)
            with suppress(OSError):
                os.write(descriptor, bytes(out[: self._put_read(out, self.identifier, address, count)]))
            status = self._receive(descriptor, inbox, self.identifier, count, now() + _WAIT)
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
