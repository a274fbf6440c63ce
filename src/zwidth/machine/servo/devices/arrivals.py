"""Bytes of an answer, waited for until a given time, and what became of a question that has no right answer.

An answer is looked for among all that comes: what belongs to an earlier question, or to nobody, is passed
over, so that one answer too many does not make every later one old.
"""

from __future__ import annotations

from math import floor

from zwidth.machine.servo.connection import CLOSED, GARBLED, SILENT, STALE
from zwidth.machine.servo.posix import Bytes, now, pause, read_some
from zwidth.native.compiled import compiled

MOST_READS = 256
"""For one answer: a flood of bytes must not hold up the loop.  The longest answer is shorter than that."""

_PAUSE = 20_000
"""Between two looks [ns]."""


@compiled
def more_bytes(descriptor: int, inbox: Bytes, filled: int, until: int) -> int:
    """Take what comes, behind the `filled` bytes: how many; 0 when the time is over, −2 at a closed line.

    The last look is after the time: a thread that stood still until then does not miss what came meanwhile.
    """
    while True:
        over = now() >= until
        count = read_some(descriptor, inbox, filled)
        if count != -1:
            return count
        if over:
            return 0
        pause(_PAUSE)


@compiled
def dropped(inbox: Bytes, count: int, filled: int) -> int:
    """Forget the first `count` of the `filled` bytes; how many are left, now at the beginning."""
    for i in range(filled - count):
        inbox[i] = inbox[count + i]
    return filled - count


@compiled
def unanswered(garbled: bool, stale: bool) -> int:
    """The time is over: what came in place of the answer."""
    if garbled:
        return GARBLED
    return STALE if stale else SILENT


@compiled
def unwritten(descriptor: int, inbox: Bytes) -> int:
    """The system did not take what was to be sent: the line is closed, or nobody takes the bytes away."""
    return CLOSED if read_some(descriptor, inbox, 0) == -2 else SILENT


@compiled
def unwrapped(reading: float, before: float, turn: float) -> float:
    """``reading + n turn`` that is nearest to `before`: a counter that begins anew has not jumped.

    True as long as less than half a turn of the counter passes between two samples.
    """
    return reading + turn * floor((before - reading) / turn + 0.5)
