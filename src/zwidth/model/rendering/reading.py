"""How the arguments of a law are read, and what the device pays a law with."""

from __future__ import annotations

from fractions import Fraction
from math import inf, nextafter
from typing import Any

import numpy as np

from zwidth.errors import InputError
from zwidth.model.rendering.rendering_law import LoopContext
from zwidth.quantity.exact import Exact, Interval, RealLike
from zwidth.quantity.parameter import PLAIN, part


def count(name: str, value: RealLike, why: str) -> int:
    """A whole number of samples, at least 1."""
    whole = isinstance(value, int | Exact) and not isinstance(value, bool) and value == int(value)
    if not whole or value < 1:  # type: ignore[operator]
        raise InputError(f"{name} is a whole number of samples, at least 1, got {value}: {why}")
    return int(value)


def updated_every() -> Any:
    """The field `samples` of a law that updates the environment every N samples."""
    return part(
        "quantity",
        lambda given, name: count(name, given, "the environment is updated every N"),
        meaning="N, samples between two updates",
        quantity=PLAIN,
    )


def damping_per_sample(at: LoopContext, law: str) -> float:
    """b/T, rounded down: what the device takes per squared move of one sample, at least [N/m; N·m/rad]."""
    damping = at.device.exact("damping")
    if damping <= 0:
        raise InputError(
            f"{law} pays for the force with the device's damping, and {at.device.name} has none: "
            "give the damping that was measured, or another law"
        )
    return below(damping / at.device.exact("sample_period"), at.single)


def half_step(at: LoopContext) -> float:
    """What the device's converter can add to a force at most, ΔF/2; 0 where its step is unknown [N; N·m]."""
    step = at.device.force_resolution
    return 0.0 if step is None else above(at.device.exact("force_resolution"), at.single) / 2


def below(value: Fraction, single: bool = False) -> float:
    """The largest double, or float of 24 bits, that is no more than a rational."""
    if single:
        short = np.float32(float(value))
        return float(short if Fraction(float(short)) <= value else np.nextafter(short, np.float32(-inf)))
    nearest = float(value)
    return nearest if nearest <= value else nextafter(nearest, -inf)


def above(value: Fraction, single: bool = False) -> float:
    """The smallest double, or float of 24 bits, that is no less than a rational."""
    return -below(-value, single)


def given_or_known(given: Exact | None, at: LoopContext, key: str, parameter: str) -> float:
    """A parameter of a law, or the device's `key` in its place."""
    if given is not None:
        return float(given)
    return known(at, key, f"{parameter} was not given and is otherwise the device's {key}")


def known(at: LoopContext, key: str, why: str) -> float:
    """A number of the device."""
    value = getattr(at.device, key)
    if value is None:
        raise InputError(f"{why}, which {at.device.name} does not have: give one of the two")
    if isinstance(value, Interval):
        raise InputError(f"{why}, which is not certain ({value}): give one of the two")
    return float(value)


def stiffness(at: LoopContext, why: str) -> float:
    """K of the environment [N/m; N·m/rad]."""
    met = at.environment
    bent = met.power_law is not None and met.power_law.exponent != 1
    if bent or at.stiffness <= 0:
        raise InputError(f"{why}, and this environment has no K [N/m; N·m/rad]: {met.describe()}")
    return at.stiffness


def surface(at: LoopContext, law: str) -> None:
    """Nothing, where the environment can be entered."""
    if not at.environment.unilateral:
        raise InputError(
            f"{law} acts when the hand enters, and this environment has no surface: "
            f"{at.environment.describe()}"
        )
