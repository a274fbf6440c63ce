"""What happens when two hands, or a hand and a wall, hold a pair: simulated without time-step error."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from zwidth.errors import InputError
from zwidth.loop.pair.kernel import run_pair
from zwidth.loop.pair.setup import Holder, PairSetup, prepare_pair
from zwidth.loop.pair.trace import build_pair_trace
from zwidth.loop.plant import FAULT
from zwidth.loop.series import WORK
from zwidth.loop.trace import Trace
from zwidth.model.device import FrictionCurve
from zwidth.model.device.amplifier import Amplifier
from zwidth.model.pairs import Pair
from zwidth.quantity.exact import RealLike

if TYPE_CHECKING:
    import xarray as xr

Friction = FrictionCurve | None

_STRIDE = 100_000
"""Ticks between two looks at progress and Ctrl-C."""


def simulate_pair(
    pair: Pair,
    leader: Holder,
    follower: Holder,
    duration: RealLike,
    *,
    encoder_phase: tuple[float, float] | float = 0.0,
    amplifier: Amplifier | None = None,
    points_per_sample: int = 1,
    friction: Friction | tuple[Friction, Friction] = None,
    progress: Callable[[int, int], None] | None = None,
) -> xr.Dataset:
    """Simulate both arms, each ``m ẍ = f_h − f_a − f_c sgn ẋ − b ẋ``, exactly, and the link between them.

    Before the start both arms had always been where they are then.

    Parameters
    ----------
    pair
        With a mass of each arm that no motion is prescribed to.
    leader, follower
        What is there: a hand, see `zwidth.operators`; a `zwidth.Wall`, which stands really at x = 0 and
        pushes where x > 0, in continuous time; or None for nobody.  A hand is on one of them at least.
    duration
        At least one sample period [s].
    encoder_phase
        φ, or those of leader and follower, in x_m = Δ floor(x/Δ + φ), 0 ≤ φ < 1 [counts].
    amplifier
        Of both arms, see `zwidth.amplifiers`; by default what each device knows of its own.
    points_per_sample
        Instants recorded between two readings of an arm's own.
    friction
        The measured curve in the place of f_c and b of both devices, or those of leader and follower; None
        for the device's own.  Between two points it is straight, below the first the first force, beyond the
        last the last chord, or the last force where that chord falls; f(0) is the stiction.
    progress
        Called with (readings done, readings in all).

    Returns
    -------
    xarray.Dataset
        Along `arm` ("leader", "follower") and `time`: position, velocity, forces and energies, units in the
        attributes.  ``trace.zwidth.energy`` is the ledger of both, ``trace.zwidth.plot()`` the picture.

    Raises
    ------
    InputError
        If something is missing, not finite, of the wrong length, or out of its bounds.
    """
    return simulated_pair(
        pair,
        leader,
        follower,
        duration,
        encoder_phase=encoder_phase,
        amplifier=amplifier,
        points_per_sample=points_per_sample,
        friction=friction,
        progress=progress,
    ).dataset()


def simulated_pair(
    pair: Pair,
    leader: Holder,
    follower: Holder,
    duration: RealLike,
    *,
    encoder_phase: tuple[float, float] | float = 0.0,
    amplifier: Amplifier | None = None,
    points_per_sample: int = 1,
    friction: Friction | tuple[Friction, Friction] = None,
    progress: Callable[[int, int], None] | None = None,
) -> Trace:
    """What `simulate_pair` returns, before it is a Dataset."""
    setup = prepare_pair(
        pair,
        leader,
        follower,
        duration,
        encoder_phase=_both(encoder_phase),
        amplifier=amplifier,
        points_per_sample=points_per_sample,
        friction=_curves(friction),
    )
    done = _run(setup, progress)
    if any(arm.state[FAULT] for arm in setup.arms):
        raise InputError(
            "the motion has too many stops in one sample to be followed: device, hand and forces differ by "
            "so many orders of magnitude that rounding decides; scale them closer together"
        )
    return build_pair_trace(setup, done)


def _both(phase: tuple[float, float] | float) -> tuple[float, float]:
    try:
        leader, follower = phase if isinstance(phase, (tuple, list)) else (phase, phase)
        return float(leader), float(follower)
    except (TypeError, ValueError):
        raise InputError(
            f"encoder_phase is a number, or one for the leader and one for the follower, got {phase!r}"
        ) from None


def _curves(given: Friction | tuple[Friction, Friction]) -> tuple[Friction, Friction]:
    leader, follower = given if isinstance(given, tuple) and len(given) == 2 else (given, given)
    for name, curve in (("leader", leader), ("follower", follower)):
        if not isinstance(curve, FrictionCurve | None):
            raise InputError(f"friction of the {name} is a FrictionCurve or None, got {type(curve).__name__}")
    return leader, follower


def _run(setup: PairSetup, progress: Callable[[int, int], None] | None) -> int:
    total, done, work = setup.ticks + 1, 0, np.zeros(WORK)
    try:
        while done < total:
            stop = min(total, done + _STRIDE)
            run_pair(done, stop, setup.often, setup.points, setup.tick, *setup.arms, work)
            done = stop
            if progress is not None:
                progress(min(done, setup.ticks), setup.ticks)
    except KeyboardInterrupt:
        if done < 1:
            raise
    return done
