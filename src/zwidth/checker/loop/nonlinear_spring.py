"""A spring given by points, its force held and read in counts: what its slopes ask of the device.

    b ≥ (L/2 + d s) T      f_c ≥ s Δ/2

L ≥ 0 the largest slope, s the largest |slope|, d whole samples of delay; beyond its ends the spring does
not pull away, so that its potential Φ has a lowest value.  With x̃ = x − Δ/2 the storage
V = Φ(x̃) + (s/2) Σ_{i<d} (d − i) Δx²_{n−i} pays for every move:

    φ(q_{n−d}) D ≥ φ(x̃_n) D − (s Δ/2 + s Σ|Δx|) |D|,     φ(x̃) D ≥ Φ(x̃ + D) − Φ(x̃) − (L/2) D²
"""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise

from ..document.fields import Read, Record, document, increasing, pairs
from ..document.number import about
from ..document.refusal import Invalid
from ..document.unit import FORCE_AT
from .loop import DEVICE, MOST_DELAY

MOST_POINTS = 10_000
_POSITIONS = "the positions of a nonlinear spring"

NONLINEAR_SPRING = document(
    {"loop": Record(DEVICE), "law": Record({"points": pairs(FORCE_AT, least=2, most=MOST_POINTS)})}
)


def nonlinear_spring(told: Read) -> str:
    """Say what was proved."""
    loop, points = told.loop, increasing(told.law.points, _POSITIONS)
    period, delay = loop.sample_period, loop.delay
    if delay % period or delay // period > MOST_DELAY:
        raise Invalid(f"a nonlinear spring is proved for delays of whole samples, at most {MOST_DELAY}")
    if points[0][1] > 0 or points[-1][1] < 0:
        raise Invalid("beyond its ends the spring pulls away for ever: its potential has no lowest value")
    slopes = [(f1 - f0) / (x1 - x0) for (x0, f0), (x1, f1) in pairwise(points)]
    largest, steepest = max(*slopes, Fraction(0)), max(map(abs, slopes))
    if loop.damping < (largest / 2 + delay // period * steepest) * period:
        raise Invalid("the damping is below what the hold and the delay of this spring need")
    if 2 * loop.coulomb_friction < steepest * loop.resolution:
        raise Invalid("the Coulomb friction is below half a count of the steepest part of this spring")
    return "the damping covers its largest slope, the Coulomb friction its steepest part, and it holds within"


def endless_pull(told: Read) -> str:
    """Beyond an end the spring pulls away with more than Coulomb friction holds: a slow hand gains on.

    At a speed v the gain on a way s is (|f| − f_c − b v) s, > 0 for a small v, whatever b, T and the delay.
    """
    points = increasing(told.law.points, _POSITIONS)
    pull = max(points[0][1], -points[-1][1])
    if pull <= told.loop.coulomb_friction:
        raise Invalid("Coulomb friction holds the spring beyond its ends")
    return f"beyond an end the spring pulls away with {about(pull)} for ever, and friction holds less"
