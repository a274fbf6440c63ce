"""Formulas for the common laws: what a person can compute by hand.

Each gives the smallest device damping b (or the largest stiffness, or the
smallest Coulomb friction) with which the sampled loop is passive, equality
included: for sustained contact, or where a formula says so for contact made and
broken.  A formula has hypotheses; outside them it raises instead of answering.
The exact engine decides the same loops, and many others, without them.

Numbers are decimals as typed.  A rational result is an `Exact`; where a square
root is irrational it is a float.
"""

from __future__ import annotations

from fractions import Fraction
from math import inf, sqrt
from typing import Literal, NamedTuple

from zwidth.errors import InputError
from zwidth.passivity.formulas.delayed_spring import spring_damping, spring_stiffness
from zwidth.passivity.formulas.hypotheses import NEGATIVE_SPRING, NO_CLOCK, nonnegative, number, positive
from zwidth.quantity.exact import Exact, RealLike

__all__ = [
    "StiffnessLimits",
    "abbott_okamura_stiffness",
    "damped_wall_damping",
    "damped_wall_friction",
    "kelvin_voigt_damping",
    "quantized_kelvin_voigt_friction",
    "spring_damping",
    "spring_stiffness",
    "standard_linear_solid_damping",
    "window_damping",
]

_NO_BRANCH = (
    "with 0 the solid is a spring, for which kelvin_voigt_damping(stiffness, 0, sample_period) holds, "
    "and with a negative value H is unstable"
)


class StiffnessLimits(NamedTuple):
    """The two limits of a spring wall [N/m; N·m/rad]; the smaller one binds."""

    sampling: Exact
    quantization: Exact | float


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

    The criterion asks for K T/2 − (B/N) (cos θ + cos 2θ + … + cos Nθ), θ = ωT.
    For B ≤ 0 it is tightest towards ω = 0: c_N = 1 for every N.  For B > 0 the
    smallest value of the sum decides:

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


def standard_linear_solid_damping(
    stiffness: RealLike,
    branch_stiffness: RealLike,
    branch_damping: RealLike,
    sample_period: RealLike,
    discretization: Literal["backward", "tustin"] = "backward",
) -> Exact:
    """b ≥ μ0 T/2 + μ1 η1 T/(2 η1 + μ1 T) by backward Euler, (μ0 + μ1) T/2 by Tustin's rule.

    H(s) = μ0 + μ1 η1 s/(μ1 + η1 s), without delay.  For μ1, η1 > 0 the criterion
    is monotone in 1 − cos ωT and tightest at the Nyquist frequency.  By
    Tustin's rule the branch costs μ1 T/2 however small η1 is, although with
    η1 = 0 it is absent: the limit η1 → 0 is not the value there.

    Parameters
    ----------
    stiffness
        μ0 ≥ 0 [N/m; N·m/rad].
    branch_stiffness
        μ1 > 0 [N/m; N·m/rad].
    branch_damping
        η1 > 0 [N·s/m; N·m·s/rad].  For η1 < 0 H is unstable and no damping will do.
    sample_period
        T > 0 [s].
    discretization
        "backward" or "tustin".

    Returns
    -------
    Exact
        The smallest device damping [N·s/m; N·m·s/rad].

    References
    ----------
    "A passivity criterion for real-time haptic simulation of viscoelastic soft
    tissues", equations (9) and (22).
    """
    mu0 = nonnegative("stiffness", stiffness, NEGATIVE_SPRING)
    mu1 = positive("branch_stiffness", branch_stiffness, _NO_BRANCH)
    eta1 = positive("branch_damping", branch_damping, _NO_BRANCH)
    t = positive("sample_period", sample_period, NO_CLOCK)
    if discretization == "backward":
        return Exact(mu0 * t / 2 + mu1 * eta1 * t / (2 * eta1 + mu1 * t))
    if discretization == "tustin":
        return Exact((mu0 + mu1) * t / 2)
    raise InputError(
        f'the closed form covers "backward" and "tustin", got {discretization!r}; '
        "check the solid itself: the exact engine covers every discretization"
    )


