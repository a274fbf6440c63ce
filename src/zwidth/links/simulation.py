"""What happens when two hands hold two devices whose ports are joined by a link: without time-step error."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from zwidth.errors import InputError
from zwidth.links.kernel import End, run_link
from zwidth.links.port import Port
from zwidth.links.schedule import Schedule
from zwidth.links.wire import wire_of
from zwidth.loop.pair.setup import Holder, prepare_pair
from zwidth.loop.pair.trace import build_pair_trace
from zwidth.loop.plant import FAULT, FORCE, GOAL
from zwidth.loop.series import WORK
from zwidth.loop.trace import Trace
from zwidth.model.pairs import Pair
from zwidth.quantity.exact import RealLike

if TYPE_CHECKING:
    import xarray as xr


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

    return simulated(
        leader,
        follower,
        schedule,
        leader_hand,
        follower_hand,
        duration,
        encoder_phase=encoder_phase,
        points_per_sample=points_per_sample,
        progress=progress,
    ).dataset()


def simulated(
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
) -> Trace:
    """What `simulate` returns, before it is a Dataset."""
    check_ends(leader, follower)
    # a pair lays out both arms; its spring is not used
    pair = Pair(leader.device, follower.device, stiffness=1)
    setup = prepare_pair(
        pair,
        leader_hand,
        follower_hand,
        duration,
        encoder_phase=encoder_phase,
        amplifier=None,
        points_per_sample=points_per_sample,
    )
    ends = _ends(leader, follower, schedule, setup.ticks)
    for arm in setup.arms:
        arm.state[FORCE] = arm.state[GOAL] = 0.0
    work, total = np.zeros(WORK), setup.ticks + 1
    run_link(0, total, setup.points, setup.tick, setup.arms[0], ends[0], setup.arms[1], ends[1], work)
    if progress is not None:
        progress(setup.ticks, setup.ticks)
    if any(arm.state[FAULT] for arm in setup.arms):
        raise InputError(
            "the motion has too many stops in one sample to be followed: device, hand and forces differ by "
            "so many orders of magnitude that rounding decides; scale them closer together"
        )
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
            f"both devices are simulated with one sample period, got {float(periods[0]):g} s and "
            f"{float(periods[1]):g} s; the ports themselves may differ"
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
