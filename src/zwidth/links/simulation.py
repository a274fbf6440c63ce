"""What happens when two hands hold two devices whose ports are joined by a link: without time-step error."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from zwidth.errors import InputError
from zwidth.links import springs, wave_port, waves
from zwidth.links.memory import ENERGY, NUMBER, POSITION, WAVE, hear
from zwidth.links.port import Port
from zwidth.links.schedule import Schedule
from zwidth.loop.kernel import R_COMMAND, R_READING, first_due
from zwidth.loop.pair.kernel import Arm, read, through
from zwidth.loop.pair.setup import Holder, prepare_pair
from zwidth.loop.pair.simulate import build_pair_trace
from zwidth.loop.plant import FAULT, FORCE, GOAL, TOO_MANY_STOPS, WORK
from zwidth.loop.trace import Trace
from zwidth.model.pairs import Pair
from zwidth.native.compiled import Array, compiled
from zwidth.quantity.exact import RealLike
from zwidth.quantity.text import shown

if TYPE_CHECKING:
    import xarray as xr
    from numpy.typing import NDArray

    Ticks = NDArray[np.int64]


def simulate(
    leader: Port,
    follower: Port,
    schedule: Schedule,
    leader_hand: Holder,
    follower_hand: Holder,
    duration: RealLike,
    *,
    encoder_phase: tuple[float, float] = (0.0, 0.0),
    points_per_sample: int = 1,
    progress: Callable[[int, int], None] | None = None,
) -> xr.Dataset:
    """Simulate both devices, each ``m ẍ = f_h − f_a − f_c sgn ẋ − b ẋ``, exactly, and the link between them.

    Parameters
    ----------
    leader, follower
        Ports that start anew; their devices have a mass and one sample period.
    schedule
        What the link does to packets, in each way with draws of its own.
    leader_hand, follower_hand
        What is there: a hand, see `zwidth.operators`; a `zwidth.Wall`, which stands really at x = 0; or None
        for nobody.  A hand is on one of them at least.
    duration
        At least one sample period [s].
    encoder_phase
        φ of leader and follower, in x_m = Δ floor(x/Δ + φ), 0 ≤ φ < 1 [counts].
    points_per_sample
        Instants recorded between two samples.
    progress
        Called with (samples done, samples in all).

    Returns
    -------
    xarray.Dataset
        As of `zwidth.simulate` of a pair: ``trace.zwidth.energy``, ``trace.zwidth.plot()``.

    Raises
    ------
    InputError
        If the ports do not fit together, or something is missing or out of its bounds.
    """
    import zwidth.loop.traces.accessor  # noqa: F401 - gives every trace its `.zwidth`

    given: dict[str, Any] = {"encoder_phase": encoder_phase, "points_per_sample": points_per_sample}
    hands = (leader_hand, follower_hand)
    return simulated(leader, follower, schedule, *hands, duration, progress=progress, **given).dataset()


def simulated(
    leader: Port,
    follower: Port,
    schedule: Schedule,
    leader_hand: Holder,
    follower_hand: Holder,
    duration: RealLike,
    *,
    progress: Callable[[int, int], None] | None = None,
    **how: Any,
) -> Trace:
    """What `simulate` returns, before it is a Dataset."""
    check_ends(leader, follower)
    # a pair lays out both arms; its spring is not used
    pair = Pair(leader.device, follower.device, stiffness=1)
    setup = prepare_pair(pair, leader_hand, follower_hand, duration, **how)
    ends = _ends(leader, follower, schedule, setup.ticks)
    for arm in setup.arms:
        arm.state[FORCE] = arm.state[GOAL] = 0.0
    work, total = np.zeros(WORK), setup.ticks + 1
    run_link(0, total, setup.points, setup.tick, setup.arms[0], ends[0], setup.arms[1], ends[1], work)
    if progress is not None:
        progress(setup.ticks, setup.ticks)
    if any(arm.state[FAULT] for arm in setup.arms):
        raise InputError(TOO_MANY_STOPS)
    trace = build_pair_trace(setup, total)
    late = float(schedule.delay)
    trace.attrs |= {
        "coupling": f"{leader.describe()}; {schedule.describe()}",
        "link_delay_there_s": late,
        "link_delay_back_s": late,
        "stored_at_start_J": 0.0,
    }
    return trace


def check_ends(leader: Port, follower: Port) -> None:
    """Two ports of one clock, in one unit."""
    for name, port in (("leader", leader), ("follower", follower)):
        if not isinstance(port, Port):
            raise InputError(f"{name} is a port of zwidth.links, got {type(port).__name__}")
    periods = [port.device.exact("sample_period") for port in (leader, follower)]
    if periods[0] != periods[1]:
        raise InputError(
            f"both devices are simulated with one sample period, got {shown(periods[0], 's', 6)} and "
            f"{shown(periods[1], 's', 6)}; the ports themselves may differ"
        )


def _ends(leader: Port, follower: Port, schedule: Schedule, samples: int) -> tuple[End, End]:
    """Each with a state of its own: the ports that were given stay as they are."""
    period = leader.device.exact("sample_period")
    wires = [wire_of(*schedule.arrivals(samples, period, way), samples) for way in (0, 1)]
    first, second = (
        End(port.code, port.numbers, port.fresh_state(), wire)
        for port, wire in zip((leader, follower), wires[::-1], strict=True)
    )
    return first, second


class End(NamedTuple):
    """One port: its law, what that knows, and the wire on which it hears."""

    code: float
    numbers: Array
    state: Array
    hears: Wire


@compiled
def run_link(
    start: int, stop: int, points: int, h: float, leader: Arm, near: End, follower: Arm, far: End, work: Array
) -> None:
    """Run the samples `start` … `stop` − 1; can be called again."""
    nothing = work[:0].reshape((2, 0))
    due, its_due = first_due(start, leader.late, nothing), first_due(start, follower.late, nothing)
    final = leader.commands.shape[0] - 1
    for k in range(start, stop):
        say(leader, near, far.hears, k)
        say(follower, far, near.hears, k)
        command(leader, near, k, points)
        command(follower, far, k, points)
        due = through(leader, due, k, points, h, k == final, work)
        its_due = through(follower, its_due, k, points, h, k == final, work)


@compiled
def say(arm: Arm, end: End, wire: Wire, k: int) -> None:
    """Read the arm, and send what the period that has ended makes of it."""
    read(arm, k)
    if k > 0:
        law_send(end.code, end.numbers, end.state, arm.readings[k] - arm.readings[k - 1])
        post(wire, end.state)


@compiled
def command(arm: Arm, end: End, k: int, points: int) -> None:
    """Hear what has arrived, and ask the actuator for the port's force, which is positive along x."""
    deliver(end.hears, k, end.state)
    f = -law_force(end.code, end.numbers, end.state)
    arm.commands[k] = f
    for column in range(k * points, min((k + 1) * points, arm.record.shape[1])):
        arm.record[R_READING, column] = arm.readings[k]
        arm.record[R_COMMAND, column] = f


