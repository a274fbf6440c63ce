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


# Waiting for a deadline: asleep first, then awake.  A sleeping thread awakes late, by what the timer, the
# scheduler and a core that slept as well take.  So the sleep ends a margin before the deadline, and the
# rest is waited out reading the clock.  The margin follows how late the thread did awake: it grows by a
# step after a sleep that ended later than the margin allows for, and shrinks by 1/255 of the step after any
# other.  Where the two balance one sleep in 256 is too long: the quantile of 99.6 % (H. Robbins and S.
# Monro, Annals of Mathematical Statistics 22, 1951, 400).
#
# Awake is good for a thread that has the core to itself, or real-time priority.  Of the others the scheduler
# counts the time awake, and where the core is shared it takes the core away for a whole turn, milliseconds:
# measured beside a busy core, 99 % of the steps were late by less than 0.05 ms asleep, 1.9 ms awake.


MARGIN = 100_000
"""To begin with [ns]."""

AWAKE = 0.4
"""For so much of a period the clock may be watched: a kernel takes the core from who never sleeps."""

ANSWERED = 0.5
"""For so much of a period an answer is waited for, of two devices in turn half of it each."""

_LEAST = 5_000
_SHRINK = 100
_GROW = 255 * _SHRINK


@compiled
def until(deadline: int, spin: int) -> int:
    """Wait until the clock `posix.now` reads `deadline`; how late the sleep ended, 0 if there was none [ns].

    Sleeps until `spin` nanoseconds before the deadline, then reads the clock until it is there.  Returns at
    once if the deadline is over.
    """
    alarm = deadline - spin
    overslept = 0
    left = alarm - now()
    while left > 0:  # a signal ends a sleep early
        pause(left)
        overslept = now() - alarm
        left = -overslept
    while now() < deadline:
        pass
    return overslept


@compiled
def margin(spin: int, overslept: int, most: int) -> int:
    """The `spin` of the next deadline, from that of this one and what `until` gave [ns].

    `most` is the largest, see `most_awake`.
    """
    following = spin + _GROW if overslept > spin else spin - _SHRINK
    return min(max(following, _LEAST), most)


def most_awake(period: float, has_priority: bool) -> int:
    """The largest margin of a loop with this period [ns], that has real-time priority or has not."""
    return int(AWAKE * period) if has_priority else 0
