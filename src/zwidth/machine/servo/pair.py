"""Two arms served in one loop: both measured, the pair's law of both readings, both given their force.

    with PairServo(pair, leader, follower) as arms:      # reaches both, force 0
        arms.measure()                                   # what this machine and the links are like
        arms.run("30 s")                                 # refuses what is not proved passive with that

Both are asked one after the other, at one rate; what the link of the pair delays is delayed by the loop.  The
loop is one in Python, in the thread that calls `run`: what else runs in Python makes it later, which is
measured first and counted all along.  A fault of either arm ends the force of both.
"""

from __future__ import annotations

import atexit
import threading
from collections.abc import Callable
from contextlib import ExitStack, suppress
from dataclasses import dataclass
from math import nan
from typing import Any

import numpy as np

from zwidth.errors import InputError
from zwidth.machine.servo.connection import (
    CLOSED,
    GOOD,
    REFUSED,
    Axis,
    Closing,
    CompiledConnection,
    LibraryConnection,
    Placement,
    seconds_of,
)
from zwidth.machine.servo.loop import await_sample, lateness
from zwidth.machine.servo.pair_law import PairLaw
from zwidth.machine.servo.posix import ANSWERED, MARGIN, check_supported, most_awake, now
from zwidth.machine.servo.priority import Granted, RealTime
from zwidth.machine.servo.proving import SERVED_OUTCOMES, Measured, measured, shares
from zwidth.machine.servo.report import PairServoReport, ending
from zwidth.machine.servo.safety import (
    ASKED,
    BAD_ANSWER,
    DONE,
    HOST_GONE,
    RUNNING,
    Limits,
    Safety,
    bad_in_a_row,
    find_judging,
    judged_answer,
    judged_gap,
    judged_reading,
    limits_of,
)
from zwidth.model.pairs import Pair
from zwidth.passivity.check import check
from zwidth.passivity.pairs import PairVerdict
from zwidth.quantity.exact import RealLike, ends
from zwidth.quantity.text import shown

Law = Callable[[float, float], tuple[float, float]]
"""Of both readings, the force of each side."""

_MEASURED = "1 s"


class PairNotProved(InputError):
    """A pair is not served, since it is not proved passive; its verdict says what is known of it."""

    def __init__(self, verdict: PairVerdict, message: str) -> None:
        super().__init__(message)
        self.verdict = verdict


@dataclass
class _Side:
    """One arm while it is served."""

    axis: Axis
    limits: Limits
    damping: float
    coulomb: float
    x: float = 0.0
    force: float = 0.0
    """Against x, given last."""
    bad: float = 0.0
    work: float = 0.0
    loss: float = 0.0


