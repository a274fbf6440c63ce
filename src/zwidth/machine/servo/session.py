"""A device served: measured first, then judged, then given the force of a law, until somebody asks to end.

    with Servo(device, wall, connection) as servo:      # reaches the device, force 0
        servo.measure()                                  # what this machine and the link are like
        servo.start()                                    # refuses what is not proved passive with that
        servo.change(stiffer_wall)                       # when the hand has left the wall
        servo.wait()

The loop is a thread of its own.  What it is told, and what it tells, stands in arrays that both see.
"""

from __future__ import annotations

import atexit
from datetime import UTC, datetime
from math import inf, nan
from typing import Any, Literal, cast

from zwidth import __version__
from zwidth.errors import InputError
from zwidth.loop.plant import STATE_SIZE
from zwidth.machine.servo import cycle
from zwidth.machine.servo.connection import Closing, Connection, Opened, Placement, reach, seconds_of
from zwidth.machine.servo.cycle import HEARTBEAT, REASON, ROWS, SERVED, STOP, WANTED, Packed, pack
from zwidth.machine.servo.loop import LoopThread, Shared, shared
from zwidth.machine.servo.posix import check_supported, now
from zwidth.machine.servo.priority import Granted, RealTime
from zwidth.machine.servo.proving import (
    Decide,
    Measured,
    check_kinds,
    claimed,
    judged,
    least_friction,
    measured,
    refuse_not_proved,
)
from zwidth.machine.servo.report import ServoReport, report_of
from zwidth.machine.servo.ring import MEASURING, Rows, ring
from zwidth.machine.servo.safety import ASKED, DONE, FAILED, RUNNING, Safety, limits_of
from zwidth.model.device.device import Device
from zwidth.model.environment.environment import Environment
from zwidth.model.environment.transfer_function import as_environment
from zwidth.model.specification.write import written
from zwidth.passivity.check import check
from zwidth.passivity.verdict import Verdict
from zwidth.quantity.exact import RealLike, ends

Contact = Literal["made and broken", "kept"]
_ROOM, _REMEMBERED = 1 << 15, 1 << 11
"""Numbers that a law may have which takes the place of another, and that it may remember: all of these are
set at every sample at which it waits to begin."""

_LONGEST = 1 << 60
"""Samples that a loop can count."""

_MEASURED = "1 s"


