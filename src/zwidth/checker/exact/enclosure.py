"""Ranges of whole numbers of 2⁻⁸⁰, rounded outward, and functions with their slopes.

    a · b ⊆ [min, max] of the four products,    [x] ⊆ √[x²],    1/[x] where 0 is outside
    sin(m + t) ∈ sin m + t cos m ± t²/2,        the series of sin m and cos m with what it leaves out

A `Jet` is a function of some coordinates over a cell: what it can be there, and what its
derivative by each coordinate can be.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from math import ceil, floor, isqrt

from ..document.reading import Invalid

BITS = 80
ONE = 1 << BITS
LARGEST = 1 << 64
LARGEST_ANGLE = 64 * ONE
TERMS = 400

Range = tuple[int, int]
ZERO: Range = (0, 0)


def enclosed(x: Fraction) -> Range:
    if abs(x) > LARGEST:
        raise Invalid("a number is too large")
    return floor(x * ONE), ceil(x * ONE)


def plus(a: Range, b: Range) -> Range:
    return a[0] + b[0], a[1] + b[1]


def minus(a: Range, b: Range) -> Range:
    return a[0] - b[1], a[1] - b[0]


def times(a: Range, b: Range) -> Range:
    if a[0] == a[1]:
        p, q = a[0] * b[0], a[0] * b[1]
        low, high = (p, q) if p <= q else (q, p)
    else:
        products = a[0] * b[0], a[0] * b[1], a[1] * b[0], a[1] * b[1]
        low, high = min(products), max(products)
    return low >> BITS, -(-high >> BITS)


def square(a: Range) -> Range:
    low, high = sorted((abs(a[0]), abs(a[1])))
    return 0 if a[0] <= 0 <= a[1] else low * low >> BITS, -(-high * high >> BITS)


def inverse(a: Range) -> Range:
    if a[0] <= 0:
        raise NotPositive
    return ONE * ONE // a[1], -(-ONE * ONE // a[0])


def root(a: Range) -> Range:
    if a[0] <= 0:
        raise NotPositive
    return isqrt(a[0] << BITS), isqrt(a[1] << BITS) + 1


class NotPositive(Exception):
    """A root or an inverse of what may be 0 or less."""


def sine_cosine(angle: Range) -> tuple[Range, Range]:
    """What sin and cos can be over a range of angles [rad]."""
    if max(-angle[0], angle[1]) > LARGEST_ANGLE:
        raise Invalid("an angle is too many turns from 0")
    middle = (angle[0] + angle[1]) // 2
    half = max(angle[1] - middle, middle - angle[0])
    sine, cosine = _series(middle)
    bend = -(-half * half >> (BITS + 1))

    def spread(at: Range, slope: Range) -> Range:
        away = (-(-half * max(-slope[0], slope[1]) >> BITS)) + bend
        return max(at[0] - away, -ONE), min(at[1] + away, ONE)

    return spread(sine, cosine), spread(cosine, sine)


def _series(x: int) -> tuple[Range, Range]:
    """sin x and cos x: once a term is below the last digit and falls by half, the rest is below it too."""
    minus_square = times((-x, -x), (x, x))
    sums = []
    for term, first in (((x, x), 1), ((ONE, ONE), 0)):
        total, n = term, first
        while max(-term[0], term[1]) > 4 or n * n < 2 * abs(minus_square[0]) >> BITS:
            product = times(term, minus_square)
            divisor = (n + 1) * (n + 2)
            term = product[0] // divisor, -(-product[1] // divisor)
            total, n = plus(total, term), n + 2
            if n > TERMS:
                raise Invalid("an angle is too many turns from 0")
        sums.append((total[0] - 8, total[1] + 8))
    return sums[0], sums[1]


class Jet:
    """A value and its slopes by the coordinates it depends on."""

    __slots__ = ("slopes", "value")

    def __init__(self, value: Range, slopes: Mapping[int, Range] | None = None) -> None:
        self.value = value
        self.slopes: Mapping[int, Range] = slopes or {}

    def __add__(self, other: Jet) -> Jet:
        if self.is_zero:
            return other
        if other.is_zero:
            return self
        slopes = dict(self.slopes)
        for j, slope in other.slopes.items():
            slopes[j] = plus(slopes[j], slope) if j in slopes else slope
        return Jet(plus(self.value, other.value), slopes)

    def __neg__(self) -> Jet:
        return Jet(_negated(self.value), {j: _negated(s) for j, s in self.slopes.items()})

    def __sub__(self, other: Jet) -> Jet:
        return self if other.is_zero else self + -other

    def __mul__(self, other: Jet) -> Jet:
        if self.is_zero or other.is_zero:
            return NOTHING
        slopes = {j: times(s, other.value) for j, s in self.slopes.items()}
        for j, slope in other.slopes.items():
            part = times(self.value, slope)
            slopes[j] = plus(slopes[j], part) if j in slopes else part
        return Jet(times(self.value, other.value), slopes)

    def scaled(self, factor: Range) -> Jet:
        if factor == (ONE, ONE):
            return self
        if factor == ZERO or self.is_zero:
            return NOTHING
        return Jet(times(factor, self.value), {j: times(factor, s) for j, s in self.slopes.items()})

    def squared(self) -> Jet:
        return self._through(square(self.value), plus(self.value, self.value))

    def root(self) -> Jet:
        value = root(self.value)
        return self._through(value, inverse(plus(value, value)))

    def inverse(self) -> Jet:
        value = inverse(self.value)
        return self._through(value, _negated(square(value)))

    @property
    def is_zero(self) -> bool:
        return self.value == ZERO and not self.slopes

    def _through(self, value: Range, rate: Range) -> Jet:
        return Jet(value, {j: times(rate, slope) for j, slope in self.slopes.items()})


NOTHING = Jet(ZERO)


def total(jets: Sequence[Jet]) -> Jet:
    found = NOTHING
    for jet in jets:
        found = found + jet
    return found


def _negated(a: Range) -> Range:
    return -a[1], -a[0]
