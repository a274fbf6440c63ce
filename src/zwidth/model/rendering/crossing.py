"""Crossing correction: two forces that put the hand where a wall without samples would have it.

On the first sample k after the surface was crossed, on entry and on exit, from ξ_{k−1}:

    t_c     the instant at which the hand crosses under the wall that was meant
    ξ*      where that wall has the hand at t_{k+2}, switched at t_c and wherever it crosses again
    Φ² ξ_k + Φ Γ u_k + Γ u_{k+1} = ξ*                    (forces less k x_a, see `modelled`)

The two held forces u_k, u_{k+1} take the place of the wall's; what comes later is the wall's, or of a
prediction before it.  Where a contact is over within three samples no energy is left over: the hold gave what
it should not, and the two forces take it back.  In longer ones the hold goes on leaking between the
crossings; `throughout` then renews the two forces every second sample inside, ξ* two samples from ξ_k.

Deadbeat after crossings: Gillespie & Cutkosky (1996), whose text was not consulted.
Derived for this project: `throughout`; that ξ* starts from ξ_{k−1}, so that what the hold did in the
interval of the crossing is repaired as well, and how t_c is found, by bisection on the
Taylor series of the motion, which here is exact to rounding.

An error δ of the reading makes errors of the forces of some M δ/T²: on encoders the
law wants slow loops.  The forces may pull, and a force limit undoes them.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil
from typing import ClassVar

import numpy as np

from zwidth.model.rendering.ahead import FF, FV, MODEL, REST, VF, VV, Modelled, estimated, speed_before
from zwidth.model.rendering.rendering_law import LoopContext
from zwidth.native.compiled import Array, compiled
from zwidth.quantity.parameter import part

CROSSING = 35.0

_PERIOD, _PIECES, _MASS, _DAMPING, _STIFFNESS, _WALL, _DAMPER, _CLAMPED, _ON = range(MODEL, MODEL + 9)
_INVERSE = MODEL + 9
_BEFORE, _STARTED, _WAIT, _SECOND = range(4)

FEWEST_PIECES = 8
"""Into which a sample is cut at least to look for crossings: what comes and goes within one is not seen."""

TERMS = 18
"""Of the Taylor series; a piece is half a radian of the quickest motion at most: ½¹⁸/18! = 6e−22."""

BISECTIONS = 50


@dataclass(frozen=True, kw_only=True)
class CrossingCorrection(Modelled):
    """After a crossing, ``Φ² ξ_k + ΦΓ u_k + Γ u_{k+1} = ξ*``, ξ* of the continuous wall.

    Parameters
    ----------
    throughout
        True to go on with it, two samples at a time, as long as the hand is inside.
    **model
        Of device and finger: mass, damping (None: the device's), finger_mass,
        finger_stiffness, finger_damping and finger_position.
    """

    code: ClassVar[float] = CROSSING
    state_size: ClassVar[int] = 4

    throughout: bool = part(
        "flag", lambda given, _: bool(given), False, meaning="true to go on with it inside"
    )

    def numbers(self, at: LoopContext) -> list[float]:
        """The model, the continuous wall and (ΦΓ, Γ)⁻¹.

        Raises
        ------
        InputError
            As `Modelled.plant`; if the environment is no wall.
        """
        wall, damper = self.wall(at)
        plant, period = self.plant(at), at.period
        phi, gamma = plant.held(period)
        inverse = np.linalg.inv(np.column_stack([phi @ gamma, gamma]))
        rates = (
            np.abs(np.linalg.eigvals(plant.matrix(wall, damper))),
            np.abs(np.linalg.eigvals(plant.matrix())),
        )
        pieces = max(FEWEST_PIECES, ceil(2 * float(np.max(rates)) * period))
        continuous = [plant.mass, plant.damping, plant.stiffness, wall, damper]
        flags = [float(at.environment.clamped), float(self.throughout)]
        return [*plant.numbers(period), period, float(pieces), *continuous, *flags, *inverse.ravel().tolist()]

    def describe(self, motion: str = "linear") -> str:
        where = ", throughout" if self.throughout else ""
        return f"crossing correction ({self.describe_model(motion)}{where})"


@compiled
def crossing_step(p: Array, i: int, s: Array, j: int, x: float, force: float, applied: float) -> float:
    """One sample; p from i and s from j on are this law's, `applied` is the force that was held."""
    before, seen, wait = s[j + _BEFORE], s[j + _STARTED] > 0.0, s[j + _WAIT]
    v = estimated(p, i, s, j, x, applied)
    if wait == 2.0:
        s[j + _WAIT] = 1.0
        second: float = s[j + _SECOND]
        return second
    s[j + _WAIT] = 0.0
    crossed = wait == 0.0 and seen and (x > 0.0) != (before > 0.0)
    if not crossed and not (p[i + _ON] > 0.0 and x > 0.0):
        return force
    if crossed:
        was = speed_before(p, i, before, x, applied)
        goal, speed = meant(p, i, before, was, 3.0 * p[i + _PERIOD])
    else:
        goal, speed = meant(p, i, x, v, 2.0 * p[i + _PERIOD])
    first, second = two_forces(p, i, x, v, goal, speed)
    s[j + _WAIT], s[j + _SECOND] = 2.0, second
    return first


@compiled
def two_forces(p: Array, i: int, x: float, v: float, goal: float, speed: float) -> tuple[float, float]:
    """u_k and u_{k+1}, which bring (x, v) to (goal, speed) in two samples."""
    for _ in range(2):
        x, v = p[i + FF] * x + p[i + FV] * v, p[i + VF] * x + p[i + VV] * v
    x, v = goal - x, speed - v
    at, rest = i + _INVERSE, p[i + REST]
    return p[at] * x + p[at + 1] * v + rest, p[at + 2] * x + p[at + 3] * v + rest


@compiled
def meant(p: Array, i: int, x: float, v: float, time: float) -> tuple[float, float]:
    """Where the continuous wall has the hand after a time, from (x, v)."""
    piece, left = p[i + _PERIOD] / p[i + _PIECES], time
    while left > 1e-12 * time:
        h = min(piece, left)
        inside = pushes(p, i, x, v)
        x1, v1 = moved(p, i, inside, x, v, h)
        if pushes(p, i, x1, v1) != inside:
            low = 0.0
            for _ in range(BISECTIONS):
                middle = 0.5 * (low + h)
                x1, v1 = moved(p, i, inside, x, v, middle)
                if pushes(p, i, x1, v1) == inside:
                    low = middle
                else:
                    h = middle
            x1, v1 = moved(p, i, inside, x, v, h)
        x, v = x1, v1
        left -= h
    return x, v


@compiled
def pushes(p: Array, i: int, x: float, v: float) -> bool:
    """Whether the continuous wall acts."""
    pulls = p[i + _CLAMPED] > 0.0 and p[i + _WALL] * x + p[i + _DAMPER] * v <= 0.0
    return x > 0.0 and not pulls


@compiled
def moved(p: Array, i: int, inside: bool, x: float, v: float, h: float) -> tuple[float, float]:
    """M ẍ = −D ẋ − k (x − x_a) [− K x − B ẋ] from (x, v), h later: its Taylor series."""
    mass, drag, spring = p[i + _MASS], p[i + _DAMPING], p[i + _STIFFNESS]
    if inside:
        drag, spring = drag + p[i + _DAMPER], spring + p[i + _WALL]
    drag, spring = drag / mass, spring / mass
    last, now = v, p[i + REST] / mass - spring * x - drag * v  # the derivatives n − 1 and n of x
    part = h  # hⁿ⁻¹/(n − 1)!
    x, v = x + v * h, v + now * h
    for n in range(2, TERMS):
        part *= h / n
        x += now * part
        last, now = now, -drag * now - spring * last
        v += now * part
    return x, v
