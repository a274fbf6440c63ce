"""Springs, of one stiffness or given by points: the closed condition of each."""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise
from math import ceil

from ..document.fields import Read, Record, document, pairs
from ..document.number import FORCE_AT, about, common_scale, increasing
from ..document.refusal import Invalid, spend
from .loop import DEVICE, LOOP, MOST_DELAY, loop_of

# A spring: the closed condition, with contact made and broken.
#
#     b² − b (KT/2)(2d + 1 + 2α) ≥ (T²/4) α(1 − α) K²    and    2 f_c ≥ K Δ,    K ≥ 0
#
# V = ½ K (x − Δ/2)² inside is a storage function when there is no delay; each held or delayed force differs
# from its gradient by what b and f_c absorb.

SPRING = document({"loop": LOOP})


def spring(told: Read) -> str:
    """Say what was proved."""
    p = loop_of(told.loop)
    if any(p.numerator[1:]) or any(p.denominator[1:]):
        raise Invalid("the law is not a spring: H(z) is not constant")
    k = p.numerator[0] / p.denominator[0]
    if k < 0:
        raise Invalid(f"the stiffness is negative: {about(k)}")
    reach = k * p.period / 2 * (2 * p.whole + 1 + 2 * p.part)
    inside = p.period**2 / 4 * p.part * (1 - p.part) * k**2
    if p.damping < reach or p.damping * (p.damping - reach) < inside:
        raise Invalid("the damping is below what the hold and the delay of this spring need")
    if 2 * p.coulomb_friction < k * p.resolution:
        raise Invalid("the Coulomb friction is below half a count of this spring, K Δ/2")
    return "2b/T with delay and 2 f_c/Δ both admit this stiffness"


# A spring given by points, its force held and read in counts: what its slopes ask of the device.
#
#     b (b − w T) ≥ α (1 − α) s² T²/4,   w = L/2 + (d + α) s,   b ≥ 0      f_c ≥ s Δ/2
#
# L ≥ 0 the largest slope, s the largest |slope|, a delay of d whole samples and a part α of one; beyond its
# ends the spring does not pull away, so that its potential Φ has a lowest value.  In a sample the hand moves
# by u against g = φ(q_{n−d−1}) for α T, then by D − u against h = φ(q_{n−d}).  Coulomb friction pays for both
# counts, and whatever u is, with x̃ = x − Δ/2 and the forces there,
#
#     g u + h (D − u) + (b/T) (u²/α + (D − u)²/(1 − α))
#         ≥ (α g + (1 − α) h) D + (b/T) D² − α (1 − α) T (g − h)²/(4 b)
#     φ(x̃_{n−i}) D ≥ φ(x̃_n) D − s Σ|Δx| |D|,     φ(x̃) D ≥ Φ(x̃ + D) − Φ(x̃) − (L/2) D²
#
# and a storage Φ(x̃) + weights · Δx²_{n−i} passes on what a move owes for earlier ones.


# Without delay what Coulomb friction has left over, f' = f_c − s Δ/2, pays for short rises that are steeper:
# with g(x) = φ(x) − (2b/T) x, for every x and D > 0
#
#     ∫₀ᴰ (g(x + u) − g(x)) du ≤ f' D,     the same of −g(−x)
#
# The left side less the right one is largest where x is a point after which g rises, and x + D a point, or
# where g falls through g(x) + f'.


MOST_POINTS = 10_000
_POSITIONS = "the positions of a nonlinear spring"
NONLINEAR_SPRING = document(
    {"loop": Record(DEVICE), "law": Record({"points": pairs(FORCE_AT, least=2, most=MOST_POINTS)})}
)


def nonlinear_spring(told: Read) -> str:
    """Say what was proved."""
    loop, points = told.loop, increasing(told.law.points, _POSITIONS)
    period, b, late = loop.sample_period, loop.damping, loop.delay / loop.sample_period
    if late > MOST_DELAY:
        raise Invalid(f"the delay is more than {MOST_DELAY} samples")
    if points[0][1] > 0 or points[-1][1] < 0:
        raise Invalid("beyond its ends the spring pulls away for ever: its potential has no lowest value")
    spend(len(points), each=40)
    slopes = [(f1 - f0) / (x1 - x0) for (x0, f0), (x1, f1) in pairwise(points)]
    largest, steepest = max(*slopes, Fraction(0)), max(map(abs, slopes))
    part = late % 1
    held = (largest / 2 + late * steepest) * period
    left = loop.coulomb_friction - steepest * loop.resolution / 2
    if left < 0:
        raise Invalid("the Coulomb friction is below half a count of the steepest part of this spring")
    if b < held or 4 * b * (b - held) < part * (1 - part) * (steepest * period) ** 2:
        mirrored = [(-x, -f) for x, f in reversed(points)]
        if late > 0 or b == 0 or not all(_paid(side, 2 * b / period, left) for side in (points, mirrored)):
            raise Invalid("the damping is below what the hold and the delay of this spring need")
        return "what Coulomb friction has left over its steepest part pays for its rises, and it holds within"
    return "the damping covers its largest slope, the Coulomb friction its steepest part, and it holds within"


def _paid(points: list[tuple[Fraction, Fraction]], drag: Fraction, left: Fraction) -> bool:
    """Whether friction pays for each rise of g(x) = φ(x) − drag · x to larger x; beyond the end g falls."""
    points = [(x, f - drag * x) for x, f in points]
    values = [g for _, g in points]
    far = ceil((max(values) - min(values)) / drag) + 1  # where g is below all that it was
    points.append((points[-1][0] + far, points[-1][1] - drag * far))
    per_place, per_force = common_scale(x for x, _ in points), common_scale([g for _, g in points] + [left])
    x, g = [int(x * per_place) for x, _ in points], [int(g * per_force) for _, g in points]
    ways, spare = [b - a for a, b in pairwise(x)], int(left * per_force)
    begins = [i for i, (g0, g1) in enumerate(pairwise(g)) if g1 > g0]
    spend(len(begins) * len(points), max(map(int.bit_length, g)), max(map(int.bit_length, x)), each=2)
    for i in begins:
        level, owed = g[i] + spare, 0  # twice
        for way, (g0, g1) in zip(ways[i:], pairwise(g[i:]), strict=True):
            if g1 < level < g0 and owed * (g0 - g1) + (g0 - level) ** 2 * way > 0:
                return False
            owed += (g0 + g1 - 2 * level) * way
            if owed > 0:
                return False
    return True


def endless_pull(told: Read) -> str:
    """Beyond an end the spring pulls away with more than Coulomb friction holds: a slow hand gains on.

    At a speed v the gain on a way s is (|f| − f_c − b v) s, > 0 for a small v, whatever b, T and the delay.
    """
    points = increasing(told.law.points, _POSITIONS)
    pull = max(points[0][1], -points[-1][1])
    if pull <= told.loop.coulomb_friction:
        raise Invalid("Coulomb friction holds the spring beyond its ends")
    return f"beyond an end the spring pulls away with {about(pull)} for ever, and friction holds less"
