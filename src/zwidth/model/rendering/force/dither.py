"""A small force to and fro, so that the steps of the converter average out.

    alternating   f ← f + a (−1)ᵏ
    random        f ← f + a (2 r_k/M − 1),   r_k = 16807 r_{k−1} mod M,   M = 2³¹ − 1

With a = ΔF/4 the mean of two alternating samples has steps of ΔF/2; random numbers, uniform
over one step, a = ΔF/2, make the mean error 0 at any force (Schuchman 1964).  The generator is
that of Park & Miller (1988), exact in doubles: the same seed gives the same forces everywhere.
It acts inside only, and runs on outside.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal

from zwidth.errors import InputError
from zwidth.model.rendering.defaults import given_or_known
from zwidth.model.rendering.rendering_law import LoopContext, RenderingLaw
from zwidth.native.compiled import Array, compiled
from zwidth.quantity.exact import Exact
from zwidth.quantity.parameter import PLAIN, CertainOrNone, Count, parameter, word

DITHER = 15.0

_AMPLITUDE, _RANDOM, _SURFACE = range(3)

MODULUS, _FACTOR = 2147483647.0, 16807.0


def _seed(seed: Exact) -> int:
    if seed.fraction.denominator != 1 or seed >= int(MODULUS):
        raise InputError(f"seed is a whole number from 1 to {int(MODULUS) - 1}, got {seed:g}")
    return int(seed)


@dataclass(frozen=True)
class Dither(RenderingLaw):
    """A force of amplitude a that changes from sample to sample, where the environment acts.

    Parameters
    ----------
    amplitude
        a > 0 [N; N·m]; None: ΔF/4 of the device's converter for "alternating", ΔF/2 for "random".
    kind
        "alternating" or "random".
    seed
        Of "random", a whole number from 1 to 2³¹ − 2.

    Raises
    ------
    InputError
        If one of them is not such a number or word; later, if the amplitude is not given and the
        device's converter is not known.
    """

    code: ClassVar[float] = DITHER
    state_size: ClassVar[int] = 1

    amplitude: CertainOrNone = parameter(
        "force",
        None,
        kept=Exact,
        bound="> 0",
        why="without one there is no dither",
        meaning="a, by default a part of a converter step",
    )
    kind: Literal["alternating", "random"] = word("alternating", "random")
    seed: Count = parameter(
        PLAIN,
        1,
        kept=_seed,
        bound="> 0",
        why="0 would stay 0 for ever",
        meaning="of the random one, a whole number",
    )

    def numbers(self, at: LoopContext) -> list[float]:
        """a, whether it is random, whether there is a surface."""
        share = 1.0 if self.amplitude is not None else 0.5 if self.kind == "random" else 0.25
        amplitude = share * given_or_known(self.amplitude, at, "force_resolution", "amplitude")
        return [amplitude, float(self.kind == "random"), float(at.environment.unilateral)]

    def initial_state(self, reading: float) -> list[float]:
        """+1, or the seed."""
        return [float(self.seed) if self.kind == "random" else 1.0]

    def describe(self, motion: str = "linear") -> str:
        """The law with its numbers, in a few words."""
        return f"{self.kind} dither of {self.with_unit('amplitude', motion) or 'part of a converter step'}"


@compiled
def step(p: Array, i: int, s: Array, j: int, x: float, force: float, applied: float) -> float:
    """One sample; p from i and s from j on are this law's."""
    state = s[j]
    if p[i + _RANDOM] > 0.0:
        state = (_FACTOR * state) % MODULUS
        part = 2.0 * state / MODULUS - 1.0
        s[j] = state
    else:
        part = state
        s[j] = -state
    if p[i + _SURFACE] > 0.0 and x <= 0.0:
        return force
    return force + p[i + _AMPLITUDE] * part