class PairServo(Closing):
    """Leader and follower, served.

    Parameters
    ----------
    pair
        What is claimed of it is what is served; both devices at one rate, nothing computed inside a drive.
    leader, follower
        How each is reached, see `servo.devices`.
    safety
        Limits of both; the slew cannot be one of them.
    placements
        Where x = 0 is on each axis, and which way x goes.
    real_time
        What the loop asks of the system; by default all that it may.

    Raises
    ------
    InputError
        If the pair cannot be served, a connection is of another motion, or a device cannot be reached.
    """

    def __init__(
        self,
        pair: Pair,
        leader: CompiledConnection | LibraryConnection,
        follower: CompiledConnection | LibraryConnection,
        *,
        safety: Safety | None = None,
        placements: tuple[Placement, Placement] | None = None,
        real_time: RealTime | None = None,
    ) -> None:
        check_supported()
        _check(pair, (leader, follower))
        self.pair, self.safety = pair, safety or Safety()
        if self.safety.slew is not None:
            raise InputError("a pair's forces have no limit of their change here; leave out slew")
        self._period = pair.sample_period
        self._law = PairLaw(pair)
        find_judging()
        self._real_time = real_time or RealTime()
        self._stop = threading.Event()
        self.measured: Measured | None = None
        self.verdict: PairVerdict | None = None
        self.granted: Granted | None = None
        self._reason = self._missed = self._held = self._cut = 0
        self._serving = False
        self._late: list[float] = []
        self._took: list[float] = []
        places = placements or (Placement(), Placement())
        with ExitStack() as opened:  # the first is let go if the second cannot be reached
            self._sides = [
                _side(opened.enter_context(Axis(connection, place, float(self._period))), device, self.safety)
                for connection, place, device in zip(
                    (leader, follower), places, (pair.leader, pair.follower), strict=True
                )
            ]
            opened.pop_all()
        atexit.register(self.close)

    def measure(self, duration: RealLike = _MEASURED) -> Measured:
        """Run the loop with force 0 for so long [s], and note what this machine and the links are like.

        Raises
        ------
        InputError
            If a device does not answer.
        """
        self._loop(self._count(duration))
        if self._reason != DONE:
            raise InputError(f"{self._title} does not answer: {ending(self._reason)}")
        waits = max(side.axis.connection.late for side in self._sides)
        self.measured = measured(np.array(self._late), np.array(self._took), self._missed, waits)
        return self.measured

    def judge(self) -> PairVerdict:
        """What is claimed of the pair with the delay and the longest period that were measured.

        Raises
        ------
        InputError
            If nothing was measured yet.
        """
        if self.measured is None:
            raise InputError("measure first: a verdict needs the delay of this machine and the links")
        devices = [
            device if side.axis.connection.samples else device.replace(delay=self.measured.delay(device))
            for device, side in zip((self.pair.leader, self.pair.follower), self._sides, strict=True)
        ]
        verdict = check(self.pair.replace(leader=devices[0], follower=devices[1]))
        if verdict.outcome not in SERVED_OUTCOMES:
            return verdict
        longest = self.measured.longest_period(self._period)
        one, other = (device.replace(sample_period=longest) for device in devices)
        slower = check(self.pair.replace(leader=one, follower=other))
        return verdict if slower.outcome in SERVED_OUTCOMES else slower

    def run(self, duration: RealLike, *, anyway: bool = False) -> PairServoReport:
        """Serve for so long [s], from where both forces are near 0; until then they are 0.

        Ends at `stop`, at Ctrl-C, and at a fault of either arm.

        Raises
        ------
        PairNotProved
            If the pair is not proved passive and `anyway` is False.
        InputError
            If a device does not answer when it is measured.
        """
        count = self._count(duration)
        if self.measured is None:
            self.measure()
        self.verdict = self.judge()
        if self.verdict.outcome not in SERVED_OUTCOMES and not anyway:
            raise PairNotProved(
                self.verdict,
                f"this pair is not served, it is {self.verdict.outcome}: {self.verdict.claim} Soften its "
                "spring, raise the rate, or give anyway=True (--anyway), with a small force limit",
            )
        self._law.begin()
        self._loop(count, self._law.forces)
        return self.report()

    def stop(self) -> None:
        """Ask the loop to end, from any thread."""
        self._stop.set()

    def close(self) -> None:
        """Force 0, then both devices are let go; may be called again."""
        atexit.unregister(self.close)
        self._let_go()
        for side in self._sides:
            side.axis.close()

    def report(self) -> PairServoReport:
        """What happened in the last run."""
        leader, follower = self._sides
        return PairServoReport(
            title=self._title,
            verdict=self.verdict,
            measured=self.measured,
            granted=self.granted,
            ended=ending(self._reason),
            samples=len(self._late),
            missed=self._missed,
            held=self._held,
            cut=self._cut,
            lateness=shares(np.array(self._late or [0.0])),
            energy_out=(leader.work, follower.work),
            friction_loss=(leader.loss, follower.loss),
            met_hardware=all(side.axis.connection.met_hardware for side in self._sides),
        )

    @property
    def _title(self) -> str:
        one, other = (side.axis.connection.describe() for side in self._sides)
        return f"{one} and {other}, {self.pair.describe()}"

    def _count(self, duration: RealLike) -> int:
        scripts = (side.axis.connection.samples for side in self._sides)
        count = max(1, int(seconds_of(duration).fraction / self._period))
        return min([count, *(n for n in scripts if n is not None)])

    def _loop(self, last: int, law: Law | None = None) -> None:
        """Samples 0 to `last`, without a law with force 0; whatever ends it, the force is 0 afterwards."""
        self._reason, self._missed, self._held, self._cut = RUNNING, 0, 0, 0
        self._serving = False
        self._late, self._took = [], []
        self._stop.clear()
        for side in self._sides:
            side.x = side.force = side.work = side.loss = side.bad = 0.0
            side.axis.begin()
        try:
            with self._real_time as self.granted:
                self._samples(last, law)
        except KeyboardInterrupt:
            self._reason = ASKED
        finally:
            self._let_go()

    def _samples(self, last: int, law: Law | None) -> None:
        period = float(self._period)
        tick, k = period * 1e9, 0
        most = most_awake(tick, self.granted is not None and "priority" in self.granted)
        awake = min(MARGIN, most)
        before: tuple[int, float] | None = None
        start = now()
        while self._reason == RUNNING:
            taken, due, at, awake = await_sample(k, start, tick, awake, most)
            if k == 0:
                taken, due, start = 0, at, at
            if taken > last:
                self._reason = DONE
                return
            self._missed += taken - k
            k, late = taken, lateness(at, due, period)
            readings = self._measured(k, at, late)
            self._look(readings, before, k, k * period + late)
            if self._reason != RUNNING:
                return
            if readings is None:
                self._held += 1
            else:
                if before is not None:
                    self._book(readings, k * period + late - before[1])
                self._give((0.0, 0.0) if law is None else self._forces(law, readings))
                for side, x in zip(self._sides, readings, strict=True):
                    side.x = x
                before = k, k * period + late
            self._late.append(late)
            self._took.append((now() - at) * 1e-9)
            k += 1

    def _measured(self, k: int, at: int, late: float) -> tuple[float, float] | None:
        """Both readings; None where one has no good answer."""
        found = []
        for i, side in enumerate(self._sides):
            end = at + int((i + 1) / 2 * ANSWERED * 1e9 * float(self._period))
            status, x = side.axis.measure(k, end, late)
            side.bad = bad_in_a_row(status, side.bad)
            self._reason = self._reason or judged_answer(status, side.bad, side.limits.bad_answers)
            if status == GOOD:
                found.append(x)
        return (found[0], found[1]) if len(found) == 2 else None

    def _look(
        self, readings: tuple[float, float] | None, before: tuple[int, float] | None, k: int, t: float
    ) -> None:
        """Whether the force has to end: as in a served loop, see `servo.safety`."""
        if self._reason != RUNNING:
            return
        if self._stop.is_set():
            self._reason = ASKED
        elif before is not None and self._serving:
            self._reason = judged_gap(t - before[1], self._sides[0].limits.gap)
        if not threading.main_thread().is_alive():
            self._reason = self._reason or HOST_GONE
        for side, x in zip(self._sides, readings or (), strict=False):
            there, periods = (nan, 1) if before is None else (side.x, k - before[0])
            self._reason = self._reason or judged_reading(x, there, side.limits.jump * periods)

    def _book(self, readings: tuple[float, float], took: float) -> None:
        """The energies up to this sample, as `servo.cycle` has them."""
        for side, x in zip(self._sides, readings, strict=True):
            moved = x - side.x
            side.work -= side.force * moved
            side.loss += side.damping * moved * moved / took + side.coulomb * abs(moved)

    def _forces(self, law: Law, readings: tuple[float, float]) -> tuple[float, float]:
        """Of the law, from where it may begin; 0 until then."""
        forces = law(*readings)
        self._serving = self._serving or self._may_begin(forces)
        if self._serving:
            return forces
        self._law.begin()
        return (0.0, 0.0)

    def _may_begin(self, forces: tuple[float, float]) -> bool:
        """Near 0 on both sides, if both arms had always been where they are."""
        return all(abs(f) <= side.limits.start_force for side, f in zip(self._sides, forces, strict=True))

    def _give(self, forces: tuple[float, float]) -> None:
        cut = False
        for side, wish in zip(self._sides, forces, strict=True):
            most = side.limits.force
            side.force = min(max(wish, -most), most)
            cut = cut or side.force != wish
            given = side.axis.give(-side.force)
            if given in (CLOSED, REFUSED):
                self._reason = BAD_ANSWER + given
        self._cut += cut

    def _let_go(self) -> None:
        """Force 0 of both, also where one of them raises something."""
        for side in self._sides:
            with suppress(Exception):
                side.axis.let_go()


def _side(axis: Axis, device: Any, safety: Safety) -> _Side:
    return _Side(
        axis,
        limits_of(safety, device, axis.period),
        float(ends(device.damping)[0]),
        float(ends(device.coulomb_friction)[0]),
    )


def _check(pair: Pair, connections: tuple[object, object]) -> None:
    if not isinstance(pair, Pair):
        raise InputError(f"a served pair is a zwidth.Pair, got {type(pair).__name__}")
    if pair.own_readings > 1 or pair.drive_rate is not None:
        rates = ", ".join(shown(1 / d.exact("sample_period"), "Hz", 6) for d in (pair.leader, pair.follower))
        raise InputError(
            f"both arms of a served pair are measured and computed at one rate, got {rates} and a drive_rate "
            f"of {pair.drive_rate}: give both the rate of this loop"
        )
    for name, connection in zip(("leader", "follower"), connections, strict=True):
        if not isinstance(connection, (CompiledConnection, LibraryConnection)):
            raise InputError(
                f"the {name} is reached by one of zwidth.servo.devices, got {type(connection).__name__}"
            )
        if connection.motion != pair.motion:
            raise InputError(
                f"the pair is {pair.motion} and the connection of the {name} {connection.motion}; describe "
                "both devices as they are measured"
            )
