"""A number means the decimal that a person typed.

0.15 is 3/20, although the nearest binary float is a little less.  `Exact` is a
float to every user of it and carries that rational beside it, so that a limit such as K = 2b/T is met exactly
and nothing is decided by rounding.  `Interval` is a parameter known only between two such numbers.
"""

from __future__ import annotations

from dataclasses import dataclass
from decimal import Decimal, InvalidOperation
from fractions import Fraction
from numbers import Rational, Real
from typing import Any

from zwidth.errors import InputError

LARGEST_EXPONENT = 40
"""Magnitudes outside 1e-40 … 1e40 are refused: no haptic quantity has them."""

_LARGEST = 10**LARGEST_EXPONENT

RealLike = float | int | str | Fraction | Decimal
"""What a person may type for a number."""


class Exact(float):
    """A float that remembers the rational it stands for.

    Parameters
    ----------
    value
        An int, Fraction, Decimal, decimal text, or a float, which means its
        shortest decimal: `Exact(0.15).fraction == Fraction(3, 20)`.

    Raises
    ------
    InputError
        If the value is not a finite number of magnitude 1e-40 … 1e40 (or zero).
    """

    __slots__ = ("fraction",)
    fraction: Fraction

    def __new__(cls, value: RealLike) -> Exact:
        if isinstance(value, Exact):
            return value
        fraction = _fraction(value)
        self = super().__new__(cls, fraction)
        self.fraction = fraction
        return self

    def __reduce__(self) -> tuple[Any, ...]:
        return (Exact, (self.fraction,))

    def __copy__(self) -> Exact:
        return self

    def __deepcopy__(self, memo: object) -> Exact:
        return self


def _fraction(value: RealLike) -> Fraction:
    if isinstance(value, bool):
        raise InputError(f"expected a number, got {value!r}; give the value itself, such as 0.15")
    try:
        if type(value) is Fraction:
            fraction = value
        elif isinstance(value, Rational):
            fraction = Fraction(int(value.numerator), int(value.denominator))
        else:
            if isinstance(value, str):
                decimal = Decimal(value)
            elif isinstance(value, Decimal):
                decimal = value
            elif isinstance(value, Real):
                decimal = Decimal(float.__repr__(float(value)))
            else:
                raise InputError(f"expected a number, got {value!r} of type {type(value).__name__}")
            if not decimal.is_finite():
                raise InputError(f"expected a finite number, got {value}")
            if decimal and abs(decimal.adjusted()) > LARGEST_EXPONENT:
                raise InputError(_magnitude(value))
            fraction = Fraction(decimal)
    except InvalidOperation:
        raise InputError(f"expected a number, got {value!r}") from None
    # 0 or a magnitude of 1e-40 … 1e40, without a division: many numbers are read
    top, bottom = abs(fraction.numerator), fraction.denominator
    if top and not (top <= bottom * _LARGEST and bottom <= top * _LARGEST):
        raise InputError(_magnitude(value))
    return fraction


def _magnitude(value: object) -> str:
    text = "a number" if isinstance(value, (int, Fraction)) else str(value)
    shown = text if len(text) <= 40 else text[:37] + "..."
    return (
        f"{shown} is outside the magnitudes 1e-{LARGEST_EXPONENT} to 1e{LARGEST_EXPONENT}; "
        "no haptic quantity in SI units lies there: check the unit"
    )


@dataclass(frozen=True, init=False)
class Interval:
    """A parameter known to lie between two numbers, ends included.

    Parameters
    ----------
    low, high
        The ends, in the unit of the parameter; low ≤ high.

    Raises
    ------
    InputError
        If an end is not a number, or the ends are in the wrong order.
    """

    low: Exact
    high: Exact

    def __init__(self, low: RealLike, high: RealLike) -> None:
        object.__setattr__(self, "low", Exact(low))
        object.__setattr__(self, "high", Exact(high))
        if self.low.fraction > self.high.fraction:
            raise InputError(
                f"an interval runs from its smaller to its larger end, got {low} … {high}; swap the ends"
            )

    def __str__(self) -> str:
        return f"{float(self.low):g} … {float(self.high):g}"


def as_parameter(value: RealLike | Interval | tuple[RealLike, RealLike]) -> Exact | Interval:
    """Read a number, or a pair of ends, as an exact parameter."""
    if isinstance(value, Interval):
        return value
    if isinstance(value, (tuple, list)):
        if len(value) != 2:
            raise InputError(f"an interval has two ends, got {len(value)} values")
        return Interval(value[0], value[1])
    return Exact(value)


def times(value: Exact | Interval, factor: Fraction) -> Exact | Interval:
    """A parameter times a factor > 0, exactly; of an interval both ends."""
    low, high = (end * factor for end in ends(value))
    return Interval(Exact(low), Exact(high)) if isinstance(value, Interval) else Exact(low)


def ends(value: Exact | Interval) -> tuple[Fraction, Fraction]:
    """The smallest and the largest value a parameter may have, exactly."""
    if isinstance(value, Interval):
        return value.low.fraction, value.high.fraction
    return value.fraction, value.fraction


def middle(value: Exact | Interval | None) -> float | None:
    """Of the ends, rounded; None of what is unknown."""
    return None if value is None else float(sum(ends(value))) / 2
