"""Velocity by a Kalman filter that has settled: white acceleration, readings wrong by quantization.

    e = x − (x̂ + T v̂)        x̂ ← x̂ + T v̂ + α e        v̂ ← v̂ + β e/T

Of acceleration of density q and readings of variance R = Δ²/12, with λ = q T³/R,

    p = √λ + √(16 + λ/3),   s = 4/(p + √(p² − 16)),   α = 1 − s²,   β = s √λ

Derived for this project: the innovations e of the settled filter have variance S = R/(1 − α),
and 1 + (α + β − 2) z⁻¹ + (1 − α) z⁻² times them is the second difference of the readings, whose
spectrum is q T³ (2 + cos θ)/3 + R (2 − 2 cos θ)²; compare at θ = 0 and π.  Without quantization
α = 1, β = 3 − √3.

An estimate of velocity for haptics by Kalman filter: Bélanger, Dobrovolny, Helmy & Zhang (1998).
"""

from __future__ import annotations

from dataclasses import dataclass
from math import sqrt
from typing import ClassVar

from zwidth.model.rendering.defaults import known
from zwidth.model.rendering.rendering_law import LoopContext
from zwidth.model.rendering.velocity.estimator import Estimator
from zwidth.native.compiled import Array, compiled
from zwidth.quantity.exact import Exact
from zwidth.quantity.parameter import CertainOrNone, parameter, plain

KALMAN = 3.0

_PERIOD, _ALPHA, _BETA = range(3)
_POSITION, _VELOCITY = range(2)

_WANDERING = 10
"""Samples in which a hand at rest wanders by a count, if nothing else is said."""


@dataclass(frozen=True)
class Kalman(Estimator):
    """Steady-state Kalman filter of position and velocity with constant gains.

    Parameters
    ----------
    acceleration
        √q, the density of the hand's acceleration, > 0 [(m/s²)/√Hz; (rad/s²)/√Hz]; None:
        √(3 Δ²/(10 T)³), which moves a hand at rest one count in ten samples, root mean square.
        The filter then forgets within three samples.

    Raises
    ------
    InputError
        If it is not > 0.
    """

    kind: ClassVar[float] = KALMAN

    acceleration: CertainOrNone = parameter(
        plain("acceleration", "√q in (m/s²)/√Hz or (rad/s²)/√Hz, a plain number"),
        None,
        kept=Exact,
        bound="> 0",
        why="a hand that never accelerates has no velocity to estimate",
    )

    @property
    def state_size(self) -> int:
        """x̂ and v̂."""
        return 2

    def numbers(self, at: LoopContext) -> list[float]:
        """T, α and β/T."""
        resolution = known(at, "resolution", "the noise of the readings is the resolution's")
        wanders = sqrt(3 * resolution**2 / (_WANDERING * at.period) ** 3)
        density = wanders if self.acceleration is None else float(self.acceleration)
        alpha, beta = gains(density, resolution, at.period)
        return [at.period, alpha, beta / at.period]

    def initial_state(self, reading: float) -> list[float]:
        """At the reading, at rest."""
        return [reading, 0.0]

    def describe(self, motion: str = "linear") -> str:
        """In a few words."""
        unit = "(rad/s²)/√Hz" if motion == "rotary" else "(m/s²)/√Hz"
        of = "a count in ten samples" if self.acceleration is None else f"{self.acceleration:g} {unit}"
        return f"Kalman filter for {of}"


def gains(density: float, resolution: float, period: float) -> tuple[float, float]:
    """(α, β) for √q [(m/s²)/√Hz], Δ [m] and T [s]."""
    if resolution == 0.0:
        return 1.0, 3.0 - sqrt(3.0)
    root = density * sqrt(12.0 * period**3) / resolution  # √λ
    p = root + sqrt(16.0 + root * root / 3.0)
    s = 4.0 / (p + sqrt(p * p - 16.0))
    return (1.0 - s) * (1.0 + s), s * root


@compiled
def step(p: Array, i: int, s: Array, j: int, x: float) -> float:
    """One sample; p from i and s from j on are this estimator's."""
    expected = s[j + _POSITION] + p[i + _PERIOD] * s[j + _VELOCITY]
    error = x - expected
    s[j + _POSITION] = expected + p[i + _ALPHA] * error
    s[j + _VELOCITY] += p[i + _BETA] * error
    return s[j + _VELOCITY]
