"""Half-sample prediction: the wall is evaluated where the hand will be in the middle of the hold.

    ξ̂ = Φ(T/2) ξ_k + Γ(T/2) (f_{k−1} − k x_a),    f_k = law(x̂)

A force held from kT to (k+1)T stands for the one at (k + ½)T.  With device and finger
known, `modelled`, the state is predicted to that instant under the force that is still
applied, and the environment reads x̂ in the place of x_k (Gillespie & Cutkosky 1996, whose
text was not consulted: that the force of the prediction is f_{k−1} and the state comes
from two readings is derived for this project).

On the way f_{k−1} acts, not f_k, which is what will act: behind an elastic wall the
bounces then die out slowly.  Where the wall is crossed nothing is repaired: see
`CrossingCorrection`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from zwidth.model.rendering.prediction.modelled import FF, FV, GX, MODEL, REST, Modelled, estimated
from zwidth.model.rendering.rendering_law import LoopContext
from zwidth.native.compiled import Array, compiled

HALF_SAMPLE = 31.0

_HALF = MODEL
"""Where the same numbers for half a sample begin."""


@dataclass(frozen=True, kw_only=True)
class HalfSamplePrediction(Modelled):
    """Before the environment, ``x̂ = (Φ(T/2) ξ_k + Γ(T/2) (f_{k−1} − k x_a))₁``.

    Takes the parameters of a model of device and finger: mass, damping (None: the
    device's), finger_mass, finger_stiffness, finger_damping and finger_position.
    """

    code: ClassVar[float] = HALF_SAMPLE
    state_size: ClassVar[int] = 2

    def numbers(self, at: LoopContext) -> list[float]:
        """Φ, Γ and k x_a for a sample, then for half of one.

        Raises
        ------
        InputError
            As `Modelled.plant`.
        """
        plant = self.plant(at)
        return [*plant.numbers(at.period), *plant.numbers(at.period / 2)]

    def describe(self, motion: str = "linear") -> str:
        """The law with its numbers, in a few words."""
        return f"half-sample prediction ({self.describe_model(motion)})"


@compiled
def step(p: Array, i: int, s: Array, j: int, x: float, applied: float) -> float:
    """x̂ of one sample; p from i and s from j on are this law's, `applied` is the force that was held."""
    v = estimated(p, i, s, j, x, applied)
    i += _HALF
    ahead: float = p[i + FF] * x + p[i + FV] * v + p[i + GX] * (applied - p[i + REST])
    return ahead
