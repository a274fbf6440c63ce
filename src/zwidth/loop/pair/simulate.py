"""What happens when two hands, or a hand and a wall, hold a pair, and the trace of it.

The trace lies along `arm` and `time`; of each arm, ``trace.sel(arm="leader")``, it has the variables of one.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from zwidth import __version__
from zwidth.errors import InputError
from zwidth.loop.pair.kernel import run_pair
from zwidth.loop.pair.setup import Holder, PairSetup, prepare_pair
from zwidth.loop.plant import FAULT, POSITION, STOPS, TOO_MANY_STOPS, WORK
from zwidth.loop.trace import (
    UNITS,
    VARIABLES,
    Labelled,
    Trace,
    Variable,
    along_time,
    attributes_of,
    before_overflow,
    instants,
    values_of,
)
from zwidth.model.device import FrictionCurve
from zwidth.model.device.amplifier import Amplifier
from zwidth.model.environment.environment import with_unit
from zwidth.model.operator.operator import Operator, Signals
from zwidth.model.pairs import Pair
from zwidth.quantity.exact import RealLike

if TYPE_CHECKING:
    import xarray as xr
    from numpy.typing import NDArray

    Array = NDArray[np.float64]


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
    given = {"encoder_phase": encoder_phase, "amplifier": amplifier, "points_per_sample": points_per_sample}
    how: dict[str, Any] = {**given, "friction": friction, "progress": progress}
    return simulated_pair(pair, leader, follower, duration, **how).dataset()


def simulated_pair(
    pair: Pair,
    leader: Holder,
    follower: Holder,
    duration: RealLike,
    *,
    encoder_phase: tuple[float, float] | float = 0.0,
    friction: Friction | tuple[Friction, Friction] = None,
    progress: Callable[[int, int], None] | None = None,
    **how: Any,
) -> Trace:
    """What `simulate_pair` returns, before it is a Dataset."""
    phases, curves = _both(encoder_phase), _curves(friction)
    setup = prepare_pair(pair, leader, follower, duration, encoder_phase=phases, friction=curves, **how)
    done = _run(setup, progress)
    if any(arm.state[FAULT] for arm in setup.arms):
        raise InputError(TOO_MANY_STOPS)
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


FORMAT = "zwidth pair trace 1"

ARMS = ("leader", "follower")

_WORDS = {
    "position": "position",
    "commanded_force": "force that the newest readings ask for, against the arm's position",
    "actuator_force": "force of the actuator, against the arm's position",
    "hand_force": "force of the hand, or of the wall, on the arm",
    "hand_spring_energy": "energy in the hand's or the wall's spring",
    "hand_damper_loss": "energy lost in the hand's or the wall's damper",
}
"""Of variables that have no wall of the loop to go by."""


def build_pair_trace(setup: PairSetup, done: int) -> Trace:
    """The trace of the first `done` ticks of the records, up to where the numbers outgrow any meaning."""
    finished = min(setup.columns, done * setup.points if done <= setup.ticks else setup.columns)
    columns = min(before_overflow(arm.record, finished) for arm in setup.arms)
    values = [_values(setup, here, columns) for here in (0, 1)]
    time = instants(setup.frames[0])[:columns]
    sampled = np.arange(columns) % (setup.points * setup.often) == 0
    attributes = _attrs(setup)
    if columns < finished:
        attributes["diverged_at_s"] = float(time[-1])
    elif finished < setup.columns:
        attributes["interrupted_at_s"] = float(time[-1])
    return labelled(values, time, sampled, attributes)


def labelled(
    values: list[dict[str, Array]], time: Array, sampled: NDArray[np.bool_], attributes: dict[str, Any]
) -> Trace:
    """The trace of the variables of leader and follower; nan where only the other has one."""
    units = (*UNITS[attributes["motion"]], "J")
    variables = {
        name: Labelled(
            ("arm", "time"),
            np.stack([part.get(name, np.full(time.size, np.nan)) for part in values]),
            attributes_of(Variable(about.symbol, _WORDS.get(name, about.long_name), about.kind), units),
        )
        for name, about in VARIABLES.items()
        if any(name in part for part in values)
    }
    coordinates = {
        "arm": Labelled(("arm",), np.array(ARMS), {}),
        **along_time(time, sampled, "both arms send at this instant"),
    }
    return Trace(variables, coordinates, attributes)


def _values(setup: PairSetup, here: int, columns: int) -> dict[str, Array]:
    arm, frame = setup.arms[here], setup.frames[here]
    if not arm.wall:
        return values_of(frame, arm.record, columns)
    resting = Signals(anchor=np.zeros(frame.samples + 1))
    values = values_of(frame._replace(plant=arm.inside, signals=resting), arm.record, columns)
    del values["anchor_position"]
    met = values["position"] > 0
    for name in ("hand_force", "hand_spring_energy"):
        values[name] = np.where(met, values[name], 0.0)
    return values


def _attrs(setup: PairSetup) -> dict[str, Any]:
    pair = setup.pair
    result: dict[str, Any] = {
        "format": FORMAT,
        "zwidth_version": __version__,
        "coupling": pair.describe(),
        "motion": pair.motion,
        "sample_period_s": float(pair.sample_period),
        "own_readings": setup.often,
        "link_delay_there_s": float(pair.there),
        "link_delay_back_s": float(pair.back),
        "power_ratio": float(pair.power_ratio),
        "stored_at_start_J": stored_at_start(setup),
    }
    for name, here in zip(ARMS, (0, 1), strict=True):
        device, frame, arm = (pair.leader, pair.follower)[here], setup.frames[here], setup.arms[here]
        own = {
            "device": device.name,
            "holder": described(setup.holders[here], pair.motion),
            "amplifier": frame.amplifier.describe(),
            "delay_s": float(device.exact("delay")),
            device.key("resolution"): frame.resolution,
            "encoder_phase_counts": arm.law.phase,
            device.key("mass"): arm.plant.mass,
            device.key("damping"): arm.plant.damping,
            device.key("coulomb_friction"): arm.plant.coulomb,
            device.key("stiction"): arm.plant.stiction,
            "stops": int(arm.state[STOPS]),
        }
        result |= {f"{name}_{key}": value for key, value in own.items()}
    return result


def described(holder: Holder, motion: str) -> str:
    """What is on one side, on one line."""
    if isinstance(holder, Operator):
        return holder.describe(motion)
    if holder is None:
        return "nobody"
    parts = [with_unit("stiffness", holder.stiffness, motion)]
    if holder.damping:
        parts.append(with_unit("virtual_damping", holder.damping, motion))
    return f"a real wall, {', '.join(parts)}"


def stored_at_start(setup: PairSetup) -> float:
    """½ K_l (|x_l − x_f| + (Δ_l + Δ_f)/2)², the most that the spring between two arms at rest holds [J].

    A passive pair gives out no more: in readings of the middle of each count its ideal form starts from a
    spring stretched by no more than that, and friction covers what counts add later (docs/theory/pairs.md).
    """
    leader, follower = (float(arm.record[POSITION, 0]) for arm in setup.arms)
    steps = sum(arm.law.resolution for arm in setup.arms)
    return 0.5 * float(setup.pair.felt_stiffness) * (abs(leader - follower) + steps / 2) ** 2
