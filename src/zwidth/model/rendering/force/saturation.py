"""A force that is never larger than a limit: before laws that remember it, or below the motor's own.

    f ← clamp(f, −F … F)

The amplifier limits the force anyway, after all laws; a law that comes before it and remembers
what it gave, such as `SlewLimit`, then remembers a force that never was.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from zwidth.model.rendering.defaults import given_or_known
from zwidth.model.rendering.rendering_law import LoopContext, RenderingLaw
from zwidth.native.compiled import Array, compiled
from zwidth.quantity.exact import Exact
from zwidth.quantity.parameter import CertainOrNone, parameter

SATURATION = 16.0


@dataclass(frozen=True)
class Saturation(RenderingLaw):
    """``f ← clamp(f, ±F)``.

    Parameters
    ----------
    limit
        F > 0 [N; N·m]; None: the device's force limit.

    Raises
    ------
    InputError
        If F is not positive; later, if it is not given and the device has no force limit.
    """

    code: ClassVar[float] = SATURATION
    state_size: ClassVar[int] = 0

    limit: CertainOrNone = parameter(
        "force",
        None,
        kept=Exact,
        bound="> 0",
        why="without force nothing is rendered",
        meaning="F, by default the force limit",
    )

    def numbers(self, at: LoopContext) -> list[float]:
        """F."""
        return [given_or_known(self.limit, at, "force_limit", "limit")]

    def initial_state(self, reading: float) -> list[float]:
        """Nothing."""
        return []

    def describe(self, motion: str = "linear") -> str:
        """The law with its numbers, in a few words."""
        return f"saturation at {self.with_unit('limit', motion) or 'the force limit'}"


@compiled
def step(p: Array, i: int, s: Array, j: int, x: float, force: float, applied: float) -> float:
    """One sample; p from i on is this law's."""
    return min(max(force, -p[i]), p[i])
