"""A linear system G of one axis or several, and the port F = N D⁻¹ that an index is of.

For the input index F is G, with D = d, the denominator, on every axis; for the output index F is its inverse.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import NamedTuple

from ..document.fields import Choice, List, Number, Read, Record, numbers
from ..document.number import common_scale
from ..document.refusal import Invalid

MOST_AXES = 12
MOST_ORDER = 400
"""Of one axis, twice that of several."""

_TIME = Choice("continuous", "discrete")
CLAIM = {"index": Choice("input", "output"), "level": Number()}
SYSTEM = Record({"time": _TIME, "numerator": numbers(least=1), "denominator": numbers(least=1)})
"""G in descending powers of s or z."""
ROWS = List(List(numbers(), least=1, most=MOST_AXES), least=1, most=MOST_AXES)
MATRIX_SYSTEM = Record({"time": _TIME, "numerators": ROWS, "denominator": numbers(least=1)})
"""G = N/d, its rows; every polynomial in descending powers of s or z."""

Polynomial = list[Fraction]


class Port(NamedTuple):
    outputs: list[list[Polynomial]]  # N, ascending in s or z
    inputs: list[list[Polynomial]]  # D
    denominator: Polynomial
    continuous: bool
    level: Fraction
    order: int
    axes: int


def port_of(told: Read) -> Port:
    """D = d and N = G d for the input index; exchanged for the output index."""
    system = told.system
    d = trimmed(system.denominator)
    n = square(system.numerators if hasattr(system, "numerators") else [[system.numerator]])
    if not d:
        raise Invalid("the denominator is zero")
    longest = max(len(p) for row in n for p in row)
    if system.time == "discrete" and longest > len(d):
        raise Invalid("G(z) has more zeros than poles")
    if told.index == "output" and n == [[[]]]:
        raise Invalid("G is zero and has no inverse")
    order, most = max(longest, len(d)) - 1, MOST_ORDER if len(n) == 1 else MOST_ORDER // 2
    if order > most:
        raise Invalid(f"the order is {order}, more than {most}")
    common_scale((*d, *(c for row in n for p in row for c in p)))
    diagonal: list[list[Polynomial]] = [[d if i == j else [] for j in range(len(n))] for i in range(len(n))]
    sides = (n, diagonal) if told.index == "input" else (diagonal, n)
    return Port(*sides, d, system.time == "continuous", told.level, order, len(n))


def square(rows: Sequence[Sequence[Polynomial]]) -> list[list[Polynomial]]:
    """A square matrix of polynomials, in ascending powers."""
    if any(len(row) != len(rows) for row in rows):
        raise Invalid("a matrix must have as many columns as rows")
    return [[trimmed(entry) for entry in row] for row in rows]


def trimmed(descending: Polynomial) -> Polynomial:
    """In ascending powers, without zeros in front."""
    start = next((i for i, c in enumerate(descending) if c), len(descending))
    return descending[start:][::-1]


def part_of(ascending: Sequence[Fraction], parity: int) -> Polynomial:
    """The even or odd part at s = jω, over (jω)^parity, in x = ω²."""
    return [c if i % 2 == 0 else -c for i, c in enumerate(ascending[parity::2])] or [Fraction(0)]
