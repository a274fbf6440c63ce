"""A viscoelastic solid in continuous time: the force under a position.

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
from zwidth.model.environment.viscoelastic import Branch, GeneralizedMaxwell, Maxwell, StandardLinearSolid
from zwidth.model.environment.wall import Wall
from zwidth.quantity.exact import Exact, Interval

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
    if isinstance(solid, Maxwell):
        return _NONE, _NONE, ((solid.stiffness, solid.damping),)
    if isinstance(solid, StandardLinearSolid):
        return solid.stiffness, _NONE, ((solid.branch_stiffness, solid.branch_damping),)
    if isinstance(solid, GeneralizedMaxwell):
        return solid.stiffness, _NONE, solid.branches
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
    solid: Environment | Elements, time: ArrayLike, position: ArrayLike, rest: float | None = None
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
    step = 0.0 if rest is None else x[0] - rest
    for mu, eta in branches:
        total += mu * decaying(h, moved, mu / eta, step)
    return total
