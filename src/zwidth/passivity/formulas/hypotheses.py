"""The bounds under which a formula holds, checked on exact numbers."""

from __future__ import annotations

from fractions import Fraction

from zwidth.errors import InputError
from zwidth.quantity.exact import Exact, RealLike

NEGATIVE_SPRING = "a negative spring gives out energy without end"
NO_CLOCK = "a sampled loop has a sample period"


def number(name: str, value: RealLike) -> Fraction:
    """The exact value; a message names the argument."""
    try:
        return Exact(value).fraction
    except InputError as error:
        raise InputError(f"{name}: {error}") from None


def nonnegative(name: str, value: RealLike, why: str) -> Fraction:
    """The exact value of an argument ≥ 0; `why` says what the bound is for."""
    exact = number(name, value)
    if exact < 0:
        raise InputError(f"{name} must be ≥ 0, got {value}: {why}")
    return exact


def positive(name: str, value: RealLike, why: str) -> Fraction:
    """The exact value of an argument > 0; `why` says what the bound is for."""
    exact = number(name, value)
    if exact <= 0:
        raise InputError(f"{name} must be > 0, got {value}: {why}")
    return exact
