"""Is an integer polynomial ≥ 0 on all of [−1, 1]?  Decided exactly.

The polynomial is written as (1 − c)ⁱ (1 + c)ʲ s(c)² g(c) with g squarefree and not zero at ±1, so that
touching zero, at the ends or inside, is told apart from crossing it.  Then g > 0 on [−1, 1] is decided by
Descartes' rule of signs on halved intervals (Vincent, Collins & Akritas): no grid, no rounding.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from flint import fmpq, fmpz_poly

from zwidth.errors import InputError
from zwidth.passivity.linear.exact_algebra import halves, on_unit_interval, root_between, sign_changes
from zwidth.quantity.balls import as_fmpq

MOST_WORDS = 40_000_000
"""Words of 64 bits in all polynomials that one sign is decided from: a few seconds' work."""


class TooClose(InputError):
    """A polynomial comes so close to zero that its sign would take more work than is spent on it."""

    def __init__(self) -> None:
        super().__init__(
            "a criterion comes so close to zero that to tell its sign would take more work than is spent on "
            "it: give fewer digits, or a lower order"
        )


_ONE = fmpz_poly([1])
_HALF = fmpq(1, 2)
_NARROW = Fraction(1, 100)  # intervals in which a valley is looked for; in wider ones halving does
_VALLEY_BITS = (256, 1024, 3072)  # to which its lowest point is computed, one after the other


@dataclass(frozen=True)
class Positivity:
    """p = (1 − c)ⁱ (1 + c)ʲ s² g with g > 0 on [−1, 1]: the proof that p ≥ 0 there.

    Coefficients in ascending powers of c; p is integer up to a positive factor.
    """

    at_one: int
    at_minus_one: int
    square: tuple[int, ...]
    factor: tuple[int, ...]


def prove_nonnegative(p: fmpz_poly, known: bool = False) -> Positivity | Fraction:
    """A proof that p ≥ 0 on [−1, 1], or a rational point of (−1, 1) where p < 0.

    `p`: the polynomial; `known`: True where p ≥ 0 is known and only its factors are asked for: a squarefree g
    crosses each of its zeros, and has none.
    """
    if p.degree() < 0:
        return Positivity(0, 0, (), (1,))
    g, at_one = _strip(p, 1)
    g, at_minus_one = _strip(g, -1)
    if at_one % 2:
        g = -g  # (c − 1) was divided out, (1 − c) is meant
    square, g = _split_square(g)
    point = None if known else _negative_point(g)
    if point is None:
        return Positivity(at_one, at_minus_one, _ints(square), _ints(g))
    return where_negative(p, point)


def _strip(p: fmpz_poly, root: int) -> tuple[fmpz_poly, int]:
    times = 0
    while p(root) == 0:
        p, times = p // fmpz_poly([-root, 1]), times + 1
    return p, times


def _split_square(p: fmpz_poly) -> tuple[fmpz_poly, fmpz_poly]:
    """p = s² g up to a positive factor, g squarefree."""
    content, factors = p.factor_squarefree()
    square, rest = _ONE, _ONE if content > 0 else -_ONE
    for factor, times in factors:
        square *= factor ** (times // 2)
        if times % 2:
            rest *= factor
    return square, rest


def _negative_point(g: fmpz_poly) -> Fraction | None:
    """A point of [−1, 1] where a squarefree g < 0, or None when g > 0 throughout."""
    if g(1) < 0:
        return Fraction(1)
    if g(-1) < 0:
        return Fraction(-1)
    work, words = [(on_unit_interval(g), Fraction(-1), Fraction(1))], 0
    while work:
        h, low, high = work.pop()
        words += 2 * (h.degree() + 1) * (h.height_bits() // 64 + 1)  # this one, or its halves
        if words > MOST_WORDS:
            raise TooClose
        changes = sign_changes(h)
        valley = changes == 2 and high - low < _NARROW and _valley(g, h, low, high)
        if changes == 0 or valley is True:
            continue
        if valley is not False:
            return valley
        middle = (low + high) / 2
        value = g(as_fmpq(middle))
        if value < 0:
            return middle
        if value == 0:  # a simple root: g is negative on one side of it
            return where_negative(g, middle)
        left, right = halves(h)
        work += [(left, low, middle), (right, middle, high)]
    return None


def _valley(g: fmpz_poly, h: fmpz_poly, low: Fraction, high: Fraction) -> Fraction | bool:
    """Whether g > 0 between two points where it is, or a point where g < 0; False where that stays open.

    `h` is g with (0, 1) over the interval.  Bent down throughout, g is least at an end.  Bent up, it lies
    above each of its tangents: one at nearly the lowest point decides.
    """
    bend = h.derivative().derivative()
    if sign_changes(bend):
        return False
    slope = g.derivative()
    if bend(_HALF) < 0 or slope(as_fmpq(low)) >= 0 or slope(as_fmpq(high)) <= 0:
        return bool(bend(_HALF))
    for bits in _VALLEY_BITS:
        lowest = Fraction(round(root_between(slope, low, high, bits) * (1 << bits)), 1 << bits)
        value = g(as_fmpq(lowest))
        if value < 0:
            return lowest
        if low <= lowest <= high and value > abs(slope(as_fmpq(lowest))) * as_fmpq(high - low):
            return True
    raise TooClose


def where_negative(p: fmpz_poly, point: Fraction) -> Fraction:
    """Move off a zero of the square or an end of [−1, 1] while p stays negative."""
    step = Fraction(1, 2)
    while True:
        for candidate in (point, point + step, point - step):
            inside = -1 < candidate < 1
            if inside and p(as_fmpq(candidate)) < 0:
                return candidate
        step /= 2


def _ints(p: fmpz_poly) -> tuple[int, ...]:
    return tuple(int(c) for c in p.coeffs())
