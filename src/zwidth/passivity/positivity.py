"""Is an integer polynomial ≥ 0 on all of [−1, 1]?  Decided exactly.

The polynomial is written as (1 − c)ⁱ (1 + c)ʲ s(c)² g(c) with g squarefree and
not zero at ±1, so that touching zero, at the ends or inside, is told apart
from crossing it.  Then g > 0 on [−1, 1] is decided by Descartes' rule of signs
on halved intervals (Vincent, Collins & Akritas): no grid, no rounding.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from flint import fmpq, fmpz_poly

from zwidth.passivity.descartes import halves, on_unit_interval, sign_changes

_ONE = fmpz_poly([1])


@dataclass(frozen=True)
class Positivity:
    """p = (1 − c)ⁱ (1 + c)ʲ s² g with g > 0 on [−1, 1]: the proof that p ≥ 0 there.

    Coefficients in ascending powers of c; p is integer up to a positive factor.
    """

    at_one: int
    at_minus_one: int
    square: tuple[int, ...]
    factor: tuple[int, ...]


def prove_nonnegative(p: fmpz_poly) -> Positivity | Fraction:
    """A proof that p ≥ 0 on [−1, 1], or a rational point of (−1, 1) where p < 0."""
    if p.degree() < 0:
        return Positivity(0, 0, (), (1,))
    g, at_one = _strip(p, 1)
    g, at_minus_one = _strip(g, -1)
    if at_one % 2:
        g = -g  # (c − 1) was divided out, (1 − c) is meant
    square, g = _split_square(g)
    point = _negative_point(g)
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
    work = [(on_unit_interval(g), Fraction(-1), Fraction(1))]
    while work:
        h, low, high = work.pop()
        if sign_changes(h) == 0:
            continue
        middle = (low + high) / 2
        value = g(fmpq(middle.numerator, middle.denominator))
        if value < 0:
            return middle
        if value == 0:  # a simple root: g is negative on one side of it
            return where_negative(g, middle)
        left, right = halves(h)
        work += [(left, low, middle), (right, middle, high)]
    return None


def where_negative(p: fmpz_poly, point: Fraction) -> Fraction:
    """Move off a zero of the square or an end of [−1, 1] while p stays negative."""
    step = Fraction(1, 2)
    while True:
        for candidate in (point, point + step, point - step):
            inside = -1 < candidate < 1
            if inside and p(fmpq(candidate.numerator, candidate.denominator)) < 0:
                return candidate
        step /= 2


def _ints(p: fmpz_poly) -> tuple[int, ...]:
    return tuple(int(c) for c in p.coeffs())
