"""An arm whose friction is a curve of straight lines: each is Coulomb and viscous friction, of any sign.

    f(v) = f_i + b_i |v|  for v_i ≤ |v| < v_{i+1},    stuck up to f(0)

Within a line the motion has its closed form; where the speed leaves it is found to the last bits, so that
every joule is that of the line it was lost on.  Where friction falls an arm may stick and slip.
"""

from __future__ import annotations

from math import ceil, sqrt

from zwidth.loop.plant import FAULT, VELOCITY, Plant
from zwidth.loop.step import advance
from zwidth.native.compiled import Array, compiled

FROM, COULOMB_PART, VISCOUS_PART = range(3)
"""Of a line: v_i, f_i, b_i."""

_LOOKS = 8
"""How often in a stretch it is looked whether the speed has left its line, at least."""

_MOST = 100_000
_BISECTIONS = 60


@compiled
def line_of(curve: Array, speed: float) -> int:
    """The line on which a speed lies."""
    i = 0
    while i + 1 < curve.shape[0] and speed >= curve[i + 1, FROM]:
        i += 1
    return i


@compiled
def on_line(plant: Plant, curve: Array, i: int) -> Plant:
    """The plant with the friction of one line."""
    return Plant(
        plant.mass,
        plant.hand_mass,
        curve[i, VISCOUS_PART],
        curve[i, COULOMB_PART],
        plant.stiction,
        plant.stiffness,
        plant.hand_damping,
        plant.lag,
        plant.slew,
    )


@compiled
def advance_on(
    state: Array, plant: Plant, curve: Array, push: float, anchor: float, speed: float, h: float, work: Array
) -> None:
    """As `step.advance`, with the friction of a curve; without one the same.

    A speed that leaves its line and comes back between two looks is not seen to have left it.
    """
    if curve.shape[0] == 0:
        advance(state, plant, push, anchor, speed, h, work)
        return
    mass, now = plant.mass + plant.hand_mass, 0.0
    for _ in range(_MOST):
        if now >= h:
            return
        before = state.copy()
        i = line_of(curve, abs(state[VELOCITY]))
        own = on_line(plant, curve, i)
        quick = max(abs(own.damping + own.hand_damping) / mass, sqrt(own.stiffness / mass))
        step = min(h - now, h / max(_LOOKS, ceil(4.0 * quick * h)))
        here = anchor + speed * now
        advance(state, own, push, here, speed, step, work)
        if _left(curve, i, before, state):
            low = 0.0
            for _ in range(_BISECTIONS):
                middle = 0.5 * (low + step)
                if middle <= low or middle >= step:
                    break
                state[:] = before
                advance(state, own, push, here, speed, middle, work)
                if _left(curve, i, before, state):
                    step = middle
                else:
                    low = middle
            state[:] = before
            advance(state, own, push, here, speed, step, work)
        now = h if now + step >= h else now + step
    state[FAULT] = 1.0


@compiled
def _left(curve: Array, i: int, before: Array, state: Array) -> bool:
    """Whether the speed is on another line, or on this one the other way."""
    turned = i > 0 and before[VELOCITY] * state[VELOCITY] <= 0.0
    return turned or line_of(curve, abs(state[VELOCITY])) != i
