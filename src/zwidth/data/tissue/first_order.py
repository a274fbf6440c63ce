"""The standard linear solid as a recursion in samples, and back.

    F_t = −p F_{t−1} + b0 u_t + b1 u_{t−1}

    "bilinear"   p = (μ1 T − 2η1)/D,   b0, b1 = (μ0 μ1 T ± 2η1 (μ0 + μ1))/D,                    D = μ1 T + 2η1
    "backward"   p = −η1/D,   b0 = (μ0 μ1 T + η1 (μ0 + μ1))/D,   b1 = −η1 (μ0 + μ1)/D,          D = μ1 T + η1
    "ramp"       p = −e,   b0 = μ0 + μ1 φ,   b1 = −(μ0 e + μ1 φ),   e = exp(−T/τ), φ = (1 − e) τ/T, τ = η1/μ1

The first two are what a controller makes of the solid by Tustin's rule and by backward Euler; the third is
the material itself under a position that is linear from sample to sample, and is the one for measured data.
Back, with h = μ0 + μ1 the stiffness at once:

    μ0 = (b0 + b1)/(1 + p)
    "bilinear"   h = (b0 − b1)/(1 − p),   τ = T (1 − p)/(2 (1 + p))
    "backward"   h = b1/p,                τ = −T p/(1 + p)
    "ramp"       μ1 = (b0 − μ0)/φ,        τ = −T/ln(−p)

"A passivity criterion for real-time haptic simulation of viscoelastic soft tissues", appendix 2, prints the
bilinear recursion times (1 + z⁻¹): five parameters for three.  `five_parameters` is that form, with its
slip corrected.
"""

from __future__ import annotations

from fractions import Fraction
from math import exp, expm1, log
from typing import Literal, NamedTuple, TypeVar, get_args

from zwidth.errors import InputError
from zwidth.native.compiled import Array

Rule = Literal["ramp", "bilinear", "backward"]
RULES: tuple[str, ...] = get_args(Rule)

Number = TypeVar("Number", float, Fraction, Array)


class Solid(NamedTuple):
    """μ0, μ1 [N/m; N·m/rad] and η1 [N·s/m; N·m·s/rad]."""

    stiffness: float
    branch_stiffness: float
    branch_damping: float


def as_rule(rule: object) -> Rule:
    if rule not in RULES:
        raise InputError(f'rule is "ramp", "bilinear" or "backward", got {rule!r}')
    return rule  # type: ignore[return-value]


def coefficients(
    mu0: Number, mu1: Number, eta1: Number, period: Number, rule: Rule = "ramp"
) -> tuple[Number, Number, Number]:
    """(p, b0, b1) of a solid; exact for fractions, but for "ramp".

    Parameters
    ----------
    mu0, mu1, eta1
        The solid; μ1 and η1 > 0.
    period
        T [s].
    rule
        "ramp", "bilinear" or "backward".
    """
    if rule == "bilinear":
        d = mu1 * period + 2 * eta1
        viscous = 2 * eta1 * (mu0 + mu1)
        elastic = mu0 * mu1 * period
        return (mu1 * period - 2 * eta1) / d, (elastic + viscous) / d, (elastic - viscous) / d
    if rule == "backward":
        d = mu1 * period + eta1
        viscous = eta1 * (mu0 + mu1)
        return -eta1 / d, (mu0 * mu1 * period + viscous) / d, -viscous / d
    x = float(period * mu1 / eta1)
    e, share = exp(-x), -expm1(-x) / x
    return -e, mu0 + mu1 * share, -(mu0 * e + mu1 * share)  # type: ignore[return-value]


def solid_of(
    p: Number, b0: Number, b1: Number, period: Number, rule: Rule = "ramp"
) -> tuple[Number, Number, Number]:
    """(μ0, μ1, η1) of a recursion: `coefficients` inverted.

    Parameters
    ----------
    p, b0, b1
        The recursion; −1 < p < 1 for "bilinear", −1 < p < 0 else.
    period
        T [s].
    rule
        "ramp", "bilinear" or "backward".

    Raises
    ------
    InputError
        If p is that of no solid.
    """
    if not -1 < p < (1 if rule == "bilinear" else 0):
        bound = 1 if rule == "bilinear" else 0
        raise InputError(
            f"p is > −1 and < {bound} for a solid that relaxes, got {float(p):g}: "
            "the recursion is that of another material, or the estimate has not come to rest"
        )
    mu0 = (b0 + b1) / (1 + p)
    if rule == "bilinear":
        mu1 = (b0 - b1) / (1 - p) - mu0
        return mu0, mu1, mu1 * period * (1 - p) / (2 * (1 + p))
    if rule == "backward":
        mu1 = b1 / p - mu0
        return mu0, mu1, -mu1 * period * p / (1 + p)
    x = -log(-p)
    mu1 = (b0 - mu0) * x / -expm1(-x)  # type: ignore[assignment]
    return mu0, mu1, mu1 * period / x  # type: ignore[return-value]


def five_parameters(
    mu0: Number, mu1: Number, eta1: Number, period: Number, extra: Number | int = 1
) -> tuple[Number, Number, Number, Number, Number]:
    """(a1, a2, b1, b2, b3) of the printed form: the bilinear recursion times (1 + c z⁻¹).

    Parameters
    ----------
    mu0, mu1, eta1
        The solid.
    period
        T [s].
    extra
        c; the paper has 1.  Every c describes the same motion: that is what cannot be identified.
    """
    p, b0, b1 = coefficients(mu0, mu1, eta1, period, "bilinear")
    return p + extra, p * extra, b0, b1 + extra * b0, extra * b1


def solid_of_five(a1: Number, b1: Number, b3: Number, period: Number) -> tuple[Number, Number, Number]:
    """(μ0, μ1, η1) by equation (32) of the paper, right where the common factor is (1 + z⁻¹) and only there.

    Parameters
    ----------
    a1, b1, b3
        Of the printed form.
    period
        T [s].
    """
    viscous = a1 * b1 - b1 - b3
    return (b1 + b3) / a1, 2 * viscous / (a1 * (2 - a1)), viscous * period / (a1 * a1)
