"""What hold, delay and virtual damping ask of b: Colgate & Schenkel (1997), and what follows from it.

Each formula gives the smallest device damping b, or the largest stiffness, with which the sampled loop is
passive, equality included: for sustained contact, or where it says so for contact made and broken.  Outside
its hypotheses it raises instead of answering.  The exact engine decides the same loops, and many others,
without them.

Numbers are decimals as typed.  A rational result is an `Exact`; where a square root is irrational it is a
float.  A delay is (d + α) T, d whole and 0 ≤ α < 1: in every sample the hand meets the old force for αT and
the new one for the rest.
"""

from __future__ import annotations

from fractions import Fraction
from math import isqrt, sqrt

from zwidth.errors import InputError
from zwidth.passivity.formulas.hypotheses import NEGATIVE_SPRING, NO_CLOCK, nonnegative, number, positive
from zwidth.quantity.exact import Exact, RealLike


def kelvin_voigt_damping(stiffness: RealLike, damping: RealLike, sample_period: RealLike) -> Exact:
    """b ≥ K T/2 + |B| for f = K x + B (x(k) − x(k−1))/T, without delay.

    The criterion asks for K T/2 − B cos ωT at the frequency ω: it is tightest at
    the Nyquist frequency for B > 0 and towards ω = 0 for B < 0.

    Parameters
    ----------
    stiffness
        K ≥ 0 [N/m; N·m/rad].
    damping
        B of the environment, of either sign [N·s/m; N·m·s/rad].
    sample_period
        T > 0 [s].

    Returns
    -------
    Exact
        The smallest device damping [N·s/m; N·m·s/rad].

    References
    ----------
    Colgate & Schenkel, Journal of Robotic Systems 14(1), 1997.
    """
    k = nonnegative("stiffness", stiffness, NEGATIVE_SPRING)
    t = positive("sample_period", sample_period, NO_CLOCK)
    return Exact(k * t / 2 + abs(number("damping", damping)))


def window_damping(
    stiffness: RealLike, damping: RealLike, samples: int, sample_period: RealLike
) -> Exact | float:
    """b ≥ K T/2 + c_N |B| for f = K x + B (x(k) − x(k−N))/(N T), without delay.

    The criterion asks for K T/2 − (B/N) (cos θ + cos 2θ + … + cos Nθ), θ = ωT.  For B ≤ 0 it is tightest
    towards ω = 0: c_N = 1 for every N.  For B > 0 the smallest value of the sum decides:

        c_1 = 1,    c_2 = 9/16,    c_3 = (17 + 7√7)/81

    Parameters
    ----------
    stiffness
        K ≥ 0 [N/m; N·m/rad].
    damping
        B, of either sign [N·s/m; N·m·s/rad].
    samples
        N ≥ 1; at most 3 for B > 0, beyond which there is no simple closed form.
    sample_period
        T > 0 [s].

    Returns
    -------
    Exact or float
        The smallest device damping [N·s/m; N·m·s/rad].

    Notes
    -----
    Derived for this project, from 2 sin Nφ cos (N+1)φ = sin (2N+1)φ − sin φ.
    """
    added = number("damping", damping)
    n = number("samples", samples)
    if n.denominator != 1 or n < 1:
        raise InputError(f"samples is a whole number ≥ 1, got {samples}: the window spans that many periods")
    if added > 0 and n > 3:
        raise InputError(
            f"with damping > 0 the closed form covers windows of at most 3 samples, got {n}; "
            "check the wall itself: the exact engine covers every window"
        )
    if added <= 0 or n == 1:
        return kelvin_voigt_damping(stiffness, damping, sample_period)
    spring = kelvin_voigt_damping(stiffness, 0, sample_period).fraction
    if n == 2:
        return Exact(spring + Fraction(9, 16) * added)
    return float(spring) + float(added) * (17 + 7 * sqrt(7)) / 81


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

    Sufficient: with V' = f, f(k) Δx ≥ ΔV − ½ K Δx²; a force i samples older differs by at most K times the
    path since, so that over all intervals the delay costs at most (d + α) K Σ Δx²; and |g − h| ≤ K |Δx|.
    Hence b/T ≥ K (½ + d + α) + T α(1 − α) K²/4b is enough.  Necessary: a slow sinusoid inside a linear spring
    needs that much as ω → 0.
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


def damped_wall_damping(
    stiffness: RealLike, damping: RealLike, sample_period: RealLike, delay_samples: int = 0
) -> Exact:
    """b ≥ (2d + 1) K T/2 + |B| for a damped wall with contact made and broken, clamped or not.

    For every estimate of velocity whose weights are ≥ 0 and sum to 1: backward difference, window, one-pole
    filter.  With the backward difference, without delay, it is necessary too (clamped: for K > 0), for then
    the linear criterion in sustained contact asks for as much.

    Parameters
    ----------
    stiffness
        K ≥ 0 [N/m; N·m/rad].
    damping
        B, of either sign [N·s/m; N·m·s/rad].
    sample_period
        T > 0 [s].
    delay_samples
        d, the delay in whole samples.

    Returns
    -------
    Exact
        Device damping that is enough [N·s/m; N·m·s/rad].

    Notes
    -----
    Derived for this project; the proof is in the documentation.
    """
    d = nonnegative("delay_samples", delay_samples, "a force follows its sample")
    if d.denominator != 1:
        raise InputError(
            f"delay_samples is a whole number, got {delay_samples}: with a force that changes inside a "
            "sample a root is asked for, which check takes"
        )
    k = nonnegative("stiffness", stiffness, NEGATIVE_SPRING)
    t = positive("sample_period", sample_period, NO_CLOCK)
    return Exact((2 * d + 1) * k * t / 2 + abs(number("damping", damping)))
