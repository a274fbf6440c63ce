"""When the force is cut, and when it ends: what stands between a law and a hand.

Cut is what a law asks for beyond a force, or beyond a change of force from one sample to the next; no verdict
speaks of what is rendered then, and the report counts such samples.  For good ends the force

    where the device gives no good answer for `bad_answers` + 1 samples in a row, or says that it failed;
    at a reading that is no number, or from which to the one before no hand can have moved it;
    where the law itself gives no finite number;
    where the loop did not run for `longest_gap` while a law is served, even one that gave no force just then
    (the hand may be deep in the wall by now), or the program around it for `host_timeout`;
    when somebody asks, at a signal, at an exception, and at the end.

A force that ends at once takes energy away: what a spring held is lost.  A force that came back would give it
to a hand that has moved on.  So nothing that has ended begins again by itself.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite, nan
from typing import NamedTuple

from zwidth.errors import InputError
from zwidth.machine.servo.connection import CLOSED, GOOD, REFUSED
from zwidth.model.device.device import Device
from zwidth.model.specification.table import Table, located
from zwidth.native.compiled import compiled
from zwidth.quantity.exact import Exact, ends
from zwidth.quantity.glossary import Quantity
from zwidth.quantity.parameter import (
    Certain,
    CertainOrNone,
    Parametric,
    parameter,
    parameters_of,
    read_number,
)

_SLEW = Quantity("slew", "S", "N/s", "N*m/s", "largest change of the force in a second")
_NUMBER = Quantity("number", "n", "1", "1", "how many")


def _whole(value: Exact) -> int:
    if value.fraction.denominator != 1:
        raise InputError(f"bad_answers is a number of samples, 0, 1, 2, …, got {float(value):g}")
    return int(value.fraction)


@dataclass(frozen=True, kw_only=True)
class Safety(Parametric):
    """Limits of what a hand is given, see the module.

    Parameters
    ----------
    force
        Largest force given, > 0 [N; N·m]. None: that of the device, where it has one.
    slew
        Largest change of the force in a second, > 0 [N/s; N·m/s]; None: any.
    start_force
        Force up to which a law may begin, or take the place of another, > 0 [N; N·m]. None: a
        hundredth of the largest force, or 0 where none is known.
    speed
        Faster than that no hand moves the device, > 0 [m/s; rad/s]: a reading that lies farther from
        the one before is a fault of the sensor. None: 10 m/s, of a rotary device 300 rad/s.
    bad_answers
        So many samples in a row may have no good answer; the force is held meanwhile. Default 1.
    longest_gap
        For so long the loop may not have run, > 0 [s]. Default 50 ms.
    host_timeout
        For so long the program around the loop may not have run, > 0 [s]. Default 1 s.
    """

    force: CertainOrNone = parameter("force", None, bound="> 0", why="a limit of 0 gives nothing")
    slew: CertainOrNone = parameter(_SLEW, None, bound="> 0", why="a force that may not change is none")
    start_force: CertainOrNone = parameter("force", None, bound="> 0", why="a spring is never at 0 exactly")
    speed: CertainOrNone = parameter("velocity", None, bound="> 0", why="the device moves")
    bad_answers: int = parameter(_NUMBER, 1, kept=_whole, bound="≥ 0", why="it counts samples")
    longest_gap: Certain = parameter(
        "sample_period", "50 ms", bound="> 0", why="every loop comes late at times"
    )
    host_timeout: Certain = parameter("sample_period", "1 s", bound="> 0", why="every program waits at times")


MEANINGS = {
    "force": "largest force given (default: that of the device)",
    "slew": "largest change of the force in a second (default: any)",
    "start_force": "force up to which a law may begin (default: a hundredth of the largest)",
    "speed": "faster than that no hand moves the device (default: 10 m/s; rotary 300 rad/s)",
    "bad_answers": "samples in a row that may have no good answer, the force held (default: 1)",
    "longest_gap": "so long the loop may not have run (default: 50 ms)",
    "host_timeout": "so long the program around the loop may not have run (default: 1 s)",
}
"""For the command line."""


def read_safety(table: Table, motion: str) -> Safety:
    """The safety that a table describes."""
    known = parameters_of(Safety)
    table.check_keys(known, "the safety")
    values = {}
    for key, given in table.values.items():
        with located(table.where(key)):
            values[key] = read_number(given, known[key].quantity, key, motion=motion)
    with located(table.label):
        return Safety(**values)


class Limits(NamedTuple):
    """The same for the loop: counted in samples, 1e300 where there is none."""

    force: float
    change: float
    start_force: float
    jump: float
    bad_answers: float
    gap: float
    host_timeout: float


_FASTEST = {"linear": 10.0, "rotary": 300.0}


def limits_of(safety: Safety, device: Device, period: float) -> Limits:
    """What the loop compares with, at a period T [s]; of the device's force limit the least."""
    limit = None if device.force_limit is None else float(ends(device.force_limit)[0])
    asked = None if safety.force is None else float(safety.force)
    known = [f for f in (asked, limit) if f is not None]
    force = min(known) if known else 1e300
    near = float(safety.start_force) if safety.start_force is not None else 0.01 * force if known else 0.0
    speed = _FASTEST[device.motion] if safety.speed is None else float(safety.speed)
    return Limits(
        force=force,
        change=1e300 if safety.slew is None else float(safety.slew) * period,
        start_force=near,
        jump=speed * period,
        bad_answers=float(safety.bad_answers),
        gap=float(safety.longest_gap),
        host_timeout=float(safety.host_timeout),
    )


# Why the force ended.  From BAD_ANSWER on the status of the last answer is added.
RUNNING, ASKED, DONE, NO_NUMBER, JUMPED, GAP, HOST_GONE, FAILED, NO_FORCE, BAD_ANSWER = range(10)

REASONS = {
    ASKED: "it was asked to end",
    DONE: "the time was over",
    NO_NUMBER: "the reading was no number",
    JUMPED: "the reading jumped farther than a hand can move the device in that time",
    GAP: "the loop did not run for too long",
    HOST_GONE: "the program around the loop did not run for too long",
    FAILED: "the program around the loop failed",
    NO_FORCE: "the force of the law was no finite number",
}


# Judged, the same of a loop, a pair and a port, are an answer that is not good (at once where the device
# failed or the line closed, else after several in a row), a reading that is no number or lies farther from
# the one before than a hand goes, and a gap: for too long no good reading while a law is served, whatever
# force it gave.


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
    """RUNNING, or why the force has to end: at x [m; rad], farther from the one before than a hand may have
    gone.

    `before` is not a number where there is none.
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