class Wire(NamedTuple):
    """`when` and `again` of each packet are as of `Schedule.arrivals`; the rest is filled by and by.

    `first` has for each sample the packet that is heard first, `following` for each packet the next one
    that is heard at the same sample, duplicates counted on behind the packets; −1 for none.
    """

    when: Ticks
    again: Ticks
    first: Ticks
    following: Ticks
    told: Array


def wire_of(when: Ticks, again: Ticks, samples: int) -> Wire:
    """An empty one."""
    count = when.size
    return Wire(when, again, np.full(samples + 1, -1), np.full(2 * count, -1), np.zeros((count, 3)))


@compiled
def post(wire: Wire, s: Array) -> None:
    """Put the packet that the state holds on the way."""
    number = int(s[NUMBER])
    count = wire.when.size
    wire.told[number, 0], wire.told[number, 1], wire.told[number, 2] = s[WAVE], s[ENERGY], s[POSITION]
    for due, node in ((wire.when[number], number), (wire.again[number], number + count)):
        if 0 <= due < wire.first.size:
            wire.following[node] = wire.first[due]
            wire.first[due] = node


@compiled
def deliver(wire: Wire, k: int, s: Array) -> None:
    """Let a port hear all that arrives at sample k."""
    node = wire.first[k]
    while node >= 0:
        number = node % wire.when.size
        hear(s, float(number), wire.told[number, 0], wire.told[number, 1], wire.told[number, 2])
        node = wire.following[node]


@compiled
def law_force(code: float, p: Array, s: Array) -> float:
    """The force of any port for the coming period: step functions call each other by name alone."""
    if code == wave_port.WAVE_PORT:
        return wave_port.force(p, s)
    if code == waves.HELD_WAVES:
        return waves.held_force(p, s)
    if code == waves.NAIVE_WAVES:
        return waves.naive_force(p, s)
    if code == springs.POSITION_HOLD:
        return springs.position_force(p, s)
    if code == springs.TIME_DOMAIN:
        return springs.damped_force(p, s)
    return springs.tank_force(p, s)


@compiled
def law_send(code: float, p: Array, s: Array, moved: float) -> None:
    """What any port does after the move."""
    if code == wave_port.WAVE_PORT:
        wave_port.send(p, s, moved)
    elif code == waves.HELD_WAVES:
        waves.held_send(p, s, moved)
    elif code == waves.NAIVE_WAVES:
        waves.naive_send(p, s, moved)
    elif code == springs.POSITION_HOLD:
        springs.move_on(p, s, moved)
    elif code == springs.TIME_DOMAIN:
        springs.damped_send(p, s, moved)
    else:
        springs.tank_send(p, s, moved)
