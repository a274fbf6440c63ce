"""A term in the rate of the force, after the input-to-state stable approach: no energy is counted.

    f_k ← f_k + τ (f_k − f_{k−1})/T

on the force that comes in.  Before a spring of slope K it is damping of K τ in contact.  The first
force is taken as it is: it has been there for ever.

Jafari, Nabeel & Ryu (2015) bound what a loop with hysteresis may give out and do not ask that nothing
comes out.  Their law, as two public programs have it, is this and v − (1/μ) df/dt in the place of the
velocity, μ no less than any slope of the force; on an impedance display that is a spring of μ in series,
x − f/μ in the place of x, and is left out here.  The promises are derived for this project, with
0 ≤ slope ≤ K of what is before it and without counts:

    every hand     no energy comes out where b ≥ K T/2 + K τ; necessary for a spring on both sides
    a spring       behind τ = T/2 gives out (K/4) Σ (Δx_k − Δx_{k−1})² + (K/4) Δx² at most while contact
                   lasts: little where the hand's speed changes slowly
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import ClassVar

from zwidth.model.device.device import Device
from zwidth.model.rendering.rendering_law import LoopContext, RenderingLaw
from zwidth.native.compiled import Array, compiled
from zwidth.quantity.exact import Exact
from zwidth.quantity.parameter import CertainOrNone, parameter

RATE_TERM = 17.0

_SAMPLES = 0
_BEGUN, _LAST = range(2)


@dataclass(frozen=True)
class RateTerm(RenderingLaw):
    """``f ← f + τ (f − f_{k−1})/T``: the force leads by τ.

    Proved of a wall with this law alone behind it: no hand takes energy out where b ≥ K T/2 + K τ; with an
    encoder f_c ≥ (K + 2 K τ/T) Δ/2 as well.  `zwidth.check` says so with a certificate.

    Parameters
    ----------
    time_constant
        τ > 0 [s]; None: T/2, what the hold is late by.

    Raises
    ------
    InputError
        If τ is not positive.

    Notes
    -----
    Jafari, Nabeel & Ryu (2015), the term of the force.
    """

    code: ClassVar[float] = RATE_TERM
    state_size: ClassVar[int] = 2

    time_constant: CertainOrNone = parameter(
        "time_constant",
        None,
        kept=Exact,
        bound="> 0",
        why="it is how far the force leads; without it the law does nothing",
        meaning="τ, by default T/2",
    )

    def numbers(self, at: LoopContext) -> list[float]:
        """τ/T."""
        return [0.5 if self.time_constant is None else float(self.time_constant) / at.period]

    def initial_state(self, reading: float) -> list[float]:
        """The first force is taken as it is: it has been there for ever."""
        return [0.0, 0.0]

    def most_damping(self, device: Device, spring: Exact | None) -> Fraction | None:
        """K τ where the force that comes in is that of a spring: it changes by K |Δx| at most."""
        lead = device.sample_period if self.time_constant is None else self.time_constant
        if spring is None or not isinstance(lead, Exact):
            return None
        return spring.fraction * lead.fraction / (2 if self.time_constant is None else 1)

    def describe(self, motion: str = "linear") -> str:
        """The law with its numbers, in a few words."""
        return f"rate term of {self.with_unit('time_constant', motion) or 'T/2'}"


@compiled
def step(p: Array, i: int, s: Array, j: int, x: float, force: float, applied: float) -> float:
    """One sample; p from i and s from j on are this law's."""
    last = s[j + _LAST] if s[j + _BEGUN] > 0.0 else force
    s[j + _BEGUN], s[j + _LAST] = 1.0, force
    return force + p[i + _SAMPLES] * (force - last)
