"""Friction inside the wall that depends on the way, not on the speed: a spring that slips.

    s ← clamp(s + k Δu, −h … h),   f ← f + s    inside,   s = 0 outside,   u = max(x, 0)

That rate-independent hysteresis makes a wall stiffer to render is from Goldfarb & Wang
(1999); this law, the elastic–plastic element of Prandtl, and its size are derived for this
project.  A cycle of depth D ≫ h/k takes 2 h D out.  The hold leaks ½ K (v T)² a sample,
½ K v T D on the way in and again on the way out, so that

    h ≥ ½ K v_max T

pays for it up to the speed v_max.  A velocity is not needed: no noise of the encoder is
amplified, only a step of k Δ is felt.

What is kept is not s but z = u − s/k, where the spring would be relaxed: it moves only while
the spring slips, so that a hand that goes to and fro finds the same forces again, to the bit.
"""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from typing import ClassVar

from zwidth.errors import InputError
from zwidth.model.rendering.defaults import stiffness as stiffness_of
from zwidth.model.rendering.rendering_law import LoopContext, RenderingLaw
from zwidth.native.compiled import Array, compiled
from zwidth.quantity.exact import Exact
from zwidth.quantity.parameter import CertainOrNone, flag, parameter

HYSTERESIS = 11.0

_FORCE, _STIFFNESS, _SURFACE, _CLAMPED = range(4)
_RELAXED = 0


@dataclass(frozen=True)
class Hysteresis(RenderingLaw):
    """Rate-independent hysteresis, ``s ← clamp(s + k Δu, ±h)``, ``f ← f + s`` inside.

    Parameters
    ----------
    force
        h > 0, where the spring slips [N; N·m]; None: ½ K v_max T, of the environment's K.
    stiffness
        k > 0 [N/m; N·m/rad]; None: K, so that it slips after half the way of a sample at v_max.
    fastest
        v_max > 0 [m/s; rad/s]; needed where `force` is not given, and only there.
    clamped
        True: the sum never pulls, ``f ← max(0, f + s)``.  Default False: a hand that leaves
        is held back by h just before the surface.

    Raises
    ------
    InputError
        If a number is not positive, or both or none of force and fastest are given; later, if
        K is needed and the environment has none.
    """

    code: ClassVar[float] = HYSTERESIS
    state_size: ClassVar[int] = 1

    force: CertainOrNone = parameter(
        "force",
        None,
        kept=Exact,
        bound="> 0",
        why="it is the force at which the spring slips",
        meaning="h, at which the spring slips; this or fastest is needed",
    )
    stiffness: CertainOrNone = parameter(
        "stiffness",
        None,
        kept=Exact,
        bound="> 0",
        why="it is the spring that slips",
        meaning="k of that spring, by default the environment's",
    )
    _: KW_ONLY
    fastest: CertainOrNone = parameter(
        "speed",
        None,
        kept=Exact,
        bound="> 0",
        why="it is the speed up to which the hysteresis pays for the hold",
        meaning="speed up to which it pays for the hold",
    )
    clamped: bool = flag("for a sum that never pulls", False)

    def __post_init__(self) -> None:
        if (self.force is None) == (self.fastest is None):
            raise InputError(
                f"give either force [N] or fastest [m/s], got {'neither' if self.force is None else 'both'}: "
                "the width h is ½ K v_max T for a hand that is never faster than v_max"
            )
        super().__post_init__()

    def numbers(self, at: LoopContext) -> list[float]:
        """h, k, whether there is a surface, whether it is clamped."""
        if self.force is None:
            assert self.fastest is not None
            k = stiffness_of(at, "force was not given and is otherwise ½ K v_max T")
            width = k * float(self.fastest) * at.period / 2
        else:
            width = float(self.force)
        spring = (
            stiffness_of(at, "stiffness was not given and is otherwise K")
            if self.stiffness is None
            else float(self.stiffness)
        )
        return [width, spring, float(at.environment.unilateral), float(self.clamped)]

    def initial_state(self, reading: float) -> list[float]:
        """The spring relaxed where the hand is."""
        return [reading]

    def describe(self, motion: str = "linear") -> str:
        """The law with its numbers, in a few words."""
        force, stiffness, fastest = (
            self.with_unit(name, motion) for name in ("force", "stiffness", "fastest")
        )
        width = f"±{force}" if force else f"the width for {fastest}"
        spring = f", spring of {stiffness}" if stiffness else ""
        return f"hysteresis of {width}{spring}{', never pulls' if self.clamped else ''}"


@compiled
def step(p: Array, i: int, s: Array, j: int, x: float, force: float, applied: float) -> float:
    """One sample; p from i and s from j on are this law's."""
    outside = p[i + _SURFACE] > 0.0 and x <= 0.0
    if outside:
        s[j + _RELAXED] = 0.0
        return force
    width, stiffness = p[i + _FORCE], p[i + _STIFFNESS]
    s[j + _RELAXED] = min(max(s[j + _RELAXED], x - width / stiffness), x + width / stiffness)
    force += min(max(stiffness * (x - s[j + _RELAXED]), -width), width)
    return max(force, 0.0) if p[i + _CLAMPED] > 0.0 else force
