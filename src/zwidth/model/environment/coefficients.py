"""The coefficients of a transfer function, read and checked."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from fractions import Fraction
from math import floor, log10
from typing import Any

from zwidth.errors import InputError
from zwidth.model.environment.discretization import LARGEST_ORDER
from zwidth.model.environment.system import LinearSystem, is_system, read_system
from zwidth.quantity.exact import Exact, RealLike

Coefficients = tuple[Exact, ...]
"""Descending powers; the first is not zero unless it is the only one."""

Polynomial = tuple[Fraction, ...]

_DECADES = 76
"""Room for every coefficient between the smallest and the largest magnitude of `Exact`."""


def read_transfer_function(
    numerator: object, denominator: Sequence[RealLike] | None
) -> tuple[Coefficients, Coefficients, LinearSystem | None]:
    """Numerator and denominator as a person gives them: two sequences, or a system, read already or not.

    Leading zeros are dropped and nothing else is: common factors stay.
    """
    if isinstance(numerator, LinearSystem):
        return (*_checked(*_in_range(numerator.numerator, numerator.denominator)), numerator)
    if not is_system(numerator):
        if denominator is None:
            raise InputError("a transfer function needs a numerator and a denominator, or a system")
        num, den = _coefficients(numerator, "numerator"), _coefficients(denominator, "denominator")
        return (*_checked(num, den), None)
    if denominator is not None:
        raise InputError("give either a system or a numerator and a denominator, got both")
    system = read_system(numerator)
    return (*_checked(*_in_range(system.numerator, system.denominator)), system)


def _coefficients(given: object, key: str) -> Coefficients:
    if isinstance(given, str) or not isinstance(given, Iterable):
        raise InputError(f"{key} is a list of coefficients in descending powers, got {given!r}")
    return tuple(read_coefficient(c, f"{key}[{i}]") for i, c in enumerate(given))


def read_coefficient(value: Any, key: str) -> Exact:
    """One exact number; `key` names it in a message."""
    try:
        return Exact(value)
    except InputError as error:
        raise InputError(f"{key}: {error}") from None


def _checked(numerator: Coefficients, denominator: Coefficients) -> tuple[Coefficients, Coefficients]:
    num, den = _without_leading_zeros(numerator), _without_leading_zeros(denominator)
    if not any(den):
        raise InputError("the denominator of a transfer function is zero")
    if not num:
        raise InputError("the numerator of a transfer function has no coefficient; for no force give [0]")
    order = max(len(num), len(den)) - 1
    if order > LARGEST_ORDER:
        raise InputError(f"the transfer function has order {order}; at most {LARGEST_ORDER} is read")
    return num, den


def _without_leading_zeros(coefficients: Coefficients) -> Coefficients:
    start = next((i for i, c in enumerate(coefficients) if c.fraction), len(coefficients) - 1)
    return coefficients[max(start, 0) :]


def _in_range(numerator: Polynomial, denominator: Polynomial) -> tuple[Coefficients, Coefficients]:
    """Both polynomials times one power of ten, where they need it to be within range."""
    sizes = [_decade(c) for c in (*numerator, *denominator) if c]
    if sizes and max(sizes) - min(sizes) > _DECADES:
        raise InputError(
            f"the coefficients of the transfer function lie {max(sizes) - min(sizes)} decades apart, "
            f"more than the {_DECADES} that are read; reduce its order, or its fastest modes"
        )
    if sizes and (min(sizes) < -39 or max(sizes) > 39):
        shift = Fraction(10) ** (-(min(sizes) + max(sizes)) // 2)
        numerator, denominator = (tuple(c * shift for c in part) for part in (numerator, denominator))
    num, den = (
        tuple(read_coefficient(c, key) for c in part)
        for part, key in ((numerator, "numerator"), (denominator, "denominator"))
    )
    return num, den


def _decade(value: Fraction) -> int:
    return floor((abs(value.numerator).bit_length() - value.denominator.bit_length()) * log10(2))
