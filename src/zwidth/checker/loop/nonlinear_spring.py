"""A spring given by points, its force held and read in counts: what its slopes ask of the device.

    b ≥ (L/2 + d s) T      f_c ≥ s Δ/2

L ≥ 0 the largest slope, s the largest |slope|, d whole samples of delay; beyond its ends the spring does
not pull away, so that its potential Φ has a lowest value.  With x̃ = x − Δ/2 the storage
V = Φ(x̃) + (s/2) Σ_{i<d} (d − i) Δx²_{n−i} pays for every move:

    φ(q_{n−d}) D ≥ φ(x̃_n) D − (s Δ/2 + s Σ|Δx|) |D|,     φ(x̃) D ≥ Φ(x̃ + D) − Φ(x̃) − (L/2) D²
"""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from itertools import pairwise
from typing import Any

from ..document.reading import MOST_COEFFICIENTS, Invalid, get, number, quantity, with_no_more_than

MOST_POINTS = 10_000
_NUMBERS = ("damping", "coulomb_friction", "resolution", "sample_period", "delay")
_POINTS = ("points_m_N", "points_rad_N_m")


def nonlinear_spring(document: Mapping[str, Any]) -> str:
    loop, law = get(document, "loop"), get(document, "law")
    b, friction, resolution, period, delay = (quantity(loop, name) for name in _NUMBERS)
    with_no_more_than(loop, len(_NUMBERS))
    with_no_more_than(law, 1)
    if period <= 0 or min(b, friction, resolution, delay) < 0:
        raise Invalid("T must be > 0 and b, f_c, Δ and the delay ≥ 0")
    if delay % period or delay // period > MOST_COEFFICIENTS:
        raise Invalid("a nonlinear spring is proved for delays of whole samples, not too many")
    points = _points(law)
    if points[0][1] > 0 or points[-1][1] < 0:
        raise Invalid("beyond its ends the spring pulls away for ever: its potential has no lowest value")
    slopes = [(f1 - f0) / (x1 - x0) for (x0, f0), (x1, f1) in pairwise(points)]
    largest, steepest = max(*slopes, Fraction(0)), max(map(abs, slopes))
    if b < (largest / 2 + delay // period * steepest) * period:
        raise Invalid("the damping is below what the hold and the delay of this spring need")
    if 2 * friction < steepest * resolution:
        raise Invalid("the Coulomb friction is below half a count of the steepest part of this spring")
    return "the damping covers its largest slope, the Coulomb friction its steepest part, and it holds within"


def endless_pull(document: Mapping[str, Any]) -> str:
    """Beyond an end the spring pulls away with more than Coulomb friction holds: a slow hand gains on.

    At a speed v the gain on a way s is (|f| − f_c − b v) s, > 0 for a small v, whatever b, T and the delay.
    """
    loop, law = get(document, "loop"), get(document, "law")
    b, friction, _, period, _ = (quantity(loop, name) for name in _NUMBERS)
    with_no_more_than(loop, len(_NUMBERS))
    with_no_more_than(law, 1)
    if period <= 0 or min(b, friction) < 0:
        raise Invalid("T must be > 0 and b and f_c ≥ 0")
    points = _points(law)
    pull = max(points[0][1], -points[-1][1])
    if pull <= friction:
        raise Invalid("Coulomb friction holds the spring beyond its ends")
    return f"beyond an end the spring pulls away with {float(pull):g} for ever, and friction holds less"


def _points(law: Mapping[str, Any]) -> list[tuple[Fraction, Fraction]]:
    pairs = get(law, next((key for key in _POINTS if key in law), _POINTS[0]))
    if not isinstance(pairs, list) or not 2 <= len(pairs) <= MOST_POINTS:
        raise Invalid("a nonlinear spring is a list of two points or more, and not too many")
    if not all(isinstance(pair, (list, tuple)) and len(pair) == 2 for pair in pairs):
        raise Invalid("a point is a position and a force")
    points = [(number(x), number(f)) for x, f in pairs]
    if any(before[0] >= after[0] for before, after in pairwise(points)):
        raise Invalid("the positions of a nonlinear spring must increase")
    return points
