"""A serial port opened so that compiled code can read and write its descriptor without waiting.

A read of a terminal that finds nothing must differ from the end of the line: with VMIN = 1 it is an error
(EAGAIN) in the first case and 0 bytes in the second; with VMIN = 0, which pyserial takes for a timeout of 0
alone, it is 0 bytes in both (termios(3), non-canonical mode).  `inter_byte_timeout` = 0 asks for VMIN = 1.
"""

from __future__ import annotations

import importlib
from contextlib import suppress
from typing import Any

from zwidth.errors import InputError
from zwidth.machine.servo.posix import check_supported


def open_port(port: str, baud: int) -> Any:
    """The port, open for this process alone; its `fileno()` neither blocks on reading nor on writing.

    What had come before is thrown away.  Where a USB adapter gathers bytes before it hands them on (FTDI: for
    16 ms) and its driver can be told not to, it is told.

    Parameters
    ----------
    port
        "/dev/ttyACM0", "/dev/cu.usbmodem1"; a pseudo-terminal too, which has no baud rate.
    baud
        Bits per second on the wire [1/s]; USB devices that only look like serial ports ignore it.
    """
    check_supported()
    try:
        serial: Any = importlib.import_module("serial")
    except ImportError:
        raise InputError(
            "pyserial is not installed, which opens serial ports; pip install 'zwidth[serve]'"
        ) from None
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
