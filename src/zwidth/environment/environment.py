"""The environment: what the hand meets.

Every linear environment is, in contact, a pulse transfer function H(z) from the
sampled position to the force, exact in its parameters.  That is all that the
criteria need; what happens at the surface is said by `unilateral`, and whether
the law may pull by `clamped`.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, fields, replace
from fractions import Fraction
from typing import Any, NamedTuple, Self

from zwidth.errors import InputError
from zwidth.quantity.exact import Exact, Interval
from zwidth.quantity.parameter import Parametric, flag


class RationalFunction(NamedTuple):
    """H(z) = numerator/denominator, exact, in descending powers of z."""

    numerator: tuple[Fraction, ...]
    denominator: tuple[Fraction, ...]


@dataclass(frozen=True, kw_only=True)
class Environment(Parametric, ABC):
    """What renders a force from sampled positions.

    A subclass is a frozen data class whose fields are made by `parameter`, `flag`
    or `part` of `zwidth.quantity.parameter`, and implements `pulse_transfer_function` and `describe`.
    """

    @property
    def unilateral(self) -> bool:
        """True when the law acts only for x > 0, as a wall does."""
        return False

    @property
    def clamped(self) -> bool:
        """True when the law never pulls: a force below 0 is given as 0."""
        return False

    @property
    def linear(self) -> bool:
        """True when H(z) says all about the law in contact."""
        return not self.clamped

    @property
    def has_transfer_function(self) -> bool:
        """True when there is an H(z) for contact that is kept."""
        return True

    @property
    def spring(self) -> bool:
        """True when the law is a memoryless spring, f = K x."""
        return False

    @abstractmethod
    def pulse_transfer_function(self, sample_period: Fraction) -> RationalFunction:
        """H(z) in sustained contact for the sample period T [s].

        Raises
        ------
        InputError
            If the law has no H(z) at this period or at any, or a parameter is an interval.
        """

    def replace(self, **changes: Any) -> Self:
        """The same environment with some parameters changed."""
        return replace(self, **changes)

    @property
    def is_certain(self) -> bool:
        """True when no parameter, here or in a part, is an interval."""
        return not any(_uncertain(getattr(self, f.name)) for f in fields(self))

    @property
    def coefficients_rounded(self) -> bool:
        """True when H(z) holds doubles nearest to numbers that no decimal can write."""
        return False

    @abstractmethod
    def describe(self, motion: str = "linear") -> str:
        """The law with its numbers, on one line, in linear or rotary units."""


def _uncertain(value: object) -> bool:
    if isinstance(value, Interval):
        return True
    if isinstance(value, tuple):
        return any(_uncertain(v) for v in value)
    return isinstance(value, Environment) and not value.is_certain


def clamping(default: bool = False) -> Any:
    """The field `clamped` of a law that may be told never to pull."""
    more = ", f = max(0, …); by default only of a Hunt–Crossley contact"
    return flag("for a law that never pulls", default, more=more)


def certain(value: Exact | Interval, key: str) -> Fraction:
    """The exact value of a parameter that H(z) is computed from.

    Raises
    ------
    InputError
        If it is an interval: H(z) is a function of one value.
    """
    if isinstance(value, Interval):
        raise InputError(f"{key} is the interval {value}; H(z) needs one value of it")
    return value.fraction


def multiply(a: tuple[Fraction, ...], b: tuple[Fraction, ...]) -> tuple[Fraction, ...]:
    """The product of two polynomials, descending powers."""
    product = [Fraction(0)] * (len(a) + len(b) - 1)
    for i, x in enumerate(a):
        for j, y in enumerate(b):
            product[i + j] += x * y
    return tuple(product)


def add(a: tuple[Fraction, ...], b: tuple[Fraction, ...]) -> tuple[Fraction, ...]:
    """The sum of two polynomials, descending powers."""
    length = max(len(a), len(b))
    x = (Fraction(0),) * (length - len(a)) + a
    y = (Fraction(0),) * (length - len(b)) + b
    return tuple(p + q for p, q in zip(x, y, strict=True))
