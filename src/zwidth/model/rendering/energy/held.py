"""An environment that is updated every N samples, its force held in between.

    f_k = F_n,   F_n the environment's force at sample n N,   n N ≤ k < (n + 1) N

as where a slow simulation drives a fast device: Hannaford & Ryu (2002) updated theirs at
66.7 Hz, every 15 samples.  For the hand it is a loop of period N T, so a spring needs
K ≤ 2b/(N T); and with an encoder K ≤ 2 f_c/Δ as before.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from zwidth.model.rendering.reading import updated_every
from zwidth.model.rendering.rendering_law import LoopContext, RenderingLaw
from zwidth.native.compiled import Array, compiled
from zwidth.quantity.parameter import Count

HELD = 25.0

_SAMPLES = 0
_LEFT, _FORCE = range(2)


@dataclass(frozen=True, kw_only=True)
class Held(RenderingLaw):
    """The force of every N-th sample, held for N: an environment that is updated slowly.

    It promises nothing: a spring K is passive behind it if and only if it is in a loop of period N T,
    K ≤ min(2b/(N T), 2 f_c/Δ).  The environment itself runs at every sample, so a velocity in it is that
    of one sample; a law behind this one runs at every sample too.

    Parameters
    ----------
    samples
        N, samples between two updates.  The first sample updates.

    Raises
    ------
    InputError
        If samples is not a whole number, at least 1.
    """

    code: ClassVar[float] = HELD
    state_size: ClassVar[int] = 2

    samples: Count = updated_every()

    def numbers(self, at: LoopContext) -> list[float]:
        """As the step reads them."""
        return [float(self.samples)]

    def initial_state(self, reading: float) -> list[float]:
        """An update is due."""
        return [0.0, 0.0]

    def describe(self, motion: str = "linear") -> str:
        """The law in a few words."""
        return f"updated every {self.samples} samples"


@compiled
def step(p: Array, i: int, s: Array, j: int, x: float, force: float, applied: float) -> float:
    """One sample; p from i and s from j on are this law's."""
    if s[j + _LEFT] <= 0.0:
        s[j + _LEFT], s[j + _FORCE] = p[i + _SAMPLES], force
    s[j + _LEFT] -= 1.0
    held: float = s[j + _FORCE]
    return held