def abbott_okamura_stiffness(
    damping: RealLike, coulomb_friction: RealLike, resolution: RealLike, sample_period: RealLike
) -> StiffnessLimits:
    """K ≤ min(2b/T, 2f_c/Δ): a spring wall with encoder and Coulomb friction, without delay.

    Parameters
    ----------
    damping
        b ≥ 0 of the device [N·s/m; N·m·s/rad].
    coulomb_friction
        f_c ≥ 0 [N; N·m].
    resolution
        Δ ≥ 0 at the handle [m; rad]; with 0 the second limit is infinite.
    sample_period
        T > 0 [s].

    Returns
    -------
    StiffnessLimits
        (2b/T, 2f_c/Δ) [N/m; N·m/rad].

    References
    ----------
    Abbott & Okamura, IEEE Transactions on Robotics 21(5), 2005, equation (3).
    """
    friction = nonnegative("coulomb_friction", coulomb_friction, "friction takes energy, it never gives any")
    step = nonnegative("resolution", resolution, "0 means an ideal encoder")
    quantization = Exact(2 * friction / step) if step else inf
    return StiffnessLimits(Exact(spring_stiffness(damping, sample_period)), quantization)


def quantized_kelvin_voigt_friction(
    stiffness: RealLike, damping: RealLike, resolution: RealLike, sample_period: RealLike
) -> Exact:
    """f_c ≥ (|K + B/T| + |B|/T) Δ/2 for f = K x + B (x(k) − x(k−1))/T behind an encoder.

    For B ≥ 0 that is (K + 2B/T) Δ/2, for −K T ≤ B ≤ 0 it is K Δ/2, and in both
    cases it is necessary too.  For B < −K T it is (2|B|/T − K) Δ/2 and only
    sufficient: crossing one edge to and fro shows that K Δ/2 is necessary.
    It comes beside b ≥ K T/2 + |B|, for sustained contact, without delay; for
    B ≥ 0 it covers contact made and broken too (`damped_wall_friction`).

    Parameters
    ----------
    stiffness
        K ≥ 0 [N/m; N·m/rad].
    damping
        B of the environment, of either sign [N·s/m; N·m·s/rad].
    resolution
        Δ ≥ 0 at the handle [m; rad].
    sample_period
        T > 0 [s].

    Returns
    -------
    Exact
        Coulomb friction with which the encoder costs nothing [N; N·m].

    Notes
    -----
    Derived for this project.  The encoder reads x − Δ/2 − e with |e| ≤ Δ/2, so
    f = H(x − Δ/2) − H e.  The first part is the ideal loop; the second is at
    most ‖h‖₁ Δ/2, h = (K + B/T, −B/T), and f_c |Δx| pays for it.  Necessary:
    a tiny step over one edge and back gains Δ times the force going out less
    the force coming in, K + 2B/T when made every sample, K after a rest.
    """
    k = nonnegative("stiffness", stiffness, NEGATIVE_SPRING)
    step = nonnegative("resolution", resolution, "0 means an ideal encoder")
    t = positive("sample_period", sample_period, NO_CLOCK)
    rate = number("damping", damping) / t
    return Exact((abs(k + rate) + abs(rate)) * step / 2)


def damped_wall_damping(
    stiffness: RealLike, damping: RealLike, sample_period: RealLike, delay_samples: int = 0
) -> Exact:
    """b ≥ (2d + 1) K T/2 + |B| for a damped wall with contact made and broken, clamped or not.

    For every estimate of velocity whose weights are ≥ 0 and sum to 1: backward
    difference, window, one-pole filter.  With the backward difference, without
    delay, it is necessary too (clamped: for K > 0), for then the linear criterion
    in sustained contact asks for as much.

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


def damped_wall_friction(
    stiffness: RealLike, damping: RealLike, resolution: RealLike, memory: RealLike
) -> Exact:
    """f_c ≥ (K/2 + |B|/t_v) Δ beside `damped_wall_damping`, for an encoder of resolution Δ.

    For B ≥ 0 with the backward difference, without delay, it is necessary too
    (clamped: for K > 0) and is `quantized_kelvin_voigt_friction`.

    Parameters
    ----------
    stiffness
        K ≥ 0 [N/m; N·m/rad].
    damping
        B, of either sign [N·s/m; N·m·s/rad].
    resolution
        Δ ≥ 0 at the handle [m; rad].
    memory
        t_v > 0 of the velocity estimate [s]: T of the backward difference, N T of
        a window of N samples, T + τ of a one-pole filter.

    Returns
    -------
    Exact
        Coulomb friction that is enough [N; N·m].

    Notes
    -----
    Derived for this project; the proof is in the documentation.
    """
    k = nonnegative("stiffness", stiffness, NEGATIVE_SPRING)
    step = nonnegative("resolution", resolution, "0 means an ideal encoder")
    span = positive("memory", memory, "an estimate of velocity spans some time")
    return Exact((k / 2 + abs(number("damping", damping)) / span) * step)
