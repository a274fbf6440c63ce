"""Energy bounding: the force changes by a stiffness times the move, and that stiffness is bounded.

    f_k = f_{k−1} + β_k Δx_k,   β_k between 2b/T and −2b/T − 2 f_{k−1}/Δx_k
    that is                     |f_k| ≤ |f_{k−1} + (2b/T) Δx_k|

Kim & Ryu (2010) published the form; their constants are not known here, and these are
derived for this project.  With c = 2b/T the energy S = f²/(2c) = f² T/(4b) is what the next
move can take out at most, and

    S_k ≤ (f_{k−1} + c Δx)²/(2c) = S_{k−1} + f_{k−1} Δx + (b/T) Δx²

is the bound: what is stored grows by no more than what came in.  It is the tightest for
this S, and no law that knows f alone has a smaller S.  Energy bounding is force bounding
that keeps no credit: E is set to f² T/(4b) in each sample.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from zwidth.model.rendering.reading import damping_per_sample, half_step
from zwidth.model.rendering.rendering_law import LoopContext, RenderingLaw
from zwidth.model.rendering.theorem import Theorem
from zwidth.native.compiled import Array, compiled

ENERGY_BOUNDING = 22.0

_STIFFEST, _HALF_STEP = range(2)
_BEFORE = 0


@dataclass(frozen=True, kw_only=True)
class EnergyBounding(RenderingLaw):
    """``|f_k| ≤ |f_{k−1} + (2b/T) Δx_k|``: the wall is nowhere stiffer than the device can pay.

    Proved: no motion of any hand takes energy out, whatever the environment.  Hypotheses: the device
    takes at least b; an encoder without counts; no delay, regular samples, no law behind this one, an
    amplifier without lag.  With counts it fails where f_c < b Δ/(2T): docs, "Laws that bound the force".

    Raises
    ------
    InputError
        When it is simulated, if the device has no damping.
    """

    code: ClassVar[float] = ENERGY_BOUNDING
    state_size: ClassVar[int] = 1

    def numbers(self, at: LoopContext) -> list[float]:
        """As the step reads them.

        Raises
        ------
        InputError
            If the device has no damping.
        """
        return [2 * damping_per_sample(at, "energy bounding"), half_step(at)]

    def theorem(self, at: LoopContext) -> Theorem:
        """Half a step of the converter is kept below the bound, and the law is told what was applied."""
        return Theorem(
            statement="energy bounding: what the next move can take out grows by no more than what came in",
            counts_force_steps=True,
            counts_force_limit=True,
        )

    def describe(self, motion: str = "linear") -> str:
        """The law in a few words."""
        return "energy bounding"


@compiled
def step(p: Array, i: int, s: Array, j: int, x: float, force: float, applied: float) -> float:
    """One sample; p from i and s from j on are this law's, `applied` is the force that was held."""
    moved = x - s[j + _BEFORE]
    s[j + _BEFORE] = x
    room = max(abs(applied + p[i + _STIFFEST] * moved) - p[i + _HALF_STEP], 0.0)
    bounded: float = min(max(force, -room), room)
    return bounded
