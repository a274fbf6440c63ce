"""Extrapolation: the environment meets the hand where it will be when half of the hold is over.

    x̂_k = x_k + n (x_k − x_{k−1})

A held force is on average half a sample old.  Before a linear wall, n = ½ makes

    K x̂_k = K x_k + (K T/2) (x_k − x_{k−1})/T,    H(z) = K (1.5 − 0.5 z⁻¹)

which is the wall with a virtual damping B = K T/2 on the backward difference: it pays the
hold at low frequencies and, like any virtual damping, costs passivity at high ones.
Prediction by half a sample: Gillespie & Cutkosky (1996); this, its first order and
without a model, derived for this project.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from zwidth.model.rendering.rendering_law import LoopContext, RenderingLaw
from zwidth.native.compiled import Array, compiled
from zwidth.quantity.exact import Exact
from zwidth.quantity.parameter import Certain, parameter, plain

EXTRAPOLATION = 30.0


@dataclass(frozen=True, kw_only=True)
class Extrapolation(RenderingLaw):
    """Before the environment, ``x̂ = x_k + n (x_k − x_{k−1})``.

    An encoder's count is multiplied by 1 + n, and a count up and down by 1 + 2n.

    Parameters
    ----------
    samples
        n ≥ 0 [samples]: ½ for the hold; ½ and the delay in samples with a delay.

    Raises
    ------
    InputError
        If samples is negative.
    """

    code: ClassVar[float] = EXTRAPOLATION
    state_size: ClassVar[int] = 1

    samples: Certain = parameter(
        plain("samples", "n, by default ½"),
        "0.5",
        kept=Exact,
        bound="≥ 0",
        why="the force is applied after the reading, not before",
    )

    def numbers(self, at: LoopContext) -> list[float]:
        """As the step reads them."""
        return [float(self.samples)]

    def describe(self, motion: str = "linear") -> str:
        """The law with its numbers, in a few words."""
        return f"extrapolated by {float(self.samples):g} samples"


@compiled
def step(p: Array, i: int, s: Array, j: int, x: float) -> float:
    """One sample; p from i and s from j on are this law's."""
    moved: float = p[i] * (x - s[j])
    s[j] = x
    return x + moved
