"""Where the required damping comes from, and which mechanism binds.

At the tightest frequency the requirement is split into what holding the force costs a spring of the law's
static stiffness, K T/2, what the law's own dynamics add or take away (virtual damping, its estimator,
viscoelasticity), and what the delay adds.  Coulomb friction has its own account: K Δ/2 and more.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction
from math import inf

from zwidth.model.environment.environment import Environment
from zwidth.model.environment.wall import wall_of
from zwidth.passivity.criterion_choice import Decision
from zwidth.passivity.linear.criterion import LinearRefutation, frequency, tightest

SAMPLING = "sampling against viscous damping"
DELAY = "delay against viscous damping"
VIRTUAL_DAMPING = "virtual damping against viscous damping"
DYNAMICS = "environment dynamics against viscous damping"
QUANTIZATION = "quantization against Coulomb friction"
UNSTABLE = "unstable environment"
MARGINAL = "marginally stable environment, for which no damping is enough"
NEGATIVE = "negative static stiffness"
CONTACT = "contact made and broken"
"""The criterion holds while the hand stays inside, and a motion that touches and leaves gains."""

LIMITS = (SAMPLING, DELAY, VIRTUAL_DAMPING, DYNAMICS, QUANTIZATION, UNSTABLE, NEGATIVE, CONTACT, MARGINAL)
"""Whatever may bind."""


@dataclass(frozen=True)
class Budget:
    """Leaks against dissipation at the tightest frequency.

    `hold`, `dynamics`, `delay` sum to `required`, all [N·s/m; N·m·s/rad];
    `friction_required` is what certainly covers the encoder [N; N·m].
    """

    frequency: float
    hold: float
    dynamics: float
    delay: float
    required: float
    damping: float
    friction_required: float | None
    coulomb_friction: float


def budget(decision: Decision) -> Budget:
    """The account of one loop."""
    loop = decision.loop
    need, cosine = tightest(loop)
    undelayed = replace(loop, whole_delay=0, part_delay=Fraction(0)).required_damping_at(cosine)
    static = loop.static_stiffness
    hold = float(static * loop.period / 2) if static is not None else 0.0
    friction = decision.sufficient_friction
    return Budget(
        frequency(cosine, loop.period),
        hold,
        undelayed - hold,
        need - undelayed,
        need,
        float(loop.damping),
        None if friction is None else float(friction),
        float(decision.setting.coulomb_friction),
    )


def binding_limit(decision: Decision, account: Budget, environment: Environment) -> str:
    """The mechanism that binds: what is violated, or what would be violated first."""
    viscous = decision.viscous
    if isinstance(viscous, LinearRefutation) and viscous.reason in (NEGATIVE, UNSTABLE):
        return viscous.reason
    if account.required == inf:
        return MARGINAL
    friction = account.friction_required
    friction_load = _load(friction, account.coulomb_friction) if friction is not None else inf
    if friction_load > _load(account.required, account.damping):
        return QUANTIZATION
    shares = {
        SAMPLING: account.hold,
        VIRTUAL_DAMPING if wall_of(environment) else DYNAMICS: account.dynamics,
        DELAY: account.delay,
    }
    return max(shares, key=lambda name: shares[name])


def _load(required: float, available: float) -> float:
    if required <= 0:
        return 0.0
    return required / available if available > 0 else inf
