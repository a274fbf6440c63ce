"""A servo whose registers are read and written over a bus: what is done before and after the loop.

A register is written without an answer and read back: so it is the same whether a servo answers writes or
not, and what it did not take is seen.
"""

from __future__ import annotations

import os
from abc import abstractmethod
from contextlib import suppress
from typing import Any

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
from zwidth.machine.servo.devices.serial_port import open_port
from zwidth.machine.servo.posix import Bytes, discard, now
from zwidth.native.compiled import Array

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
        """Set a register for as long as the servo is served."""
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
