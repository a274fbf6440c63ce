"""Functions of numbers known within bounds, from Taylor's theorem.

f(m + t) = f(m) + f'(m) t + f''(ξ) t²/2,    |t| ≤ reach
"""

from __future__ import annotations

from math import isqrt

from ..document.refusal import Invalid
from .enclosed import Enclosed

MOST_TURNS = 64
"""Largest angle [rad]."""
MOST_TERMS = 400


class NotPositive(Exception):
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
