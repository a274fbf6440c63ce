"""Why a force has to end, as answers, readings and the clock have it; the same of a loop, a pair and a port.

Judged are an answer that is not good (at once where the device failed or the line closed, else after several
in a row), a reading that is no number or lies farther from the one before than a hand goes, and a gap: for
too long no good reading while a law is served, whatever force it gave.
"""

from __future__ import annotations

from math import isfinite, nan

from zwidth.machine.servo.connection import CLOSED, GOOD, REFUSED
from zwidth.machine.servo.safety import BAD_ANSWER, GAP, JUMPED, NO_NUMBER, RUNNING
from zwidth.native.compiled import compiled


@compiled
def bad_in_a_row(status: int, before: float) -> float:
    """Answers in a row that were not good, with this one, from those before it."""
    return 0.0 if status == GOOD else before + 1.0


@compiled
def judged_answer(status: int, bad: float, most: float) -> int:
    """RUNNING, or why the force has to end: `bad` in a row were not good, and so many may be."""
    if status in (CLOSED, REFUSED) or bad > most:
        return BAD_ANSWER + status
    return RUNNING


@compiled
def judged_reading(x: float, before: float, farthest: float) -> int:
    """RUNNING, or why the force has to end.

    Parameters
    ----------
    x
        The reading [m; rad].
    before
        The one before; not a number where there is none.
    farthest
        A hand may have moved it so far since [m; rad].
    """
    if not isfinite(x):
        return NO_NUMBER
    return JUMPED if abs(x - before) > farthest else RUNNING


@compiled
def judged_gap(since: float, longest: float) -> int:
    """RUNNING, or GAP where the last good reading lies so far back [s] and a law is served."""
    return GAP if since > longest else RUNNING


def find_judging() -> None:
    """Have what a loop in Python calls found in its library before the clock runs."""
    judged_answer(GOOD, bad_in_a_row(GOOD, 0.0), 0.0)
    judged_reading(0.0, nan, 0.0)
    judged_gap(0.0, 0.0)
