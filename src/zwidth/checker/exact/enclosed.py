"""Numbers known within bounds: in fixed point, to first order in what varies, the rest as a radius.

    x = (m + Σ sᵢ εᵢ + r ε) / 2^bits,    every |εᵢ|, |ε| ≤ 1,  the εᵢ shared by all numbers

What depends on the same εᵢ cancels where it is subtracted: a difference is known as well as its terms.  Every
rounding is added to r.  A 0 stays exact.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from fractions import Fraction
from math import isqrt

from ..document.refusal import Invalid, spend

Slopes = tuple[int, ...]
_PRODUCT = 5.0
"""What a product of two such numbers costs, with the sums that go with it, and again for each slope [µs]."""


class Enclosed:
    """One such number; all that meet have the same `bits` and as many slopes, or none."""

    __slots__ = ("bits", "middle", "radius", "slopes")

    def __init__(self, bits: int, middle: int, slopes: Slopes = (), radius: int = 0) -> None:
        self.bits, self.middle, self.slopes, self.radius = bits, middle, slopes, radius

    def __add__(self, other: Enclosed) -> Enclosed:
        slopes = _merged(self.slopes, other.slopes, 1)
        return Enclosed(self.bits, self.middle + other.middle, slopes, self.radius + other.radius)

    def __sub__(self, other: Enclosed) -> Enclosed:
        slopes = _merged(self.slopes, other.slopes, -1)
        return Enclosed(self.bits, self.middle - other.middle, slopes, self.radius + other.radius)

    def __mul__(self, other: Enclosed) -> Enclosed:
        a, b, bits = self.middle, other.middle, self.bits
        own, strange = self.reach, other.reach
        rest = abs(a) * other.radius + abs(b) * self.radius + own * strange
        if self.slopes and other.slopes:
            slopes = [b * s + a * t for s, t in zip(self.slopes, other.slopes, strict=True)]
        else:
            slopes = [b * s for s in self.slopes] or [a * t for t in other.slopes]
        return _rounded(bits, a * b, slopes, rest, bits)

    def __neg__(self) -> Enclosed:
        return self.times(-1)

    def times(self, whole: int) -> Enclosed:
        """Times a whole number, exactly."""
        slopes = tuple(whole * s for s in self.slopes)
        return Enclosed(self.bits, whole * self.middle, slopes, abs(whole) * self.radius)

    def over(self, whole: int) -> Enclosed:
        """Divided by a whole number > 0."""
        slopes = tuple(s // whole for s in self.slopes)
        lost = bool(self.middle % whole) + sum(bool(s % whole) for s in self.slopes)
        return Enclosed(self.bits, self.middle // whole, slopes, -(-self.radius // whole) + lost)

    def shifted(self, up: int) -> Enclosed:
        """Times 2^up."""
        if up >= 0:
            return self.times(1 << up)
        return _rounded(self.bits, self.middle, self.slopes, self.radius, -up)

    def in_bits(self, bits: int) -> Enclosed:
        """The same with so many bits."""
        moved = self.shifted(bits - self.bits)
        return Enclosed(bits, moved.middle, moved.slopes, moved.radius)

    def widened(self, by: Fraction) -> Enclosed:
        """With so much more for its radius."""
        more = -(-(by.numerator << self.bits) // by.denominator)
        return Enclosed(self.bits, self.middle, self.slopes, self.radius + more)

    @property
    def reach(self) -> int:
        """How far it may be from its middle, in units of 2^−bits."""
        return sum(map(abs, self.slopes)) + self.radius

    @property
    def is_zero(self) -> bool:
        """True where it is certainly 0."""
        return not self.middle and not self.radius and not any(self.slopes)

    @property
    def sign(self) -> int | None:
        """1, 0 or −1 where it is certain."""
        if abs(self.middle) > self.reach:
            return 1 if self.middle > 0 else -1
        return 0 if self.middle == 0 and self.reach == 0 else None


def known(value: Fraction, bits: int) -> Enclosed:
    """A rational number."""
    return quotient(value.numerator, value.denominator, bits)


def quotient(top: int, bottom: int, bits: int) -> Enclosed:
    """top/bottom, bottom ≠ 0: large whole numbers need no common factor taken out."""
    middle, rest = divmod(top << bits, bottom)
    return Enclosed(bits, middle, (), 1 if rest else 0)


def between(low: Fraction, high: Fraction, place: int, places: int, bits: int) -> Enclosed:
    """Every number of an interval: the middle and the slope of the εᵢ at a place."""
    half = known((high - low) / 2, bits)
    slopes = tuple(half.middle if i == place else 0 for i in range(places))
    middle = known((low + high) / 2, bits)
    return Enclosed(bits, middle.middle, slopes if high > low else (), middle.radius + half.radius)


def apart(numbers: Sequence[Enclosed]) -> list[Enclosed]:
    """The same numbers, the radius of each now an ε of its own, which cancels where it is subtracted."""
    shared = max(len(x.slopes) for x in numbers)
    if not shared:
        return list(numbers)
    found = []
    for place, x in enumerate(numbers):
        own = [0] * len(numbers)
        own[place] = x.radius
        found.append(Enclosed(x.bits, x.middle, (*(x.slopes or (0,) * shared), *own)))
    return found


def dot(a: Iterable[Enclosed], b: Iterable[Enclosed]) -> Enclosed:
    """Σ a_i b_i of numbers with one `bits`, rounded once; at least one of each."""
    middle = rest = bits = terms = 0
    slopes: list[int] = []
    for x, y in zip(a, b, strict=True):
        bits = x.bits
        if x.is_zero or y.is_zero:
            continue
        terms += 1
        middle += x.middle * y.middle
        own, strange = x.reach, y.reach
        rest += abs(x.middle) * y.radius + abs(y.middle) * x.radius + own * strange
        for factor, part in ((y.middle, x.slopes), (x.middle, y.slopes)):
            if part:
                moved = [factor * s for s in part]
                slopes = [s + t for s, t in zip(slopes, moved, strict=True)] if slopes else moved
    return _rounded(bits, middle, slopes, rest, bits, terms)


def mapped(matrix: Iterable[Iterable[Enclosed]], vector: Sequence[Enclosed]) -> list[Enclosed]:
    """A matrix times a vector."""
    return [dot(vector, row) for row in matrix]


def _merged(a: Slopes, b: Slopes, sign: int) -> Slopes:
    if not b:
        return a
    if not a:
        return b if sign > 0 else tuple(-s for s in b)
    return tuple(x + sign * y for x, y in zip(a, b, strict=True))


def _rounded(bits: int, middle: int, slopes: Sequence[int], rest: int, down: int, terms: int = 1) -> Enclosed:
    """Over 2^down, after so many products: one unit of radius for every number that has lost something."""
    spend((1 + terms) * (1 + len(slopes)), bits, each=_PRODUCT / 2)
    mask = (1 << down) - 1
    lost = sum([s & mask != 0 for s in (middle, *slopes)])
    return Enclosed(bits, middle >> down, tuple([s >> down for s in slopes]), -(-rest >> down) + lost)


def in_z(in_zeta: list[Enclosed]) -> list[Enclosed]:
    """A polynomial in ζ = z − 1, in powers of z, descending."""
    zero = Enclosed(in_zeta[0].bits, 0)
    out: list[Enclosed] = []
    for c in in_zeta:  # Horner
        out = [x - y for x, y in zip([*out, zero], [zero, *out], strict=True)]
        out[-1] = out[-1] + c
    return out


# Functions of numbers known within bounds, from Taylor's theorem.
#
# f(m + t) = f(m) + f'(m) t + f''(ξ) t²/2,    |t| ≤ reach


MOST_TURNS = 64
"""Largest angle [rad]."""
MOST_TERMS = 400


class NotPositive(ArithmeticError):
    """A root of what may be 0 or less, or an inverse of what may be 0."""


def inverse(x: Enclosed) -> Enclosed:
    """1/x, of x that is certainly not 0."""
    m, bits = x.middle, x.bits
    least = abs(m) - x.reach
    if least <= 0:
        raise NotPositive
    value, rate = (1 << 2 * bits) // m, -(1 << 3 * bits) // (m * m)
    return _taylor(x, (value, value + 1), (rate, rate + 1), -(-(2 << 4 * bits) // least**3))


def root(x: Enclosed) -> Enclosed:
    """√x, of x that is certainly > 0."""
    m, bits = x.middle, x.bits
    least = m - x.reach
    if least <= 0:
        raise NotPositive
    value, lowest = isqrt(m << bits), isqrt(least << bits)
    rate = (1 << 2 * bits) // (2 * (value + 1)), -(-(1 << 2 * bits) // (2 * value))
    return _taylor(x, (value, value + 1), rate, -(-(1 << 3 * bits) // (4 * least * lowest)))


def sine_cosine(x: Enclosed) -> tuple[Enclosed, Enclosed]:
    """sin x and cos x, x in radians."""
    if abs(x.middle) + x.reach > MOST_TURNS << x.bits:
        raise Invalid("an angle is too many turns from 0")
    fine = x.bits + 3 * (abs(x.middle) >> x.bits) + 8  # the terms of the series are as large as e^x
    middle = Enclosed(x.bits, x.middle).in_bits(fine)
    sine, cosine = (_series(middle, first).in_bits(x.bits) for first in (1, 0))
    return _curved(x, sine, cosine), _curved(x, cosine, -sine)


def _curved(x: Enclosed, value: Enclosed, rate: Enclosed) -> Enclosed:
    """sin or cos, whose second derivative is the function itself, but for its sign."""
    bend = min(1 << x.bits, abs(value.middle) + value.radius + x.reach)
    return _taylor(x, _ends(value), _ends(rate), bend)


def _ends(x: Enclosed) -> tuple[int, int]:
    return x.middle - x.radius, x.middle + x.radius


def _series(x: Enclosed, first: int) -> Enclosed:
    """sin x (first 1) or cos x (first 0): once a term is below the last digit and the following are half of
    the one before, all that is left is below it too."""
    minus_square = -(x * x)
    term = x if first else Enclosed(x.bits, 1 << x.bits)
    total, n = term, first
    while abs(term.middle) + term.radius > 4 or n * n < 2 * abs(minus_square.middle) >> x.bits:
        term, n = (term * minus_square).over((n + 1) * (n + 2)), n + 2
        total = total + term
        if n > MOST_TERMS:
            raise Invalid("an angle is too many turns from 0")
    return Enclosed(x.bits, total.middle, (), total.radius + 8)


def _taylor(x: Enclosed, value: tuple[int, int], rate: tuple[int, int], bend: int) -> Enclosed:
    """f(m) and f'(m) lie between two numbers each, |f''| is at most `bend` wherever x may be.

    Both pairs are at least a unit apart, so that half of it and a middle rounded down are no more than that.
    """
    bits, reach = x.bits, x.reach
    slope = sum(rate) // 2
    slopes = tuple(slope * s >> bits for s in x.slopes)
    off = abs(slope) * x.radius + (rate[1] - rate[0]) * reach + (bend * reach * reach >> bits + 1)
    middle = sum(value) // 2
    radius = (off >> bits) + 1 + len(slopes) + value[1] - value[0]
    return Enclosed(bits, middle, slopes, radius)
