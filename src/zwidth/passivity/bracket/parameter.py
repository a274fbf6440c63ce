"""The numbers of a loop of which a limit can be sought, and how each is changed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields
from fractions import Fraction
from typing import NamedTuple

from zwidth.errors import InputError
from zwidth.model.device.device import Device
from zwidth.model.environment.environment import Environment
from zwidth.quantity.exact import Exact

Loop = tuple[Device, Environment]

MORE_IS_SAFER = frozenset({"damping", "coulomb_friction", "rate"})
"""Parameters of a device of which a loop needs enough; of all others it may have too much."""

_MORE_OF_A_LAW_IS_SAFER = frozenset({"virtual_mass"})
"""The same of an environment."""

_NO_PART = {
    "mass": "a hand without a limit on its force moves every mass as it likes",
    "stiction": "only sliding friction is counted",
    "friction_speed": "a claim names it, no bound contains it",
    "motor_inductance": "the actuator is taken to give every force at once",
    "supply_voltage": "the actuator is taken to give every force at once",
    "current_limit": "the actuator is taken to give every force at once",
}


def refuse_without_part(key: str, force_limit: bool, force_resolution: bool) -> None:
    """Refuse a parameter on which no outcome depends."""
    if key in _NO_PART:
        raise InputError(
            f"{key} plays no part, so it has no limit: {_NO_PART[key]}. Ask for damping, coulomb_friction, "
            "resolution, delay or rate of the device, or for a parameter of the environment"
        )
    counted = {"force_limit": force_limit, "force_resolution": force_resolution}
    if not counted.get(key, True):
        option = f"--count-{key.replace('_', '-')}"
        raise InputError(f"{key} plays no part unless it is counted in: give {key}=True, {option}")


class Parameter(NamedTuple):
    """One number of the loop: its unit, its value or a first guess, and the loop with another value."""

    name: str
    unit: str
    now: float
    change: Callable[[Exact], Loop]
    more_is_safer: bool = False


def parameter_of(device: Device, environment: Environment, name: str) -> Parameter:
    """The parameter that is asked for, one of a rendered environment included; the laws follow it."""
    owner, _, key = name.rpartition(".")
    met = environment.met
    in_environment = {f.name for f in fields(met)} - {"exponent"}  # it changes the unit of K
    in_device = {f.name for f in fields(device)} | {"rate"}
    if key == "gain" and met.scaled(Fraction(1)) is not None:
        return _gain(device, environment)
    if owner in ("", "environment") and key in in_environment:
        return _of_environment(device, environment, key)
    if owner in ("", "device") and key in in_device:
        return _of_device(device, environment, key)
    gain = "" if met.scaled(Fraction(1)) is None else ", and gain, a factor on its force"
    raise InputError(
        f"no parameter {name!r}: the environment has {', '.join(sorted(in_environment))}{gain}; the device "
        f"has {', '.join(sorted(in_device))}"
    )


def _gain(device: Device, environment: Environment) -> Parameter:
    """A factor on the force of the environment."""

    def change(value: Exact) -> Loop:
        scaled = environment.met.scaled(value.fraction)
        assert scaled is not None
        return device, environment.around(scaled)

    return Parameter("environment.gain", "1", 1.0, change)


def _of_environment(device: Device, environment: Environment, key: str) -> Parameter:
    met = environment.met
    now = getattr(met, key)
    if not isinstance(now, float):
        raise InputError(f"{key} is not one number: give an environment with a certain value of it")

    def change(value: Exact) -> Loop:
        return device, environment.around(met.replace(**{key: value}))

    unit = met.unit_of(key, device.motion)
    first = abs(float(now)) or _guess(device, key)
    return _parameter(f"environment.{key}", unit, first, change)


def _of_device(device: Device, environment: Environment, key: str) -> Parameter:
    known = 1 / device.exact("sample_period") if key == "rate" else device.exact(key)

    def change(value: Exact) -> Loop:
        return device.replace(**{key: value}), environment

    now = float(known) or _guess(device, key)
    return _parameter(f"device.{key}", device.unit(key), now, change)


def _parameter(name: str, unit: str, now: float, change: Callable[[Exact], Loop]) -> Parameter:
    return Parameter(name, unit, now, change, more_is_safer(name))


def more_is_safer(name: str) -> bool:
    """Whether a loop needs enough of a parameter, and does not have too much of it."""
    owner, _, key = name.partition(".")
    return key in (MORE_IS_SAFER if owner == "device" else _MORE_OF_A_LAW_IS_SAFER)


def _guess(device: Device, key: str) -> float:
    """A first value of a parameter that is 0, from the device's other numbers."""
    b, f = device.exact("damping"), device.exact("coulomb_friction")
    t, step = device.exact("sample_period"), device.exact("resolution")
    sizes = {"stiffness": 2 * b / t, "damping": b, "coulomb_friction": f}
    fallback = {"stiffness": 2 * f / step if step else Fraction(1), "delay": t}
    return float(sizes.get(key, Fraction(0)) or fallback.get(key, Fraction(1)) or Fraction(1))
