"""What a law takes from the device where it was not told."""

from __future__ import annotations

from zwidth.errors import InputError
from zwidth.model.rendering.rendering_law import LoopContext
from zwidth.quantity.exact import Exact, Interval


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
