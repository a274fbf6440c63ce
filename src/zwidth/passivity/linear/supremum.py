"""The supremum of the linear criterion and where it is reached.

At a given damping the tightest frequency is a root of a polynomial; raising b
to what that frequency needs and looking again converges in a few steps (Newton
for a fractional programme, Dinkelbach 1967).  This finds the place; what is
claimed there is decided exactly elsewhere.
"""

from __future__ import annotations

from fractions import Fraction
from functools import lru_cache
from math import acos, inf, pi

from flint import fmpq_poly

from zwidth.passivity.linear.loop import LinearLoop
from zwidth.passivity.linear.roots import roots_inside
from zwidth.passivity.linear.schur import is_schur

_FLAT = 1e-12
"""Relative difference below which two frequencies are equally tight."""


@lru_cache(maxsize=16)
def tightest(loop: LinearLoop) -> tuple[float, Fraction]:
    """(required damping [N·s/m], cos ωT) where the criterion is tightest.

    Of equally tight frequencies the highest is given: there the motion that
    shows a violation is the shortest.
    """
    best, cosine = _best(loop, [Fraction(-1), Fraction(0), Fraction(1), *_poles_on_circle(loop)])
    for _ in range(12):
        candidates = _stationary(loop.with_damping(_rational(max(best, 0.0))))
        value, at = _best(loop, [*candidates, cosine])
        if value <= best * (1 + 1e-15) or value == inf:
            best, cosine = (value, at) if value > best else (best, cosine)
            break
        best, cosine = value, at
    return best, cosine


def frequency(cosine: Fraction, period: Fraction) -> float:
    """ω/2π [Hz] of cos ωT."""
    turns = acos(max(-1.0, min(1.0, float(cosine)))) / (2 * pi)
    return turns / float(period)


def _best(loop: LinearLoop, cosines: list[Fraction]) -> tuple[float, Fraction]:
    needs = [(loop.required_damping_at(c), c) for c in cosines]
    top = max(need for need, _ in needs)
    least = top if top == inf else top - abs(top) * _FLAT
    return top, min(c for need, c in needs if need >= least)


def _poles_on_circle(loop: LinearLoop) -> list[Fraction]:
    """Where |D|² vanishes, and the need may be without bound."""
    if is_schur(loop.denominator[::-1]):
        return []
    return roots_inside(loop.dissipation.numer())


def _stationary(loop: LinearLoop) -> list[Fraction]:
    """Points of (−1, 1) where criterion/|D|² is stationary."""
    p, weight = fmpq_poly(loop.criterion), loop.dissipation
    slope = (p.derivative() * weight - p * weight.derivative()).numer()
    return roots_inside(slope)


def _rational(value: float) -> Fraction:
    return Fraction(value).limit_denominator(10**24) if value < inf else Fraction(0)
