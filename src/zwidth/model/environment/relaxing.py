"""A viscoelastic solid in continuous time: the force under a position, and the position under a force.

A viscoelastic solid in continuous time: the force under a position.

    H(s) = K + B s + Σ μᵢ ηᵢ s/(μᵢ + ηᵢ s)

    f = K x + B ẋ + Σ qᵢ,    q̇ᵢ = μᵢ ẋ − qᵢ/τᵢ,    τᵢ = ηᵢ/μᵢ

Kelvin–Voigt has no branch; Maxwell has one and K = B = 0; the standard linear and the generalized
Maxwell solid have B = 0.  After a unit step of position the force is the relaxation function

    G(t) = K + Σ μᵢ exp(−t/τᵢ)      t ≥ 0; beside it B δ(t)

and under a position that is linear from sample to sample, of slope v over a time h,

    qᵢ ← qᵢ exp(−h/τᵢ) + μᵢ v τᵢ (1 − exp(−h/τᵢ))

without error.  That is the material itself, not the law that a controller makes of it: the
discretization and the velocity filter of an environment play no part here, nor does its surface.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from zwidth.errors import InputError
from zwidth.model.environment.environment import Environment, certain
from zwidth.model.environment.viscoelastic import Branch, Solid
from zwidth.model.environment.wall import Wall
from zwidth.quantity.exact import Exact, Interval, RealLike
from zwidth.quantity.parameter import read_number
from zwidth.quantity.text import shown

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray

    Array = NDArray[np.float64]


_NONE = Exact(0)


class Elements(NamedTuple):
    """What stands side by side: spring K, dashpot B, branches (μᵢ, ηᵢ) that act; all ≥ 0, SI."""

    spring: float
    dashpot: float
    branches: tuple[tuple[float, float], ...]

    @property
    def instantaneous(self) -> float:
        """K + Σ μᵢ, the stiffness at once [N/m; N·m/rad]."""
        return self.spring + sum(mu for mu, _ in self.branches)


def elements(solid: Environment) -> Elements:
    """Springs and dashpots of a wall or a viscoelastic solid."""
    spring, dashpot, branches = _parts(solid)
    numbers = float(certain(spring, "stiffness")), float(certain(dashpot, "damping"))
    pairs = [
        (float(certain(mu, "branch stiffness")), float(certain(eta, "branch damping")))
        for mu, eta in branches
    ]
    if min(*numbers, *(eta for _, eta in pairs)) < 0:
        raise InputError(
            f"a material has no damping below 0, got {solid.describe()}: after a step it would move for ever "
            "faster"
        )
    return Elements(*numbers, tuple(pair for pair in pairs if all(pair)))


def _parts(solid: Environment) -> tuple[Exact | Interval, Exact | Interval, tuple[Branch, ...]]:
    if isinstance(solid, Wall):
        return solid.stiffness, solid.damping, ()
    if isinstance(solid, Solid):
        spring, branches = solid.prony
        return spring or _NONE, _NONE, branches
    raise InputError(
        "springs and dashpots side by side are those of a Wall, Maxwell, StandardLinearSolid or "
        f"GeneralizedMaxwell, got {type(solid).__name__}"
    )


def relaxation(solid: Environment, time: ArrayLike) -> Array:
    """G(t) = K + Σ μᵢ exp(−t/τᵢ): the force after a unit step of position at t = 0 [N/m; N·m/rad].

    Of a wall with damping, the impulse B δ(t) at t = 0 stands beside it.

    Parameters
    ----------
    solid
        A `Wall` (Kelvin–Voigt), `Maxwell`, `StandardLinearSolid` or `GeneralizedMaxwell`.
    time
        t [s]; 0 is just after the step, before it the force is 0.

    Raises
    ------
    InputError
        If the solid is another law, has an interval or a damping below 0.
    """
    import numpy as np

    spring, _, branches = elements(solid)
    t = np.asarray(time, dtype=float)
    after = np.maximum(t, 0.0)
    total = spring + sum((mu * np.exp(-after * mu / eta) for mu, eta in branches), np.zeros_like(t))
    return np.where(t >= 0.0, total, 0.0)


def force_response(
    solid: Environment | Elements, time: ArrayLike, position: ArrayLike, rest: RealLike | None = None
) -> Array:
    """The force of the material under a position that is linear between its samples [N; N·m].

    Parameters
    ----------
    solid
        As for `relaxation`.
    time
        Of the samples, increasing [s].
    position
        x at these times [m; rad].  The velocity at a sample, where it jumps, is that before it.
    rest
        Where the material was before the first sample, for ever [m; rad]; None: at the first position.
        Another value is a step at the first time; the impulse that a dashpot then adds is left out.

    Raises
    ------
    InputError
        If the solid is another law, or times and positions are no such samples.
    """
    import numpy as np

    from zwidth.model.environment.modes import decaying, samples

    spring, dashpot, branches = solid if isinstance(solid, Elements) else elements(solid)
    t, x = samples(time, position, "position")
    moved, h = np.diff(x), np.diff(t)
    total = spring * x
    if dashpot:
        total[1:] += dashpot * moved / h
    step = 0.0 if rest is None else x[0] - float(read_number(rest, "position", "rest"))
    for mu, eta in branches:
        total += mu * decaying(h, moved, mu / eta, step)
    return total


# A viscoelastic solid in continuous time: the position under a force.
#
#     1/H(s) = J0 + 1/(η s) + Σ aⱼ rⱼ/(s + rⱼ)
#
#     J(t) = J0 + t/η + Σ aⱼ (1 − exp(−rⱼ t))      the creep function, after a unit step of force
#
# −rⱼ are the zeros of H(s).  They are real and lie between its poles −1/τᵢ: going from r = 0 up,
# H(−r) falls from K, jumps from −∞ to ∞ at each 1/τᵢ and falls again, so that between two
# neighbours, and before the first where K > 0, and after the last where B > 0, there is just one.
# There aⱼ = 1/(rⱼ H'(−rⱼ)), H' being the derivative.  A solid with K > 0 comes to rest at 1/K; one with K = 0
# flows at the rate 1/η, η = B + Σ ηᵢ.  J0 = 1/(K + Σ μᵢ), 0 with a dashpot B.
#
#     Kelvin–Voigt            (1 − exp(−t K/B))/K
#     Maxwell                 1/μ + t/η
#     standard linear solid   1/μ0 − μ1/(μ0 (μ0 + μ1)) exp(−t/τ_c),   τ_c = η1 (μ0 + μ1)/(μ0 μ1)


class Compliance(NamedTuple):
    """J0 [m/N], 1/η [m/(N·s)], and the modes (rⱼ [1/s], aⱼ [m/N]) of 1/H(s)."""

    instantaneous: float
    flow: float
    modes: tuple[tuple[float, float], ...]


def compliance(solid: Environment | Elements) -> Compliance:
    """1/H(s) of a solid in partial fractions."""
    parts = solid if isinstance(solid, Elements) else elements(solid)
    if not (parts.spring or parts.dashpot or parts.branches):
        raise InputError("a solid without spring and dashpot has no creep: nothing resists the force")
    poles = _poles(parts)
    modes = tuple((r, 1.0 / (r * _slope(parts, poles, r))) for r in _zeros(parts, poles))
    viscous = parts.dashpot + sum(eta for _, eta in parts.branches)
    flow = 0.0 if parts.spring else 1.0 / viscous
    return Compliance(0.0 if parts.dashpot else 1.0 / parts.instantaneous, flow, modes)


def creep(solid: Environment, time: ArrayLike) -> Array:
    """J(t): the position after a unit step of force at t = 0 [m/N; rad/(N·m)].

    Parameters
    ----------
    solid
        A `Wall` (Kelvin–Voigt), `Maxwell`, `StandardLinearSolid` or `GeneralizedMaxwell`.
    time
        t [s]; 0 is just after the step, before it the position is 0.

    Raises
    ------
    InputError
        If the solid is another law, has an interval or a damping below 0, or resists nothing.
    """
    import numpy as np

    at_once, flow, modes = compliance(solid)
    t = np.asarray(time, dtype=float)
    after = np.maximum(t, 0.0)
    total = at_once + flow * after - sum((a * np.expm1(-r * after) for r, a in modes), np.zeros_like(t))
    return np.where(t >= 0.0, total, 0.0)


def position_response(
    solid: Environment | Elements, time: ArrayLike, force: ArrayLike, rest: RealLike | None = None
) -> Array:
    """The position of the material under a force that is linear between its samples [m; rad].

    Parameters
    ----------
    solid
        As for `creep`.
    time
        Of the samples, increasing [s].
    force
        f at these times [N; N·m].
    rest
        The force before the first sample, for ever [N; N·m]; None: the first one.  Another value is a
        step at the first time.  A solid that flows has been at its first position under no force: there
        `rest` must be 0, which is what None means then.

    Raises
    ------
    InputError
        If the solid is another law or resists nothing, or times and forces are no such samples.
    """
    import numpy as np

    from zwidth.model.environment.modes import decaying, samples

    at_once, flow, modes = compliance(solid)
    t, f = samples(time, force, "force")
    before = (0.0 if flow else float(f[0])) if rest is None else float(read_number(rest, "force", "rest"))
    if flow and before:
        raise InputError(
            f"a solid without a spring flows under {shown(before, 'N', 6)}, and was not at rest; give rest=0"
        )
    h, moved = np.diff(t), np.diff(f)
    settled = at_once + sum(a for _, a in modes)
    total = settled * f
    if flow:
        total[1:] += flow * np.cumsum(h * (f[1:] + f[:-1]) / 2)
    for r, a in modes:
        total -= a * decaying(h, moved, r, f[0] - before)
    return total


_Pole = tuple[float, float]
"""(1/τ [1/s], μ [N/m]) of the branches with one relaxation time, together."""

_ONE = 1e-12
"""Of a rate: those that differ by less are one, for between them no double may be left for the zero of H."""


MOST_HALVINGS = 2200
"""All the doubles between 0 and a rate are halved so often at the most."""


def _poles(parts: Elements) -> list[_Pole]:
    poles: list[_Pole] = []
    for rate, mu in sorted((mu / eta, mu) for mu, eta in parts.branches):
        if poles and rate - poles[-1][0] <= _ONE * rate:
            poles[-1] = (poles[-1][0], poles[-1][1] + mu)
        else:
            poles.append((rate, mu))
    return poles


def _slope(parts: Elements, poles: list[_Pole], r: float) -> float:
    """H'(−r) = B + Σ μᵢ λᵢ/(λᵢ − r)², λᵢ = 1/τᵢ."""
    return parts.dashpot + sum(mu * rate / (rate - r) ** 2 for rate, mu in poles)


