"""What happens when a hand touches the wall: the loop simulated without time-step error.

Between two changes of force the motion has a closed form, and so have its
energies; nothing is integrated numerically.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, overload

import numpy as np

from zwidth.errors import InputError
from zwidth.loop.kernel import run
from zwidth.loop.pair.setup import Holder
from zwidth.loop.pair.simulate import Friction, simulated_pair
from zwidth.loop.plant import FAULT, STOPS, TOO_MANY_STOPS
from zwidth.loop.runs import run_plain
from zwidth.loop.setup import Setup, empty_record, prepare
from zwidth.loop.timing import Timing
from zwidth.loop.trace import Trace, build_trace
from zwidth.loop.two_masses_run import run_two
from zwidth.model.device.amplifier import Amplifier
from zwidth.model.device.device import Device
from zwidth.model.operator.operator import Operator
from zwidth.model.pairs import Pair
from zwidth.quantity.exact import RealLike

if TYPE_CHECKING:
    import xarray as xr
    from numpy.typing import NDArray

Progress = Callable[[int, int], None]
"""Told (done, total) samples now and then."""

_STRIDE = 200_000
"""Samples between two looks at progress and Ctrl-C."""


@overload
def simulate(
    device: Device,
    environment: object,
    operator: Operator,
    duration: RealLike,
    *,
    initial_position: RealLike | None = ...,
    initial_velocity: RealLike = ...,
    encoder_phase: float = ...,
    amplifier: Amplifier | None = ...,
    timing: Timing | None = ...,
    points_per_sample: int = ...,
    progress: Progress | None = ...,
) -> xr.Dataset: ...
@overload
def simulate(
    device: Pair,
    environment: Holder,
    operator: Holder,
    duration: RealLike,
    *,
    encoder_phase: tuple[float, float] | float = ...,
    amplifier: Amplifier | None = ...,
    points_per_sample: int = ...,
    friction: Friction | tuple[Friction, Friction] = ...,
    progress: Progress | None = ...,
) -> xr.Dataset: ...
def simulate(
    device: Device | Pair,
    environment: object,
    operator: Operator | Holder,
    duration: RealLike,
    *,
    initial_position: RealLike | None = None,
    initial_velocity: RealLike = 0.0,
    encoder_phase: float | tuple[float, float] = 0.0,
    amplifier: Amplifier | None = None,
    timing: Timing | None = None,
    points_per_sample: int = 1,
    friction: Friction | tuple[Friction, Friction] = None,
    progress: Progress | None = None,
) -> xr.Dataset:
    """Simulate a hand on the device, ``m ẍ = f_h − f_a − f_c sgn ẋ − b ẋ``, exactly.

    Of a device with a `Transmission` two masses, see there; the hand is on the handle. Of a `Pair`,
    ``simulate(pair, leader, follower, duration)`` with what holds either arm, see `simulation.simulate_pair`.

    Parameters
    ----------
    device
        With a mass; every number certain.
    environment
        An `Environment`, or a discrete system of python-control, scipy.signal or harold.
    operator
        The hand, see `zwidth.operators`.
    duration
        At least one sample period [s]; whole samples of it are simulated.
    initial_position
        x at t = 0 [m; rad], > 0 inside the wall; by default where the operator starts.  For a law on
        both sides of x = 0 that is where the law is at rest, unless the operator's own start is given.
    initial_velocity
        ẋ at t = 0 [m/s; rad/s], of motor and handle.
    encoder_phase
        φ in x_m = Δ floor(x/Δ + φ), 0 ≤ φ < 1 [counts].
    amplifier
        See `zwidth.amplifiers`; by default the force limit and the converter's steps where the
        device knows them.
    timing
        Late and missed samples; by default none.
    points_per_sample
        Instants recorded per sample; more of them show the motion between samples. The motion
        itself does not depend on it.
    friction
        Of the arms of a `Pair` alone: a measured curve in the place of f_c and b.
    progress
        Called with (samples done, samples in all).

    Returns
    -------
    xarray.Dataset
        Position, velocity, forces and energies along `time`, units in the attributes; the attribute
        `stored_at_start_J` is the most that the loop had stored at first.
        Interrupted by Ctrl-C, what was finished; its attribute `interrupted_at_s` says so.
        A motion that grows without bound ends at 1e120; `diverged_at_s` says so.

    Raises
    ------
    InputError
        If something is missing, not finite, of the wrong length, or out of its bounds.
    """
    return simulated(
        device,
        environment,
        operator,
        duration,
        initial_position=initial_position,
        initial_velocity=initial_velocity,
        encoder_phase=encoder_phase,
        amplifier=amplifier,
        timing=timing,
        points_per_sample=points_per_sample,
        friction=friction,
        progress=progress,
    ).dataset()


def simulated(device: Any, environment: Any, operator: Any, duration: RealLike, **how: Any) -> Trace:
    """What `simulate` returns, before it is a Dataset."""
    is_pair = isinstance(device, Pair)
    foreign, why = _OF_ONE if is_pair else _OF_A_PAIR
    if any(how.pop(name, usual) != usual for name, usual in foreign.items()):
        raise InputError(why)
    return (simulated_pair if is_pair else _simulated_one)(device, environment, operator, duration, **how)


_OF_ONE = (
    {"initial_position": None, "initial_velocity": 0.0, "timing": None},
    "a pair starts where its hands do, at rest, with a regular clock: leave out initial position and "
    "velocity, lateness and missed samples, in Python timing",
)
_OF_A_PAIR = (
    {"friction": None},
    "friction: a curve is simulated of the arms of a pair; give the device f_c and b",
)
"""What the other subject alone takes, with what it is by default, and why this one does not."""


def _simulated_one(
    device: Device,
    environment: object,
    operator: Operator,
    duration: RealLike,
    *,
    progress: Progress | None = None,
    **how: Any,
) -> Trace:
    setup = prepare(device, environment, operator, duration, flexible=True, **how)
    commands, record, work = empty_record(setup.frame, setup.two is not None)
    state, memory = setup.state.copy(), setup.memory.copy()
    done = run_setup(setup, state, memory, work, commands, record, progress)
    if state[FAULT] != 0.0:
        raise InputError(TOO_MANY_STOPS)
    return build_trace(setup, record, done, stops=int(state[STOPS]))


def run_setup(
    setup: Setup,
    state: NDArray[np.float64],
    memory: NDArray[np.float64],
    work: NDArray[np.float64],
    commands: NDArray[np.float64],
    record: NDArray[np.float64],
    progress: Progress | None,
) -> int:
    """Run all of it, or what Ctrl-C leaves; returns the number of samples finished."""
    total = setup.frame.samples + 1
    done = 0
    try:
        while done < total:
            stop = min(total, done + _STRIDE)
            run_samples(setup, done, stop, state, memory, work, commands, record)
            done = stop
            if progress is not None:
                progress(min(done, setup.frame.samples), setup.frame.samples)
    except KeyboardInterrupt:
        if done < 1:
            raise
    return done


def run_samples(
    setup: Setup,
    first: int,
    last: int,
    state: NDArray[np.float64],
    memory: NDArray[np.float64],
    work: NDArray[np.float64],
    commands: NDArray[np.float64],
    record: NDArray[np.float64],
) -> None:
    """Take the samples `first` … `last` − 1, each with the interval behind it; can be called again."""
    law, late = setup.law, setup.frame.late
    force, anchor, target, switch = setup.frame.optional()
    if setup.plain and setup.two is None:
        period = float(setup.frame.lengths[0])
        run_plain(first, last, state, setup.plant_numbers, law, late, period, force, commands, record)
        return
    step, numbers = (run, setup.plant_numbers) if setup.two is None else (run_two, setup.two)
    step(
        first, last, setup.frame.points, state, numbers, law, memory, work,
        late, setup.frame.offset, setup.frame.lengths, setup.frame.arrivals, setup.frame.missed,
        force, anchor, target, switch, commands, record,
    )  # fmt: skip
