"""Digital design: the held loop gets the poles of the continuous one.

    f_k = g_x x_k + g_v v̂_k    if x_k > 0,   0 outside
    eig(Φ + Γ (g_x, g_v)) = e^{sT},    s: M s² + (D + B) s + k + K = 0

The wall K, B against device and finger M, D, k, `modelled`, has two poles; the two gains
give them, mapped by e^{sT}, to the same plant behind the hold.  Trace and determinant
are linear in the gains (Γ is −, for f slows):

    tr Φ + γ₁ g_x + γ₂ g_v = e^{s₁T} + e^{s₂T}
    det Φ + (γ₁ φ₂₂ − γ₂ φ₁₂) g_x + (γ₂ φ₁₁ − γ₁ φ₂₁) g_v = e^{(s₁+s₂)T}

For a free mass, D = B = k = 0, ω² = K/M: g_x = (2M/T²)(1 − cos ωT) = K (1 − (ωT)²/12 + …)
and g_v = g_x T/2, a virtual damping of the size that `Extrapolation` has.  The idea is
Gillespie & Cutkosky's (1996); the equations are derived for this project.

Pressed on slowly the wall is g_x, not K, stiff.  Poles are those of contact: what is gained or
lost where the surface is crossed remains.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from zwidth.errors import InputError
from zwidth.model.rendering.prediction.modelled import MODEL, Modelled, Plant, estimated, turns_over
from zwidth.model.rendering.rendering_law import LoopContext
from zwidth.native.compiled import Array, compiled

POLE_MATCHED = 36.0

_POSITION, _VELOCITY, _CLAMPED = range(MODEL, MODEL + 3)


@dataclass(frozen=True, kw_only=True)
class PoleMatched(Modelled):
    """In the place of a wall, ``f = g_x x + g_v v̂ if x > 0`` with the poles e^{sT} of K x + B v.

    Takes the parameters of a model of device and finger: mass, damping (None: the
    device's), finger_mass, finger_stiffness, finger_damping and finger_position.
    """

    code: ClassVar[float] = POLE_MATCHED
    state_size: ClassVar[int] = 2

    def numbers(self, at: LoopContext) -> list[float]:
        """The model, g_x, g_v and whether the wall never pulls.

        Raises
        ------
        InputError
            As `Modelled.plant`; if the environment is no wall, or swings half a turn in one sample.
        """
        stiffness, damping = self.wall(at)
        plant = self.plant(at)
        if turns_over(plant.matrix(stiffness, damping), at.period):
            raise InputError(
                f"against {stiffness:g} N/m the model swings half a turn or more in {at.period:g} s: "
                "poles at e^{sT} would belong to a softer wall; sample faster, or take a softer one"
            )
        gains = matched(plant, stiffness, damping, at.period)
        return [*plant.numbers(at.period), *gains, float(at.environment.clamped)]

    def gains(self, at: LoopContext) -> tuple[float, float]:
        """(g_x, g_v) [N/m, N·s/m]; raises as `numbers`."""
        numbers = self.numbers(at)
        return numbers[_POSITION], numbers[_VELOCITY]

    def describe(self, motion: str = "linear") -> str:
        """The law with its numbers, in a few words."""
        return f"poles matched ({self.describe_model(motion)})"


def matched(plant: Plant, stiffness: float, damping: float, period: float) -> tuple[float, float]:
    """(g_x, g_v) of the equations above."""
    from scipy.linalg import expm  # scipy takes its time

    phi, gamma = plant.held(period)
    goal = expm(plant.matrix(stiffness, damping) * period)
    (ff, fv), (vf, vv) = phi
    gx, gv = gamma
    rows = np.array([[gx, gv], [gx * vv - gv * fv, gv * ff - gx * vf]])
    wanted = [np.trace(goal) - np.trace(phi), np.linalg.det(goal) - np.linalg.det(phi)]
    position, velocity = np.linalg.solve(rows, wanted)
    return float(position), float(velocity)


@compiled
def step(p: Array, i: int, s: Array, j: int, x: float, force: float, applied: float) -> float:
    """One sample; p from i and s from j on are this law's, `applied` is the force that was held."""
    v = estimated(p, i, s, j, x, applied)
    if x <= 0.0:
        return 0.0
    f: float = p[i + _POSITION] * x + p[i + _VELOCITY] * v
    return max(f, 0.0) if p[i + _CLAMPED] > 0.0 else f