def _zeros(parts: Elements, poles: list[_Pole]) -> list[float]:
    """Where H(−r) = 0 for r > 0, one in each of the intervals that have one."""
    ends: list[_Pole | None] = [*poles, None] if parts.dashpot else [*poles]
    starts: list[_Pole | None] = [None, *poles] if parts.spring else [*poles]
    if not parts.spring:
        ends = ends[1:]
    return [_zero(parts, poles, low, high) for low, high in zip(starts, ends, strict=False)]


def _zero(parts: Elements, poles: list[_Pole], low: _Pole | None, high: _Pole | None) -> float:
    """The zero of H(−r) times its distance from the poles at both ends, which has the same zero."""
    from scipy.optimize import brentq

    others = [pole for pole in poles if pole not in (low, high)]

    def scaled(r: float) -> float:
        rest = parts.spring - parts.dashpot * r - sum(mu * r / (rate - r) for rate, mu in others)
        above, below = (r - low[0] if low else 1.0), (high[0] - r if high else 1.0)
        total = rest * above * below
        if low:
            total += r * low[1] * below
        if high:
            total -= r * high[1] * above
        return float(total)

    start = low[0] if low else 0.0
    if high:
        stop = high[0]
    else:  # from here on B r is more than K + Σ μᵢ r/(r − λᵢ)
        springs = parts.instantaneous
        stop = start + springs / parts.dashpot + (springs * start / parts.dashpot) ** 0.5
        stop *= 1.0 + 1e-12
    return float(brentq(scaled, start, stop, xtol=1e-300, rtol=1e-15, maxiter=MOST_HALVINGS))
