"""Many laws, with defaults from the device, and the same touches: what each promises, keeps and costs."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import replace
from fractions import Fraction
from math import pi
from typing import TYPE_CHECKING, Any, NamedTuple, overload

import numpy as np

from zwidth.errors import InputError
from zwidth.loop.setup import empty_record, prepare
from zwidth.loop.simulate import run_setup, simulate
from zwidth.loop.traces.measures import (
    SOURCE,
    WEBER,
    bounces,
    chatter,
    free_damping,
    generated_energy,
    noticeable_differences,
    peak_force,
    penetration,
    rate_hardness,
    rms_force,
    settling_time,
    static_stiffness,
)
from zwidth.model.device.device import Device
from zwidth.model.device.rotary import ROTARY, at_handle
from zwidth.model.environment.environment import Environment
from zwidth.model.environment.transfer_function import as_environment
from zwidth.model.environment.velocity import OnePole, Window
from zwidth.model.environment.wall import Wall, wall_of
from zwidth.model.operator import TypicalTouch
from zwidth.model.pairs import Pair
from zwidth.model.rendering import (
    AdaptiveWindow,
    BrakingPulse,
    CrossingCorrection,
    Damper,
    DualRate,
    EnergyBounding,
    EnergyTank,
    EventTransient,
    Extrapolation,
    ForceBounding,
    HalfSamplePrediction,
    Held,
    Hysteresis,
    Kalman,
    PassiveLeap,
    PassivityController,
    PoleMatched,
    RateTerm,
    RenderingLaw,
    TickTime,
    VirtualCoupling,
    WindowedController,
    render,
)
from zwidth.model.rendering.rendered import laws_of
from zwidth.model.rendering.rendering_law import LoopContext
from zwidth.quantity.exact import Exact, RealLike
from zwidth.quantity.parameter import read_number
from zwidth.study.bench.adversary import FASTEST, Attack, attack
from zwidth.study.bench.comparison import LawComparison, Touch, standard_touches
from zwidth.study.bench.motions import found_motions
from zwidth.study.bench.pairs import PairComparison, compare_pairs
from zwidth.study.bench.standing import Standing, standing

if TYPE_CHECKING:
    import xarray as xr


_TIMED = 20_000
"""Samples over which a step is timed."""


class Score(NamedTuple):
    """One column: what is measured, in which touch, and its unit."""

    meaning: str
    touch: str
    unit: str
    of: Callable[[xr.Dataset], float]


SCORES: Mapping[str, Score] = {
    "static_stiffness": Score("stiffness felt at rest", "press", "N/m", static_stiffness),
    "rate_hardness": Score("rate-hardness in the first 10 ms", "press", "N/m", rate_hardness),
    "chatter": Score("force above 30 Hz in contact", "press", "N", chatter),
    "penetration": Score("deepest position", "press", "m", penetration),
    "settling_time": Score("time until at rest", "press", "s", settling_time),
    "rms_force": Score("RMS force in contact", "press", "N", rms_force),
    "peak_force": Score("largest force", "tap", "N", peak_force),
    "bounces": Score("times that contact is lost", "tap", "1", bounces),
    "tap_chatter": Score("force above 30 Hz after a tap", "tap", "N", chatter),
    "generated_energy": Score("energy given out", "tap", "J", generated_energy),
    "dowel_energy": Score("energy given out to a dowel", "dowel", "J", generated_energy),
    "free_damping": Score("damping felt in free air", "free air", "N*s/m", free_damping),
}
"""What is computed of each law, by variable."""


@overload
def compare(
    device: Device,
    environment: Wall | Any,
    laws: Mapping[str, Environment] | None = ...,
    *,
    fastest: RealLike = ...,
    handle_radius: RealLike | None = ...,
    progress: Callable[[int, int], None] | None = ...,
) -> LawComparison: ...
@overload
def compare(
    device: Mapping[str, Pair], *, progress: Callable[[int, int], None] | None = ...
) -> PairComparison: ...
def compare(
    device: Device | Mapping[str, Pair],
    environment: Wall | Any = None,
    laws: Mapping[str, Environment] | None = None,
    *,
    fastest: RealLike = FASTEST,
    handle_radius: RealLike | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> LawComparison | PairComparison:
    """Put laws on the bench: three touches, a stroke in free air, and a hand that tries to take energy out.

    Pairs of arms, by name, are compared by `compare_pairs`: ``compare({"positions": pair, …})``.

    Parameters
    ----------
    device
        With a mass, every number certain.
    environment
        The wall that is to be rendered.
    laws
        Environments by name, such as ``{"mine": zw.render(wall, MyLaw())}``; None: all of `standard_laws`.
    fastest
        Speed of the fastest hand that tries to take energy out [m/s].  What gains only beyond 1 m/s, about
        what a hand reaches, says so in the evidence.
    handle_radius
        Of a device that turns, how far from its axis it is touched, > 0 [m]; None of a handle.
    progress
        Told (laws done, laws in all).

    Raises
    ------
    InputError
        If the device has no mass, the environment is no wall with a stiffness, or the speed is not > 0; if a
        device that turns has no radius, or laws of one's own, whose numbers are not of its rim.
    """
    if isinstance(device, Mapping):
        if environment is not None or laws is not None:
            raise InputError("pairs are compared as they are: leave out the environment and the laws")
        return compare_pairs(device, progress=progress)
    wall = wall_to_render(as_environment(environment))
    if device.motion == "rotary":
        if laws is not None:
            raise InputError(
                "laws of your own have numbers about the axis, and the bench touches the rim: compare the "
                "standard ones, or give device, wall and laws at the handle: rotary(…, handle_radius=…)"
            )
        radius = radius_of(device, handle_radius)
        there = compare(*at_rim(device, wall, radius), fastest=fastest, progress=progress)
        return there.about_axis(device, wall, radius)
    if handle_radius is not None:
        raise InputError("handle_radius is of a device that turns, and this one is linear: leave it out")
    motor = device.motor_side
    if device.mass is None:
        raise InputError("the touches are simulated and need the device's mass [kg]")
    chosen = standard_laws(device, wall) if laws is None else dict(laws)
    if not chosen:
        raise InputError("laws is empty: there is nothing to compare")
    touches = standard_touches(motor, float(wall.stiffness))
    known = found_motions(motor, wall, fastest)
    traces: dict[str, dict[str, xr.Dataset]] = {}
    attacks: dict[str, Attack] = {}
    known_of: dict[str, Standing] = {}
    times: dict[str, float] = {}
    for done, (name, law) in enumerate(chosen.items()):
        if progress is not None:
            progress(done, len(chosen))
        traces[name] = {key: simulate(device, law, t.hand, t.duration) for key, t in touches.items()}
        attacks[name] = attack(device, law, fastest=fastest, known=known)
        known_of[name] = standing(device, law, attacks[name])
        times[name] = _step_time(motor, law, touches["press"])
    if progress is not None:
        progress(len(chosen), len(chosen))
    return LawComparison(
        scores=_dataset(traces, attacks, known_of, times, float(wall.stiffness)),
        attacks=attacks,
        standings=known_of,
        traces=traces,
        device=device,
        environment=wall,
    )


def _step_time(device: Device, law: Environment, touch: Touch) -> float:
    """Time that the simulator takes for a sample with this law [s]."""
    period = float(device.exact("sample_period"))
    setup = prepare(device, law, touch.hand, _TIMED * period)
    best = float("inf")
    for _ in range(2):
        commands, record, work = empty_record(setup.frame)
        start = time.perf_counter()
        run_setup(setup, setup.state.copy(), setup.memory.copy(), work, commands, record, None)
        best = min(best, time.perf_counter() - start)
    return best / _TIMED


def _dataset(
    traces: Mapping[str, Mapping[str, xr.Dataset]],
    attacks: Mapping[str, Attack],
    standings: Mapping[str, Standing],
    times: Mapping[str, float],
    wanted: float,
) -> xr.Dataset:
    import xarray as xr

    names = list(traces)
    data = xr.Dataset(coords={"law": names})
    for key, score in SCORES.items():
        values = [score.of(traces[name][score.touch]) for name in names]
        data[key] = ("law", np.array(values, dtype=float))
        data[key].attrs = {"units": score.unit, "long_name": score.meaning, "touch": score.touch}
    steps = [noticeable_differences(felt, wanted) for felt in data["static_stiffness"].values.tolist()]
    data["stiffness_jnds"] = ("law", steps)
    data["stiffness_jnds"].attrs = {
        "units": "1",
        "long_name": f"felt over wanted stiffness, in steps of {WEBER:.0%} ({SOURCE})",
        "touch": "press",
    }
    gains = [a.gain if a.extracts else min(a.gain, 0.0) for a in (attacks[name] for name in names)]
    data["gain"] = ("law", gains)
    data["gain"].attrs = {"units": "J", "long_name": "taken out by a round of the worst motion"}
    data["step_time"] = ("law", [times[name] for name in names])
    data["step_time"].attrs = {"units": "s", "long_name": "time of a simulated sample"}
    data["status"] = ("law", [standings[name].status for name in names])
    data["status"].attrs = {"long_name": "what is known for every hand"}
    return data


# The laws that are compared, each with defaults that follow from the device.


Law = Callable[[Device, Wall], Environment]

CUTOFF = 100.0
"""Of the velocity filter [Hz]."""

SLOW = 10
"""Samples between two updates of an environment that is computed slowly."""

FAST = 0.2
"""Speed of a hand whose leak a hysteresis is sized for [m/s]."""


def _damped(device: Device, wall: Wall, **how: object) -> Wall:
    """The wall with virtual damping K T/2: half a sample ahead."""
    period = device.exact("sample_period")
    return wall.replace(damping=wall.stiffness.fraction * period / 2, **how)


def _coupled(device: Device, wall: Wall) -> Environment:
    """Behind a coupling that the device renders passively, as stiff as 2b/T allows."""
    limit = 2 * device.exact("damping") / device.exact("sample_period")
    return VirtualCoupling(stiffness=limit, damping=0, environment=wall)


def _through(make: Callable[[Device, Wall], RenderingLaw]) -> Law:
    return lambda device, wall: render(wall, make(device, wall))


def _half_sample_damping(device: Device, wall: Wall) -> float:
    """K T/2."""
    return float(wall.stiffness) * float(device.exact("sample_period")) / 2


def _model() -> dict[str, Any]:
    """The finger of the bench, as laws are told that look ahead with a model."""
    finger = TypicalTouch()
    return {
        "finger_mass": finger.mass,
        "finger_stiffness": finger.stiffness,
        "finger_damping": finger.damping,
    }


LAWS: Mapping[str, Law] = {
    "wall": lambda device, wall: wall,
    "virtual-damping": _damped,
    "one-pole-damping": lambda d, w: _damped(d, w, velocity_filter=OnePole(1 / (2 * pi * CUTOFF))),
    "window-damping": lambda d, w: _damped(d, w, velocity_filter=Window(8)),
    "virtual-coupling": _coupled,
    "adaptive-window-damping": _through(lambda d, w: Damper(_half_sample_damping(d, w), AdaptiveWindow())),
    "tick-time-damping": _through(lambda d, w: Damper(_half_sample_damping(d, w), TickTime())),
    "kalman-damping": _through(lambda d, w: Damper(_half_sample_damping(d, w), Kalman())),
    "extrapolation": _through(lambda d, w: Extrapolation()),
    "half-sample-prediction": _through(lambda d, w: HalfSamplePrediction(**_model())),
    "crossing-correction": _through(lambda d, w: CrossingCorrection(**_model())),
    "pole-matched": _through(lambda d, w: PoleMatched(**_model())),
    "passivity-controller-published": _through(
        lambda d, w: PassivityController(observer="published", largest_damping="unlimited")
    ),
    "passivity-controller-unlimited": _through(lambda d, w: PassivityController(largest_damping="unlimited")),
    "passivity-controller": _through(lambda d, w: PassivityController()),
    "passivity-controller-past": _through(lambda d, w: PassivityController(observer="past")),
    "passivity-controller-limited": _through(lambda d, w: PassivityController(resets=True, ceiling=0)),
    "windowed-controller": _through(lambda d, w: WindowedController()),
    "rate-term": _through(lambda d, w: RateTerm()),
    "force-bounding": _through(lambda d, w: ForceBounding()),
    "force-bounding-ideal": _through(lambda d, w: ForceBounding(encoder="ideal")),
    "energy-bounding": _through(lambda d, w: EnergyBounding()),
    "energy-tank": _through(lambda d, w: EnergyTank()),
    "passive-leap": _through(lambda d, w: PassiveLeap()),
    "local-spring": _through(lambda d, w: DualRate(samples=SLOW)),
    "held": _through(lambda d, w: Held(samples=SLOW)),
    "hysteresis": _through(lambda d, w: Hysteresis(fastest=FAST)),
    "braking-pulse": _through(lambda d, w: BrakingPulse()),
    "event-transient": _through(lambda d, w: EventTransient()),
}
"""By name, in the order in which they are shown."""


def wall_to_render(environment: Environment) -> Wall:
    """What the laws of the bench render."""
    wall = wall_of(environment)
    if wall is None:
        raise InputError(f"the bench compares how a wall is rendered, got {environment.describe()}")
    return wall


def standard_laws(device: Device, wall: Environment) -> dict[str, Environment]:
    """Every law of the bench for a wall on a device; without those that need a number it does not have.

    With a transmission these are the laws that are computed from one mass, or one damping, of their own.

    Parameters
    ----------
    device
        Every number certain.
    wall
        What is to be rendered.

    Raises
    ------
    InputError
        If it is no wall, or a number is an interval.
    """
    motor, met = device.motor_side, wall_to_render(wall)
    if not met.is_certain or any(not isinstance(v, Exact) for v in (motor.damping, motor.sample_period)):
        raise InputError("the bench simulates one loop: give numbers, no intervals")
    made = {name: law(motor, met) for name, law in LAWS.items()}
    return {name: law for name, law in made.items() if _suits(law, device)}


def _suits(law: Environment, device: Device) -> bool:
    """Whether the device has all the numbers that a law is computed from."""
    try:
        for link in laws_of(law):
            link.numbers(LoopContext(device, law.met))
    except InputError:
        return False
    return True


# A device that turns, on the bench of a handle: its rim at a radius r, where a finger touches it.


def radius_of(device: Device, given: RealLike | None) -> Exact:
    """The radius at which a device that turns is touched [m]."""
    if given is None:
        raise InputError(
            f"the touches of the bench are a finger's, at a handle or rim, and {device.name} turns: say how "
            'far from the axis that is, --handle-radius "0.15 m" for a wheel, "2 cm" for a knob'
        )
    own = ROTARY["handle_radius"]
    radius: Exact = read_number(
        given, own, "handle_radius", bound="> 0", why="the handle turns about the axis", uncertain=False
    )
    return radius


def at_rim(device: Device, wall: Wall, radius: Exact) -> tuple[Device, Wall]:
    """The same device and wall, felt at the rim."""
    square = radius.fraction**2

    def over(value: object) -> Exact:
        if not isinstance(value, Exact):
            raise InputError("the bench simulates one loop: give numbers, no intervals")
        return Exact(Fraction(value.fraction / square))

    there = replace(wall, stiffness=over(wall.stiffness), damping=over(wall.damping))
    return at_handle(device, radius), there
