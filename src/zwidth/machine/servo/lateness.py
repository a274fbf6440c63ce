"""How late this machine is for a periodic loop: a loop that does nothing but be on time.

Sample k is due at t_0 + k T; it is late by what the clock shows beyond that when the loop is awake.  Where
the loop comes a period late or more the samples between are missed.  Ordinary turns, in which the loop is a
thread like any other, alternate with real-time ones, so that both meet the same load.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import dataclass
from math import ceil
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from zwidth.machine.servo.pace import MARGIN, margin, most_awake, until
from zwidth.machine.servo.posix import check_supported, now
from zwidth.machine.servo.priority import Granted, RealTime
from zwidth.native.compiled import compiled

Nanoseconds = NDArray[np.int64]

TURN = 5.0
"""How long a turn lasts [s]."""

_LOOK = 0.05
"""Between two looks at how far the loop is [s]."""

_STEPS, _MISSED, _SPIN, _STOP = range(4)
"""What the loop and the program around it tell each other: steps made, samples missed, the margin, an end."""


@compiled
def run_turn(period: int, most: int, late: Nanoseconds, told: Nanoseconds) -> None:
    """As many samples as `late` has room for, or until told to stop; `most` is that of `pace.margin` [ns]."""
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
    """How late the steps of a loop were.

    Attributes
    ----------
    late
        Of each step [s].
    missed
        Samples that were not taken.
    margin
        How long before a deadline the loop awoke in the end [s].
    granted
        What the loop asked of the system.
    """

    late: NDArray[np.float64]
    missed: int
    margin: float
    granted: Granted

    def quantile(self, share: float) -> float:
        """The least of these latenesses within which this share of the steps began [s]."""
        ordered = np.sort(self.late)
        return float(ordered[max(ceil(share * len(ordered)) - 1, 0)])

    @property
    def worst(self) -> float:
        """The largest [s]."""
        return float(self.late.max())

    def to_dict(self) -> dict[str, Any]:
        """Its numbers, a unit in every key."""
        shares = {"of_50_percent": 0.5, "of_99_percent": 0.99, "of_99_9_percent": 0.999}
        return {
            "steps": len(self.late),
            "missed": self.missed,
            "lateness_s": {**{key: self.quantile(q) for key, q in shares.items()}, "largest": self.worst},
            "margin_s": self.margin,
            "granted": self.granted.to_dict(),
        }


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

    Parameters
    ----------
    sample_period
        T [s].
    duration
        Of all turns together [s].
    core
        That the loop keeps to; None for any.
    progress
        Is told (seconds done, in all).
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
