"""How light a virtual body may be before a hand makes the sampled display unstable.

A spring-damper hand k, c holds still; the display reads its force, steps the body M, B, K
and moves with the body's velocity (`loop.admittance`).  With γ = c T, less k T²/2 for a
sensor that reads the mean, δ = B T, κ = K T² and η = k T² the poles are the roots of

    implicit   (M + δ + κ) z² − (2 M + δ − γ − η) z + M − γ
    explicit   M z³ − (2 M − δ) z² + (M + γ − δ + κ + η) z − γ

and no mode grows for

    implicit   M > (η − κ)/4 + (γ − δ)/2,   if γ + δ + κ ≥ 0
    explicit   M > |γ|,   M > (2 δ − 2 γ − κ − η)/4,   M (γ + δ − κ − η) > γ (γ + δ)

by Jury's conditions; derived for this project.
"""

from __future__ import annotations

from fractions import Fraction
from math import inf
from typing import TYPE_CHECKING

from zwidth.model.environment.bodies import INTEGRATIONS, Integration
from zwidth.passivity.formulas.hypotheses import NEGATIVE_SPRING, NO_CLOCK, nonnegative, positive
from zwidth.quantity.exact import Exact, RealLike
from zwidth.quantity.parameter import one_of

if TYPE_CHECKING:
    from zwidth.loop.admittance import Sensor

_NO_SOURCE = "a damper that drives is no damper"


def stable_virtual_masses(
    stiffness: RealLike,
    damping: RealLike,
    sample_period: RealLike,
    *,
    body_damping: RealLike = 0,
    body_stiffness: RealLike = 0,
    integration: Integration = "implicit",
    sensor: Sensor = "mean",
) -> tuple[Exact, Exact | float] | None:
    """Between which masses a virtual body is stable in this hand, on a display of admittance.

    Implicit, with a point sensor, ``M > (k − K) T²/4 + (c − B) T/2``.

    Parameters
    ----------
    stiffness, damping
        k > 0 [N/m] and c ≥ 0 [N·s/m] of the hand, which holds still.
    sample_period
        T > 0 [s].
    body_damping, body_stiffness
        B ≥ 0 [N·s/m] and K ≥ 0 [N/m] of the body.
    integration
        Of the body, "implicit" or "explicit", see `zwidth.simulation.VirtualBody`.
    sensor
        "mean" or "point", see `zwidth.simulation.simulate_admittance`.

    Returns
    -------
    tuple or None
        Lightest and heaviest [kg], the heaviest usually inf: strictly between them no mode grows, outside one
        does.  None where one grows whatever the mass.
    """
    t = positive("sample_period", sample_period, NO_CLOCK)
    eta = positive("stiffness", stiffness, "a hand without a spring is a force; nothing oscillates") * t * t
    gamma = nonnegative("damping", damping, _NO_SOURCE) * t
    delta = nonnegative("body_damping", body_damping, _NO_SOURCE) * t
    kappa = nonnegative("body_stiffness", body_stiffness, NEGATIVE_SPRING) * t * t
    if one_of("sensor", sensor, "mean", "point") == "mean":
        gamma -= eta / 2
    if one_of("integration", integration, *INTEGRATIONS) == "explicit":
        return _explicit(gamma, delta, kappa + eta)
    if gamma + delta + kappa < 0:
        return None
    return Exact(max((eta - kappa) / 4 + (gamma - delta) / 2, Fraction(0))), inf


def _explicit(gamma: Fraction, delta: Fraction, spring: Fraction) -> tuple[Exact, Exact | float] | None:
    low = max(abs(gamma), (2 * delta - 2 * gamma - spring) / 4)
    rest, need = gamma + delta - spring, gamma * (gamma + delta)
    if rest > 0:
        return Exact(max(low, need / rest)), inf
    if rest == 0:
        return None if need >= 0 else (Exact(low), inf)
    high = need / rest
    return (Exact(low), Exact(high)) if low < high else None
