"""Velocity from the time between two ticks of the encoder, for a hand slower than a count per sample.

    v̂ = ± c Δ/(n T)              at a tick: c edges on, n samples after the tick before
    v̂ = ± min(|v̂|, Δ/(n T))      without one: had it been faster, the next edge would have come

The first edge after a turn is the one that was crossed last: c is then one less, and a hand
that trembles about one edge has no velocity.  The clock is that of the samples, so that the
time, and the velocity, is good to one part in n; from one count per sample on it is the
backward difference.

Timing ticks is as old as counting them (Brown, Schneider & Mulligan 1992 compare the two);
how it decays and turns is derived for this project.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from zwidth.model.rendering.defaults import known
from zwidth.model.rendering.rendering_law import LoopContext
from zwidth.model.rendering.velocity.estimator import Estimator
from zwidth.native.compiled import Array, compiled

TICK_TIME = 2.0

_PERIOD, _COUNT = range(2)
_BEFORE, _VELOCITY, _WAITED, _SIDE = range(4)

_FOR_EVER = 1e15


@dataclass(frozen=True, kw_only=True)
class TickTime(Estimator):
    """Counts over the time since the last tick, decaying while no tick comes.  No parameters.

    With an ideal sensor, Δ = 0, every sample is a tick: the backward difference.
    """

    kind: ClassVar[float] = TICK_TIME

    @property
    def state_size(self) -> int:
        """Last reading, velocity, samples since the last tick, its direction."""
        return 4

    def numbers(self, at: LoopContext) -> list[float]:
        """T and Δ."""
        return [at.period, known(at, "resolution", "the time between ticks needs the resolution")]

    def initial_state(self, reading: float) -> list[float]:
        """The last tick was for ever ago."""
        return [reading, 0.0, _FOR_EVER, 0.0]

    def describe(self, motion: str = "linear") -> str:
        """In a few words."""
        return "time between ticks"


@compiled
def step(p: Array, i: int, s: Array, j: int, x: float) -> float:
    """One sample; p from i and s from j on are this estimator's."""
    moved, velocity = x - s[j + _BEFORE], s[j + _VELOCITY]
    waited = s[j + _WAITED] + 1.0
    time = waited * p[i + _PERIOD]
    if moved == 0.0:
        most = p[i + _COUNT] / time
        velocity = min(max(velocity, -most), most)
        if most == 0.0:
            waited = 0.0
    else:
        side = 1.0 if moved > 0.0 else -1.0
        crossed = abs(moved)
        if s[j + _SIDE] == -side:
            crossed = max(crossed - p[i + _COUNT], 0.0)
        velocity = side * crossed / time
        waited = 0.0
        s[j + _SIDE] = side
    s[j + _BEFORE], s[j + _VELOCITY], s[j + _WAITED] = x, velocity, waited
    return velocity
