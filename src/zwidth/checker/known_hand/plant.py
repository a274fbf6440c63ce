"""The plant of a one-sided wall: from a device in a tied hand, or as given; coefficients with error bounds.

    M ẍ = −f − B ẋ − k x,    f held from (j + d + α) T on for T

With p = x, q = ẋ T and the unit of force M/T², per sample (p, q, f)' = A (p, q, f),

        ⎡  0        1      0 ⎤
    A = ⎢ −k T²/M  −B T/M  1 ⎥ ,    e^{As} = Σ Aⁿ sⁿ/n!
        ⎣  0        0      0 ⎦

and what the series leaves out is at most ‖As‖ⁿ/n!·1/(1 − ‖As‖/n) in any entry.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from math import factorial
from typing import Any, NamedTuple

from ..document.reading import Invalid, common_scale, get, numbers, quantity, with_no_more_than
from ..loop.proofs import _inside_unit_circle

MOST_ORDER = 300
TERMS = 160
LARGEST_NORM = 30
GRID = 1 << 256


class Enclosed(NamedTuple):
    """Coefficients in ascending powers: each within `radius` of `middle`."""

    middle: list[Fraction]
    radius: list[Fraction]


class Plant(NamedTuple):
    """G = −x/f = N/D, stable and strictly proper."""

    numerator: Enclosed
    denominator: Enclosed


def read_plant(document: Mapping[str, Any]) -> Plant:
    if "plant" in document:
        if "loop" in document:
            raise Invalid("the document speaks of a plant and of a loop: only one can be meant")
        return _given(get(document, "plant"))
    return _touched(get(document, "loop"))


def _given(plant: Mapping[str, Any]) -> Plant:
    top, bottom = (numbers(get(plant, name), MOST_ORDER) for name in ("numerator", "denominator"))
    if not top or not bottom or bottom[0] == 0 or len(top) >= len(bottom):
        raise Invalid("G(z) must be strictly proper")
    common_scale((*top, *bottom))
    if not _inside_unit_circle(bottom):
        raise Invalid("G(z) has a pole outside or on the unit circle")
    return Plant(_known(top[::-1]), _known(bottom[::-1]))


def _touched(loop: Mapping[str, Any]) -> Plant:
    names = ("mass", "damping", "hand_mass", "hand_damping", "hand_stiffness", "sample_period", "delay")
    mass, b, hand_mass, c, k, period, delay = (quantity(loop, name) for name in names)
    with_no_more_than(loop, len(names))
    total, damping = mass + hand_mass, b + c
    if min(mass, damping, k, period) <= 0 or min(b, c, hand_mass, delay) < 0:
        raise Invalid(
            "m, b + c, k and T must be > 0, and b, c, m_h and the delay ≥ 0: else G(z) is not stable"
        )
    whole, part = delay // period, delay / period % 1
    if whole > MOST_ORDER:
        raise Invalid("the delay is too many samples long")
    spring, loss = k * period**2 / total, damping * period / total
    (state, force), (_, late) = (_exponential(spring, loss, s) for s in (Fraction(1), 1 - part))
    early = [_minus(x, y) for x, y in zip(force, late, strict=True)]  # the force of the sample before
    a, b12, c21, d22 = state
    trace, determinant = _plus(a, d22), _minus(_times(a, d22), _times(b12, c21))
    rows = [_position(b12, d22, late), _position(b12, d22, early)]
    unit = (period**2 / total, Fraction(0))
    top = [_times(unit, rows[1][0]), _times(unit, _plus(rows[1][1], rows[0][0])), _times(unit, rows[0][1])]
    one, zero = (Fraction(1), Fraction(0)), (Fraction(0), Fraction(0))
    bottom = [zero] * (int(whole) + 1) + [determinant, _minus(zero, trace), one]
    return Plant(_enclosed(top), _enclosed(bottom))


_Ball = tuple[Fraction, Fraction]


def _position(coupling: _Ball, decay: _Ball, force: Sequence[_Ball]) -> tuple[_Ball, _Ball]:
    """(z − φ₂₂) γ₁ + φ₁₂ γ₂, ascending in z: how a force moves p."""
    return _minus(_times(coupling, force[1]), _times(decay, force[0])), force[0]


def _exponential(spring: Fraction, loss: Fraction, s: Fraction) -> tuple[list[_Ball], list[_Ball]]:
    """(φ₁₁, φ₁₂, φ₂₁, φ₂₂) and (γ₁, γ₂) after a part s of a sample, rounded outward."""
    norm = max(Fraction(1), spring + loss + 1)
    if norm > LARGEST_NORM:
        raise Invalid("the device and the hand move too far within one sample for the series")
    rows = [[Fraction(i == j) for j in range(3)] for i in range(2)]
    term = [list(row) for row in rows]
    for n in range(1, TERMS):
        step = s / n
        term = [[-spring * row[1] * step, (row[0] - loss * row[1]) * step, row[1] * step] for row in term]
        rows = [[x + y for x, y in zip(r, t, strict=True)] for r, t in zip(rows, term, strict=True)]
    rest = Fraction(norm**TERMS) / factorial(TERMS) / (1 - norm / TERMS) + Fraction(1, GRID)
    ball = [[(Fraction(round(x * GRID), GRID), rest) for x in row] for row in rows]
    return [*ball[0][:2], *ball[1][:2]], [ball[0][2], ball[1][2]]


def _plus(a: _Ball, b: _Ball) -> _Ball:
    return a[0] + b[0], a[1] + b[1]


def _minus(a: _Ball, b: _Ball) -> _Ball:
    return a[0] - b[0], a[1] + b[1]


def _times(a: _Ball, b: _Ball) -> _Ball:
    return a[0] * b[0], abs(a[0]) * b[1] + a[1] * abs(b[0]) + a[1] * b[1]


def _known(coefficients: list[Fraction]) -> Enclosed:
    return Enclosed(coefficients, [Fraction(0)] * len(coefficients))


def _enclosed(balls: list[_Ball]) -> Enclosed:
    return Enclosed([m for m, _ in balls], [r for _, r in balls])
