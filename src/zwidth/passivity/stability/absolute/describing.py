"""A guess at the motion that a one-sided wall sustains: its mean and its first harmonic, nothing above.

    x = x̄ + a cos ωt,    f = K max(x − g, 0),    inside while |ωt| < β,  cos β = (g − x̄)/a

    gain      N(β) = (K/π)(β − sin β cos β),    1 + N G(e^{jωT}) = 0  ⇒  N = K_lin
    mean      x̄ = −G(1) (K a/π)(sin β − β cos β)
    gap       g = a [cos β − G(1) (K/π)(sin β − β cos β)]

A heuristic: it neglects every harmonic, and that a sampled motion meets the surface at samples only.  It
bounds nothing, from above or below.
"""

from __future__ import annotations

from math import cos, pi, sin
from typing import NamedTuple

from scipy.optimize import brentq

from zwidth.passivity.stability.absolute.linear_limit import linear_limit
from zwidth.passivity.stability.absolute.plant import Plant


class Guess(NamedTuple):
    """`amplitude` a in units of |gap|, `contact` β/π, the share of the time inside."""

    amplitude: float
    contact: float


def describing_guess(plant: Plant, slope: float, gap: float) -> Guess | None:
    """The motion that the describing function expects, None where it expects none.

    Parameters
    ----------
    plant
        G.
    slope
        K of the wall.
    gap
        From where the hand rests to the surface; < 0 for a hand that presses.
    """
    share = linear_limit(plant).slope / slope
    if not share < 1:
        return None
    beta = _angle(share)
    reach = _reach(plant, slope, beta)
    if gap == 0 or reach / gap <= 0:
        return None
    return Guess(1 / abs(reach), beta / pi)


def _angle(share: float) -> float:
    """β with (β − sin β cos β)/π = share."""
    return float(brentq(lambda b: (b - sin(b) * cos(b)) / pi - share, 0.0, pi))


def _reach(plant: Plant, slope: float, beta: float) -> float:
    """g/a."""
    still = plant.response_at(0.0).real
    return cos(beta) - still * slope / pi * (sin(beta) - beta * cos(beta))
