"""How the arguments of a law are read, and what the device pays a law with."""

from __future__ import annotations

from fractions import Fraction
from math import inf, nextafter
from typing import TypeVar

from zwidth.errors import InputError
from zwidth.quantity.exact import Exact, RealLike
from zwidth.rendering.stage import Surroundings

T = TypeVar("T")


def one_of(name: str, value: T, *words: T) -> T:
    """The value, if it is one of these words.

    Raises
    ------
    InputError
        If it is none of them.
    """
    if value not in words:
        raise InputError(f"{name} is one of {', '.join(map(repr, words))}, got {value!r}")
    return value


def truth(name: str, value: object, meaning: str) -> bool:
    """True or False.

    Raises
    ------
    InputError
        If it is neither.
    """
    if not isinstance(value, bool):
        raise InputError(f"{name} is True {meaning}, or False; got {value!r}")
    return value


def count(name: str, value: RealLike, why: str) -> int:
    """A whole number of samples, at least 1.

    Raises
    ------
    InputError
        If it is not.
    """
    whole = isinstance(value, int | Exact) and not isinstance(value, bool) and value == int(value)
    if not whole or value < 1:  # type: ignore[operator]
        raise InputError(f"{name} is a whole number of samples, at least 1, got {value}: {why}")
    return int(value)


def damping_per_sample(at: Surroundings, law: str) -> float:
    """b/T, rounded down: what the device takes per squared move of one sample, at least [N/m; N·m/rad].

    Raises
    ------
    InputError
        If the device has no damping.
    """
    damping = at.device.exact("damping")
    if damping <= 0:
        raise InputError(
            f"{law} pays for the force with the device's damping, and {at.device.name} has none: "
            "give the damping that was measured, or another law"
        )
    return below(damping / at.device.exact("sample_period"))


def half_step(at: Surroundings) -> float:
    """What the device's converter can add to a force at most, ΔF/2; 0 where its step is unknown [N; N·m]."""
    step = at.device.force_resolution
    return 0.0 if step is None else above(at.device.exact("force_resolution")) / 2


def below(value: Fraction) -> float:
    """The largest double that is no more than a rational."""
    nearest = float(value)
    return nearest if nearest <= value else nextafter(nearest, -inf)


def above(value: Fraction) -> float:
    """The smallest double that is no less than a rational."""
    return -below(-value)
