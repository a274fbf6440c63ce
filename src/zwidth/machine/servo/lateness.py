"""How late this machine is for a periodic loop: a loop that does nothing but be on time.

Sample k is due at t_0 + k T; it is late by what the clock shows beyond that when the loop is awake.  Where
the loop comes a period late or more the samples between are missed.  Ordinary turns, in which the loop is a
thread like any other, alternate with real-time ones, so that both meet the same load.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from math import ceil, inf
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from zwidth.errors import InputError
from zwidth.machine.servo.posix import MARGIN, check_supported, margin, most_awake, now, until
from zwidth.machine.servo.priority import Granted, RealTime
from zwidth.model.device import Device
from zwidth.model.environment.environment import Environment
from zwidth.native.compiled import compiled
from zwidth.passivity.corners import worst_corners
from zwidth.passivity.parameter_limits import has_stiffness, max_stiffness
from zwidth.quantity.answered import answered, answers
from zwidth.quantity.exact import Exact, Interval, ends
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.text import shown
from zwidth.showing import Table

Nanoseconds = NDArray[np.int64]

TURN = 5.0
"""How long a turn lasts [s]."""

_LOOK = 0.05
"""Between two looks at how far the loop is [s]."""

_STEPS, _MISSED, _SPIN, _STOP = range(4)
"""What the loop and the program around it tell each other: steps made, samples missed, the margin, an end."""


@compiled
def run_turn(period: int, most: int, late: Nanoseconds, told: Nanoseconds) -> None:
    """As many samples as `late` has room for, or until told to stop; `most` as of `posix.margin` [ns]."""
    due = now() + period
    while told[_STEPS] + told[_MISSED] < late.shape[0] and told[_STOP] == 0:
        overslept = until(due, told[_SPIN])
        told[_SPIN] = margin(told[_SPIN], overslept, most)
        behind = now() - due
        missed = behind // period
        late[told[_STEPS]] = behind
        told[_STEPS] += 1
        told[_MISSED] += missed
        due += (missed + 1) * period


@dataclass(frozen=True)
class Lateness:
    """How late each step of a loop was [s]."""

    late: NDArray[np.float64]
    missed: int = answered("samples that were not taken")
    margin: float = answered("how long before a deadline the loop awoke in the end", unit="s")
    granted: Granted = answered("what of its wishes the system granted, as in `asked`")

    @property
    @answers()
    def steps(self) -> int:
        """How many began."""
        return len(self.late)

    @property
    @answers(key="lateness", unit="s", names=("of_50_percent", "of_99_percent", "of_99_9_percent", "largest"))
    def shares(self) -> tuple[float, ...]:
        """Within which this share of the steps began."""
        return (*(self.quantile(share) for share in (0.5, 0.99, 0.999)), self.worst)

    def quantile(self, share: float) -> float:
        """The least of these latenesses within which this share of the steps began [s]."""
        ordered = np.sort(self.late)
        return float(ordered[max(ceil(share * len(ordered)) - 1, 0)])

    @property
    def worst(self) -> float:
        """The largest [s]."""
        return float(self.late.max())


class Measured(NamedTuple):
    """Both kinds of turns; `real_time` is None where real-time priority was refused."""

    ordinary: Lateness
    real_time: Lateness | None
    asked: Granted
    """What a loop with real-time priority asks of the system here."""


def measure_lateness(
    sample_period: float,
    duration: float,
    *,
    core: int | None = None,
    progress: Callable[[int, int], None] = lambda done, total: None,
) -> Measured:
    """Ordinary and real-time turns in alternation; all ordinary where there is no real-time priority.

    T, and the duration of all turns together [s]; `progress` is told (seconds done, in all).
    """
    check_supported()
    ordinary = RealTime(priority=0, memory=False, core=core)
    wanted = RealTime(core=core)
    with wanted as asked:
        pass
    kinds = (ordinary, wanted) if "priority" in asked else (ordinary,)
    period = round(sample_period * 1e9)
    turn(ordinary, period, 2, lambda share: None)  # found in its library before it counts
    rounds = max(round(duration / (len(kinds) * TURN)), 1)
    count = max(round(duration / (rounds * len(kinds) * sample_period)), 1)
    turns: list[list[Lateness]] = [[] for _ in kinds]
    for i in range(rounds * len(kinds)):
        done = duration * i / (rounds * len(kinds))
        told = _told(progress, done, count * sample_period, duration)
        turns[i % len(kinds)].append(turn(kinds[i % len(kinds)], period, count, told))
    joined = [_joined(each) for each in turns]
    return Measured(joined[0], joined[1] if len(kinds) == 2 else None, asked)


def _told(
    progress: Callable[[int, int], None], before: float, length: float, total: float
) -> Callable[[float], None]:
    """Progress of the whole, from the share of one turn that is done."""
    return lambda share: progress(round(before + share * length), round(total))


def _joined(turns: list[Lateness]) -> Lateness:
    late = np.concatenate([one.late for one in turns])
    return Lateness(late, sum(one.missed for one in turns), turns[-1].margin, turns[-1].granted)


def turn(wishes: RealTime, period: int, count: int, progress: Callable[[float], None]) -> Lateness:
    """One turn in a thread of its own; an interruption ends it."""
    late, told = np.full((count,), 0, np.int64), np.zeros(4, np.int64)  # np.zeros has no pages yet
    granted: list[Granted] = []

    def loop() -> None:
        with wishes as answer:
            granted.append(answer)
            most = most_awake(period, "priority" in answer)
            told[_SPIN] = min(MARGIN, most)
            run_turn(period, most, late, told)

    thread = threading.Thread(target=loop)
    thread.start()
    try:
        while thread.is_alive():
            thread.join(_LOOK)
            progress((told[_STEPS] + told[_MISSED]) / count)
    finally:
        told[_STOP] = 1
        thread.join()
    return Lateness(late[: told[_STEPS]] / 1e9, int(told[_MISSED]), told[_SPIN] / 1e9, granted[0])


# What lateness costs: a step that begins L late holds the force before it for T + L.  The certificates are
# of a period that does not vary; the loop whose every period is T + L is one of them, and is what is
# compared here. Where the loop is held up after it has read the position, its force comes L later as well:
# delay + L.  Both are figures to judge a machine by, no proof for the served loop.


_DIGITS = 9
"""Of seconds: the clock counts nanoseconds."""


_BOUNDS = ("nominal", "longer_period", "later_force")


@dataclass(frozen=True)
class StiffnessCost:
    """The largest stiffness that is proved passive, all else as given [N/m; N·m/rad].

    inf if every stiffness is, None if none is.
    """

    nominal: float | None
    longer_period: float | None
    """With T + L."""
    later_force: float | None
    """With T + L, and delay + L."""
    lateness: float = answered("L, within which 99.9 % of the steps began", unit="s")
    contact: str = answered('of which the proofs are: "made and broken" or "kept"')
    motion: str = answered('"linear" or "rotary"', only_shown=True)

    @property
    @answers(key="max_stiffness", quantity="stiffness", names=_BOUNDS, finite=True)
    def largest(self) -> tuple[float | None, ...]:
        """Proved passive as given, with every period longer by L, and with every force later by L too; null
        where none is, or any."""
        return self.nominal, self.longer_period, self.later_force

    @property
    @answers()
    def any_stiffness(self) -> list[str]:
        """Those of the three that have no bound."""
        return [name for name, value in zip(_BOUNDS, self.largest, strict=True) if value == inf]

    def table(self) -> Table:
        """A row for each."""
        late = shown(self.lateness, "s", 3)
        names = ("as given", f"every period longer by {late}", f"and every force later by {late}")
        unit = GLOSSARY["stiffness"].unit_for(self.motion)
        rows = [(name, shown(value, unit, 6)) for name, value in zip(names, self.largest, strict=True)]
        return Table(rows=rows, caption=f"largest passive stiffness, contact {self.contact}")


def stiffness_cost(device: Device, environment: Environment, lateness: float) -> StiffnessCost:
    """The largest passive stiffness without and with a lateness L [s]; device and environment as of
    `zwidth.check`.
    """
    if not has_stiffness(environment):
        raise InputError(
            f"what lateness costs is told in stiffness, and {environment.describe(device.motion)} has none: "
            "name a wall"
        )
    by = Fraction(round(lateness * 10**_DIGITS), 10**_DIGITS)
    longer = device.replace(sample_period=_more(device.sample_period, by))
    loops = (device, longer, longer.replace(delay=_more(device.delay, by)))
    contact, found = "made and broken", [_largest(each, environment, True) for each in loops]
    if None in found:  # what is proved while contact is kept compares better than what is not proved at all
        contact, found = "kept", [_largest(each, environment, False) for each in loops]
    nominal, longer_period, later_force = found
    return StiffnessCost(nominal, longer_period, later_force, float(by), contact, device.motion)


def _largest(device: Device, environment: Environment, contact: bool) -> float | None:
    worst, *others = worst_corners(device, environment)
    if others:
        raise InputError(
            "what lateness costs is told for one period, one delay and one wall, and one of them is an "
            "interval: give single values"
        )
    return max_stiffness(*worst, contact)


def _more(value: Exact | Interval, by: Fraction) -> Exact | Interval:
    low, high = ends(value)
    return Exact(low + by) if low == high else Interval(low + by, high + by)
