"""The laws that are compared, each with defaults that follow from the device."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from fractions import Fraction
from math import pi
from typing import TYPE_CHECKING, Any

from zwidth.errors import InputError
from zwidth.model.device.device import Device
from zwidth.model.device.rotary import ROTARY, at_handle
from zwidth.model.environment.environment import Environment
from zwidth.model.environment.velocity import OnePole, Window
from zwidth.model.environment.wall import Wall, wall_of
from zwidth.model.operator import TypicalTouch
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

if TYPE_CHECKING:
    import xarray as xr


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
    return wall.replace(damping=wall.stiffness.fraction * period / 2, **how)  # type: ignore[union-attr]


def _coupled(device: Device, wall: Wall) -> Environment:
    """Behind a coupling that the device renders passively, as stiff as 2b/T allows."""
    limit = 2 * device.exact("damping") / device.exact("sample_period")
    return VirtualCoupling(stiffness=limit, damping=0, environment=wall)


def _through(make: Callable[[Device, Wall], RenderingLaw]) -> Law:
    return lambda device, wall: render(wall, make(device, wall))


def _half_sample_damping(device: Device, wall: Wall) -> float:
    """K T/2."""
    return float(wall.stiffness) * float(device.exact("sample_period")) / 2  # type: ignore[arg-type]


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
    met = wall_to_render(wall)
    if not met.is_certain or any(not isinstance(v, Exact) for v in (device.damping, device.sample_period)):
        raise InputError("the bench simulates one loop: give numbers, no intervals")
    made = {name: law(device, met) for name, law in LAWS.items()}
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


_TURNED = {"N/m": ("N*m/rad", 2), "N": ("N*m", 1), "m": ("rad", -1), "N*s/m": ("N*m*s/rad", 2)}
"""What a unit at the rim is about the axis, and the power of the radius that takes a value there."""


def radius_of(device: Device, given: RealLike | None) -> Exact:
    """The radius at which a device that turns is touched [m]."""
    if given is None:
        raise InputError(
            f"the touches of the bench are a finger's, at a handle or rim, and {device.name} turns: say how "
            "far from the axis that is, --handle-radius '0.15 m' for a wheel, '2 cm' for a knob"
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


def about_axis(scores: xr.Dataset, radius: float) -> xr.Dataset:
    """What was found at the rim, `radius` [m] from the axis, in torques and angles."""
    turned = scores.copy()
    for name, value in scores.data_vars.items():
        unit, power = _TURNED.get(value.attrs.get("units", ""), ("", 0))
        if unit:
            turned[name] = (value.dims, radius**power * value.values, {**value.attrs, "units": unit})
    return turned
