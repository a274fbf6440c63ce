"""Time, sleep and bytes, as compiled code asks the system for them: no lock of Python, nothing allocated.

The clock is monotonic and counts nanoseconds.
"""

from __future__ import annotations

import os
import sys
import time

import numpy as np
from numpy.typing import NDArray

from zwidth.errors import InputError
from zwidth.native.compiled import compiled

Bytes = NDArray[np.uint8]

SUPPORTED = sys.platform != "win32"


def check_supported() -> None:
    """Refuse a system without these calls."""
    if not SUPPORTED:
        raise InputError(
            "serving needs the clock and the descriptors of a POSIX system, Linux or macOS; this is Windows: "
            "use Linux in a virtual machine with the device's port handed through, or WSL 2"
        )


# In C these five are written by hand, in `native/system.c`: what is here runs where there is no C.


@compiled
def now() -> int:
    """The monotonic clock [ns]."""
    return time.monotonic_ns()


@compiled
def pause(nanoseconds: int) -> None:
    """Sleep so long at least; not at all for 0 and less."""
    if nanoseconds > 0:
        time.sleep(nanoseconds * 1e-9)


@compiled
def read_some(descriptor: int, into: Bytes, start: int) -> int:
    """Take what has come, without waiting: how many bytes; −1 if none has, −2 if the other side has closed.

    The descriptor must not block.  What is gone (an error of the descriptor) is seen as silence.
    """
    room = into.shape[0] - start
    if room <= 0:
        return 0
    try:
        count = os.readv(descriptor, [into[start:].data])
    except OSError:
        return -1
    return count if count > 0 else -2


@compiled
def write_all(descriptor: int, what: Bytes, count: int) -> bool:
    """Give the first bytes to the system, at once; False if it did not take them all."""
    try:
        return os.write(descriptor, what[:count].data) == count
    except OSError:
        return False


@compiled
def discard(descriptor: int, scratch: Bytes) -> int:
    """Throw away what has come so far; how many bytes that was, −2 if the other side has closed."""
    total = 0
    while True:
        count = read_some(descriptor, scratch, 0)
        if count == -2:
            return -2
        if count <= 0:
            return total
        total += count
