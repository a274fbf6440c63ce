"""A device at the other end of a pseudo-terminal, which has the bytes of a serial port but no baud rate."""

import os
import tty
from abc import abstractmethod
from contextlib import suppress
from threading import Thread
from typing import Self

from servo.emulators.faults import Emulator, Fault


class TerminalEmulator(Emulator):
    """Hears what is written to `port`, from a thread of its own, as long as its ``with`` lasts."""

    def __init__(self, fault: Fault | None = None, at: int = 0) -> None:
        super().__init__(fault, at)
        self._near, far = os.openpty()
        tty.setraw(far)
        self._far: int | None = far  # held open, or the near end would fail until somebody opens the port
        self.port = os.ttyname(far)
        self._thread = Thread(target=self._listen, daemon=True)

    @abstractmethod
    def hear(self, data: bytes) -> None:
        """Take bytes that came, however they were cut."""

    def write(self, data: bytes) -> None:
        with suppress(OSError):
            os.write(self._near, data)

    def hang_up(self) -> None:
        """Close the line: whoever has the port open finds its end."""
        near, self._near = self._near, -1
        if near >= 0:
            os.close(near)

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        if self._far is not None:
            os.close(self._far)  # where the adapter has closed too, the thread's read now ends
            self._far = None
        self._thread.join(timeout=60)
        self.hang_up()

    def _listen(self) -> None:
        while self._near >= 0:
            try:
                data = os.read(self._near, 4096)
            except OSError:
                return
            if not data:
                return
            self.hear(data)
