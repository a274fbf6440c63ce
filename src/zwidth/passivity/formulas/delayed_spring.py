"""A spring whose force comes late by any time: the damping it needs, in closed form.

delay = (d + α) T, d whole and 0 ≤ α < 1: in every sample the hand meets the old
force for αT and the new one for the rest.
"""

from __future__ import annotations

from fractions import Fraction
from math import isqrt, sqrt

from zwidth.passivity.formulas.hypotheses import NEGATIVE_SPRING, NO_CLOCK, nonnegative, positive
from zwidth.quantity.exact import Exact, RealLike


def spring_damping(stiffness: RealLike, sample_period: RealLike, delay: RealLike = 0) -> Exact | float:
    """b ≥ (K T/4) [2d + 1 + 2α + √((2d + 1)² + 8 α (d + 1))] for a spring, delay = (d + α) T.

    Without a fractional part, (2d + 1) K T/2.  The same without a root:

        b² − b (K T/2)(2d + 1 + 2α) − (T²/4) α (1 − α) K² ≥ 0,    b ≥ 0

    Parameters
    ----------
    stiffness
        K ≥ 0 [N/m; N·m/rad], or the largest slope of a nonlinear spring whose
        slope lies in 0 … K, such as a one-sided wall.
    sample_period
        T > 0 [s].
    delay
        From the sample to its force, ≥ 0 [s]; d whole, 0 ≤ α < 1.

    Returns
    -------
    Exact or float
        The smallest device damping [N·s/m; N·m·s/rad].

    Notes
    -----
    Derived for this project.  In one interval the hand meets g = f(k−d−1) for
    αT, then h = f(k−d).  The cheapest way over Δx costs

        (α g + (1 − α) h) Δx + (b/T) Δx² − (T α(1 − α)/4b) (g − h)²

    Sufficient: with V' = f, f(k) Δx ≥ ΔV − ½ K Δx²; a force i samples older
    differs by at most K times the path since, so that over all intervals
    the delay costs at most (d + α) K Σ Δx²; and |g − h| ≤ K |Δx|.  Hence
    b/T ≥ K (½ + d + α) + T α(1 − α) K²/4b is enough.  Necessary: a slow
    sinusoid inside a linear spring needs that much as ω → 0.
    """
    k = nonnegative("stiffness", stiffness, NEGATIVE_SPRING)
    t = positive("sample_period", sample_period, NO_CLOCK)
    return _scaled_bracket(k * t / 4, delay, t)


def spring_stiffness(damping: RealLike, sample_period: RealLike, delay: RealLike = 0) -> Exact | float:
    """K ≤ (4b/T) / [2d + 1 + 2α + √((2d + 1)² + 8 α (d + 1))], the inverse of `spring_damping`.

    Parameters
    ----------
    damping
        b ≥ 0 of the device [N·s/m; N·m·s/rad].
    sample_period
        T > 0 [s].
    delay
        From the sample to its force, (d + α) T ≥ 0 [s].

    Returns
    -------
    Exact or float
        The largest stiffness [N/m; N·m/rad]; 2b/T without delay.
    """
    b = nonnegative("damping", damping, "viscous friction takes energy, it never gives any")
    t = positive("sample_period", sample_period, NO_CLOCK)
    bracket = _scaled_bracket(Fraction(1), delay, t)
    return Exact(4 * b / t / bracket.fraction) if isinstance(bracket, Exact) else float(4 * b / t) / bracket


def _scaled_bracket(scale: Fraction, delay: RealLike, period: Fraction) -> Exact | float:
    """scale · [2d + 1 + 2α + √((2d + 1)² + 8 α (d + 1))]."""
    late = nonnegative("delay", delay, "a force cannot come before its sample") / period
    d = late // 1
    alpha = late - d
    linear = 2 * d + 1 + 2 * alpha
    square = Fraction((2 * d + 1) ** 2) + 8 * alpha * (d + 1)
    p, q = isqrt(square.numerator), isqrt(square.denominator)
    if p * p == square.numerator and q * q == square.denominator:
        return Exact(scale * (linear + Fraction(p, q)))
    return float(scale) * (float(linear) + sqrt(square))