class Servo(Closing):
    """One axis of a device, served.

    Parameters
    ----------
    device
        What it is: the verdict speaks of it, the period is its own.  Damping and Coulomb friction may be
        intervals.
    environment
        What is rendered, with the laws in its chain.
    connection
        How it is reached, see `servo.devices`.
    safety
        Limits, see `Safety`.
    placement
        Where on the device's axis the wall is.
    contact
        What is asked of the verdict, as of `zwidth.check`.
    decide
        In the place of `zwidth.check`, with contact as given.
    real_time
        What the loop's thread asks of the system; by default all that it may.

    Raises
    ------
    InputError
        If the device is of another motion than the connection, a number is an interval that the loop needs,
        or the device cannot be reached.
    """

    def __init__(
        self,
        device: Device,
        environment: object,
        connection: Connection,
        *,
        safety: Safety | None = None,
        placement: Placement | None = None,
        contact: Contact = "made and broken",
        decide: Decide | None = None,
        real_time: RealTime | None = None,
    ) -> None:
        check_supported()
        check_kinds(device, connection)
        self.device, self.connection = device, connection
        self.environment = as_environment(environment, device=device)
        self.safety, self.placement = safety or Safety(), placement or Placement()
        self.measured: Measured | None = None
        self.verdict: Verdict | None = None
        self._contact: Contact = contact
        self._decide = decide or (lambda loop, law: check(loop, law, contact=self._contact))
        self._certain = least_friction(device)
        self._period = self._certain.exact("sample_period")
        self._thread = LoopThread(connection, real_time or RealTime())
        self._limits = limits_of(self.safety, self._certain, float(self._period))
        self._first = self._packed(self.environment, 0.0)  # refused before the device is reached
        self._laws: list[tuple[str, Verdict]] = []
        self._closed = False
        self._opened = reach(connection, float(self._period))
        self._shared = self._anew(self._opened)
        atexit.register(self.close)

    def __exit__(self, kind: object = None, *_: object) -> None:
        """Force 0, then the device is let go."""
        if kind is not None and self.running:
            self._shared.control[STOP] = FAILED
        self.close()

    @property
    def rows(self) -> Rows:
        """What the loop writes down."""
        return self._rows

    @property
    def granted(self) -> Granted | None:
        """What the system granted the loop's thread; None before the first run."""
        return self._thread.granted

    @property
    def running(self) -> bool:
        """True while the loop has not ended."""
        return self._thread.running

    def measure(self, duration: RealLike = _MEASURED) -> Measured:
        """Run the loop with force 0 for so long [s], and note what this machine and the link are like.

        What was proved before was proved with other numbers: the law is judged anew.

        Raises
        ------
        InputError
            If the device does not answer to the end, or the loop runs, or the device was let go.
        """
        self._refuse_busy()
        last = self._count(duration)
        opened = self._opened
        if self.connection.samples is not None:
            last = min(last, self.connection.samples)
            opened = Opened(opened.memory.copy(), opened.inbox, opened.outbox)
        loop = self._shared = self._anew(opened)
        self._thread.run(loop, opened, last)
        self._thread.join()
        rows = self._rows.after(0)[1]
        rows = rows[rows[:, self._rows.column("phase")] == MEASURING]
        self._thread.raise_failure()
        if loop.control[REASON] != DONE:
            raise InputError(f"{self.connection.describe()} could not be measured: it {self.report().ended}")
        if len(rows) < min(last, 2):
            raise InputError(
                f"of {last} samples {len(rows)} could be taken in time: measure for longer, and see `zwidth "
                "doctor` for what else this machine does"
            )
        late, took = rows[:, self._rows.column("late_s")], rows[:, self._rows.column("exchange_s")]
        missed = int(loop.control[cycle.MISSED])
        self.measured = measured(late, took, missed, self.connection.late)
        self.verdict = None
        self._laws = []
        self._shared = self._anew(self._opened)
        return self.measured

    def judge(self, environment: Environment | None = None) -> Verdict:
        """What is claimed of a law on this device, as measured here; see `servo.proving`.

        Raises
        ------
        InputError
            If nothing was measured yet.
        """
        law = self.environment if environment is None else environment
        if self.measured is None:
            raise InputError("measure first: a verdict needs the delay of this machine and link")
        simulated = self.connection.samples is not None
        return judged(self._decide, self.device, law, self.measured, simulated=simulated)

    def start(self, duration: RealLike | None = None, *, anyway: bool = False) -> None:
        """Serve the law from where its force is near 0; until then the force is 0.

        Parameters
        ----------
        duration
            How long [s]; None: until `stop`, of a simulated device to the end of its script.
        anyway
            Also a law that is not proved passive.

        Raises
        ------
        NotProved
            If the law is not proved passive and `anyway` is False.
        InputError
            If it runs already or has ended, or the device was let go.
        """
        self._refuse_busy()
        if self._shared.control[REASON] != RUNNING:
            raise InputError("the loop has ended, and no force begins again by itself: measure again first")
        last = self._last(duration)
        self.prove(anyway=anyway)
        self._shared.control[WANTED] = 0
        self._thread.run(self._shared, self._opened, last)

    def prove(self, *, anyway: bool = False) -> Verdict:
        """What is claimed of the law that is to be served; measures first, where that was not done yet.

        Raises
        ------
        NotProved
            If it is not proved passive and `anyway` is False.
        """
        if self.measured is None:
            self.measure()
        if self.verdict is None:
            self.verdict = self.judge()
            self._laws = [(self._title, self.verdict)]
            self._rows.about["verdict"] = claimed(self.verdict)
        if not anyway:
            refuse_not_proved(self.verdict, cast(Measured, self.measured))
        return self.verdict

    def change(self, environment: object, *, anyway: bool = False) -> Verdict:
        """Serve another law, from where both forces are near 0, so that the force does not jump.

        Each of the two is judged by itself.  Where the new law begins it may have stored energy already: of a
        spring F²/(2K) at most, at `start_force` F.  One with several zeros begins around its lowest rest.

        Raises
        ------
        InputError
            If it is not proved passive and `anyway` is False; if the loop does not run; if a change is
            still waited for; if the law has more numbers than there is room for.
        """
        control = self._shared.control
        if not self.running:
            raise InputError("the loop does not run: start it with this law")
        if control[WANTED] != control[SERVED]:
            raise InputError("another law waits to begin: its force and that of the law now must come near 0")
        law = as_environment(environment, device=self.device)
        verdict = self.judge(law)
        if not anyway:
            refuse_not_proved(verdict, cast(Measured, self.measured))
        place = 1 - int(control[SERVED])
        self._put(self._shared, place, self._packed(law, float(self._shared.numbers[cycle.X])))
        self.environment, self.verdict = law, verdict
        self._first = self._packed(law, 0.0)  # of another run, after `measure`
        self._laws.append((self._title, verdict))
        self._rows.events.append(self._event(law))
        control[WANTED] = place
        return verdict

    def stop(self) -> None:
        """Ask the loop to end with force 0; does not wait."""
        if self._shared.control[STOP] == RUNNING:
            self._shared.control[STOP] = ASKED

    def wait(self, timeout: float | None = None) -> bool:
        """Wait until the loop has ended; False if it has not within so long [s].

        Raises
        ------
        Exception
            What a connection in Python raised in the loop.
        """
        return self._thread.wait(timeout)

    def close(self) -> None:
        """End the loop, give force 0, let the device go; may be called again."""
        atexit.unregister(self.close)
        self._closed = True
        self.stop()
        self._thread.join()
        self.connection.close()

    def report(self) -> ServoReport:
        """What happened so far; law and verdict are of the last one that began."""
        began = max(int(self._shared.control[cycle.CHANGES]) - 1, 0)
        title, verdict = self._laws[began] if self._laws else (self._title, None)
        return report_of(self._shared, title, self.connection, self.measured, verdict, self._thread.granted)

    def _packed(self, law: Environment, here: float) -> Packed:
        return pack(self._certain, law, here, self._limits.start_force)

    def _anew(self, opened: Opened) -> Shared:
        """Arrays for a run from sample 0."""
        period = float(self._period)
        size, remembered = self._first.law.size, self._first.rest.shape[2]
        found = shared(max(_ROOM, size), max(_REMEMBERED, remembered), ring(period), STATE_SIZE)
        n = found.numbers
        n[cycle.PERIOD], n[cycle.SENSE], n[cycle.ORIGIN] = period, self.placement.sense, self.placement.origin
        n[cycle.FORCE_MOST : cycle.HOST_MOST + 1] = self._limits
        if opened is not self._opened:
            n[cycle.JUMP_MOST] = inf  # no wall stops the hand of a script while it is measured
        n[cycle.DAMPING] = float(self._certain.exact("damping"))
        n[cycle.COULOMB] = float(self._certain.exact("coulomb_friction"))
        if self.device.transmission is not None and self.device.transmission.encoder == "handle":
            n[[cycle.WORK, cycle.LOSS, cycle.LEAST]] = nan  # the encoder does not see how the motor moves
        late, exchange = (inf, inf) if self.measured is None else self.measured.supposed
        n[cycle.LATE_MOST] = late
        n[cycle.EXCHANGE_MOST] = exchange if self.connection.samples is None else inf
        n[cycle.SETTLED] = 2 + self.connection.late + int(ends(self.device.delay)[1] / self._period)
        self._put(found, 0, self._first)
        found.control[HEARTBEAT] = now()
        self._rows = Rows(
            self.connection,
            found.ring,
            found.control,
            ROWS,
            period=period,
            title=self._title,
            about=about(self.device, self.environment, self.connection, self.placement, self.safety),
        )
        self._rows.events.append(self._event(self.environment))
        return found

    @property
    def _title(self) -> str:
        return f"{self.environment.describe(self.device.motion)} on {self.connection.describe()}"

    def _event(self, law: Environment) -> dict[str, Any]:
        return {
            "after_row": self._rows.count,
            "law": law.describe(self.device.motion),
            "specification": specification(self.device, law),
        }

    @staticmethod
    def _put(loop: Shared, place: int, packed: Packed) -> None:
        size, remembered = packed.law.size, packed.rest.shape[2]
        if size > loop.laws.shape[1] or remembered > loop.memories.shape[1]:
            raise InputError(
                f"the law has {size} numbers and remembers {remembered}; a running loop has room for "
                f"{loop.laws.shape[1]} and {loop.memories.shape[1]}: end it and start with this law"
            )
        loop.laws[place, :size] = packed.law
        loop.rests[place] = 0.0
        loop.rests[place, ..., :remembered] = packed.rest
        first = cycle.BEGINS + 2 * place
        loop.numbers[first : first + 2] = packed.begins

    def _last(self, duration: RealLike | None) -> int:
        if duration is None:
            return -1 if self.connection.samples is None else self.connection.samples
        return self._count(duration)

    def _count(self, duration: RealLike) -> int:
        return min(max(1, int(seconds_of(duration).fraction / self._period)), _LONGEST)

    def _refuse_busy(self) -> None:
        """One loop at a time speaks to a device, and none to a device that was let go."""
        if self._closed:
            raise InputError("the device was let go: reach it again with another Servo")
        if self.running:
            raise InputError("the loop runs already: change the law, or stop it first")


def about(
    device: Device, environment: Environment, connection: Connection, placement: Placement, safety: Safety
) -> dict[str, Any]:
    """What a recording keeps of a servo: texts and numbers, units in the keys."""
    x = "rad" if device.motion == "rotary" else "m"
    return {
        "zwidth_version": __version__,
        "started": datetime.now(UTC).isoformat(timespec="seconds"),
        "device": device.name,
        "motion": device.motion,
        "connection": connection.describe(),
        "law": environment.describe(device.motion),
        "specification": specification(device, environment),
        f"origin_{x}": placement.origin,
        "sense": placement.sense,
        "safety": {name: None if value is None else float(value) for name, value in vars(safety).items()},
    }


def specification(device: Device, environment: Environment) -> str:
    """The loop in TOML; "" where a specification has no words for it."""
    try:
        return written(device, environment)
    except InputError:
        return ""
