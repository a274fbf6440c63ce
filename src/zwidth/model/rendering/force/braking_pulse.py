"""A pulse that stops the device at the first sample inside the wall.

    f ← f + min(m v̂/T, F)    at the first sample with x > 0 after one with x ≤ 0

Held for T it takes the momentum m v̂ out, which the wall's spring would give back.  Braking
pulses: Salcudean & Vlaar (1997); this size, the one that stops m in one sample, is derived
for this project.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from zwidth.model.rendering.defaults import given_or_known, surface
from zwidth.model.rendering.rendering_law import LoopContext, RenderingLaw
from zwidth.model.rendering.velocity.estimate import estimate, estimated, packed
from zwidth.model.rendering.velocity.estimator import Estimator
from zwidth.native.compiled import Array, compiled
from zwidth.quantity.exact import Exact
from zwidth.quantity.parameter import CertainOrNone, Reads, parameter

BRAKING_PULSE = 12.0

_PER_SPEED, _LIMIT, _ESTIMATOR = range(3)
_INSIDE, _REMEMBERED = range(2)

UNLIMITED = 1e300


@dataclass(frozen=True)
class BrakingPulse(RenderingLaw):
    """One sample of force at entry, ``f ← f + min(m v̂/T, F)``.

    Parameters
    ----------
    mass
        m > 0, what is to be stopped [kg; kg·m²]; None: the device's.
    limit
        F > 0, the largest pulse [N; N·m]; None: the device's force limit, none where unknown.
    velocity
        `AdaptiveWindow(…)` (default), `TickTime()` or `Kalman(…)`.

    Raises
    ------
    InputError
        If a number is not positive or velocity is none of these; later, if the mass is not
        known, or the environment has no surface.
    """

    code: ClassVar[float] = BRAKING_PULSE

    mass: CertainOrNone = parameter(
        "mass",
        None,
        kept=Exact,
        bound="> 0",
        why="it is what the pulse stops",
        meaning="what is to be stopped, by default the device's",
    )
    limit: CertainOrNone = parameter(
        "force",
        None,
        kept=Exact,
        bound="> 0",
        why="it is the largest pulse",
        meaning="the largest pulse, by default the force limit",
    )
    velocity: Reads[Estimator, Estimator | None] = estimated()

    @property
    def state_size(self) -> int:  # type: ignore[override]  # the estimator's among them, known once it is chosen
        """Whether the hand was inside, and those of the estimator."""
        return _REMEMBERED + self.velocity.state_size

    def numbers(self, at: LoopContext) -> list[float]:
        """m/T, F, the estimator's."""
        surface(at, "a braking pulse")
        mass = given_or_known(self.mass, at, "mass", "mass")
        unknown = self.limit is None and at.device.force_limit is None
        limit = UNLIMITED if unknown else given_or_known(self.limit, at, "force_limit", "limit")
        return [mass / at.period, limit, *packed(self.velocity, at)]

    def initial_state(self, reading: float) -> list[float]:
        """A hand that is inside has entered long ago."""
        return [float(reading > 0.0), *self.velocity.initial_state(reading)]

    def describe(self, motion: str = "linear") -> str:
        """The law with its numbers, in a few words."""
        what = self.with_unit("mass", motion) or "the device"
        most = f", at most {self.with_unit('limit', motion)}" if self.limit is not None else ""
        return f"braking pulse that stops {what}{most} on {self.velocity.describe(motion)}"


@compiled
def step(p: Array, i: int, s: Array, j: int, x: float, force: float, applied: float) -> float:
    """One sample; p from i and s from j on are this law's."""
    velocity = estimate(p, i + _ESTIMATOR, s, j + _REMEMBERED, x)
    before = s[j + _INSIDE]
    s[j + _INSIDE] = 1.0 if x > 0.0 else 0.0
    if x > 0.0 and before == 0.0 and velocity > 0.0:
        force += min(p[i + _PER_SPEED] * velocity, p[i + _LIMIT])
    return force
