"""A damper behind any environment, fed by a velocity estimator that is not linear.

    f ← f + B v̂    if x > 0     (everywhere, where the environment has no surface)

The estimator runs outside too, so that it knows the velocity at the first sample inside.
`Wall(damping=…)` is the same with a linear estimator, and has certificates.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from zwidth.model.rendering.rendering_law import LoopContext, RenderingLaw
from zwidth.model.rendering.velocity.estimate import estimate, estimated, packed
from zwidth.model.rendering.velocity.estimator import Estimator
from zwidth.native.compiled import Array, compiled
from zwidth.quantity.exact import Exact
from zwidth.quantity.parameter import Certain, Reads, flag, parameter

DAMPER = 10.0

_DAMPING, _SURFACE, _CLAMPED, _ESTIMATOR = range(4)


@dataclass(frozen=True)
class Damper(RenderingLaw):
    """Virtual damping on an estimated velocity, ``f ← f + B v̂ if x > 0``.

    Parameters
    ----------
    damping
        B ≥ 0 [N·s/m; N·m·s/rad].
    velocity
        `AdaptiveWindow(…)` (default), `TickTime()` or `Kalman(…)`.
    clamped
        True: the sum never pulls, ``f ← max(0, f + B v̂)``.  Default False.

    Raises
    ------
    InputError
        If B < 0, or one of the others is none of these.
    """

    code: ClassVar[float] = DAMPER

    damping: Certain = parameter(
        "virtual_damping",
        kept=Exact,
        bound="≥ 0",
        why="a negative damper drives the hand",
        meaning="B of the damper",
    )
    velocity: Reads[Estimator, Estimator | None] = estimated()
    clamped: bool = flag("for a sum that never pulls", False)

    @property
    def state_size(self) -> int:  # type: ignore[override]  # it is the estimator's, known once it is chosen
        """Those of the estimator."""
        return self.velocity.state_size

    def numbers(self, at: LoopContext) -> list[float]:
        """B, whether there is a surface, whether it is clamped, the estimator's."""
        gates = [float(at.environment.unilateral), float(self.clamped)]
        return [float(self.damping), *gates, *packed(self.velocity, at)]

    def initial_state(self, reading: float) -> list[float]:
        """As the estimator."""
        return self.velocity.initial_state(reading)

    def describe(self, motion: str = "linear") -> str:
        """The law with its numbers, in a few words."""
        never = ", never pulls" if self.clamped else ""
        return f"damper of {self.with_unit('damping', motion)} on {self.velocity.describe(motion)}{never}"


@compiled
def step(p: Array, i: int, s: Array, j: int, x: float, force: float, applied: float) -> float:
    """One sample; p from i and s from j on are this law's."""
    velocity = estimate(p, i + _ESTIMATOR, s, j, x)
    if p[i + _SURFACE] > 0.0 and x <= 0.0:
        return force
    force += p[i + _DAMPING] * velocity
    return max(force, 0.0) if p[i + _CLAMPED] > 0.0 else force
