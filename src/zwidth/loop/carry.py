"""A stretch whose motion is prescribed: constant velocity, whatever force that takes.

The mass changes its velocity by an impulse of the hand at the beginning; then
the hand works against the actuator, f_c sgn v and b v.
"""

from __future__ import annotations

from zwidth.loop.plant import (
    ACTUATOR_WORK,
    COULOMB,
    DIRECTION,
    FORCE,
    GOAL,
    HAND_WORK,
    POSITION,
    SOURCE_WORK,
    VELOCITY,
    VISCOUS,
    Plant,
)
from zwidth.native.compiled import Array, compiled
from zwidth.quantity.elementary import expm1


@compiled
def carry(state: Array, plant: Plant, target: float, h: float) -> None:
    """Go to `target` in h seconds; the state is changed in place."""
    moved = target - state[POSITION]
    v0, v1 = state[VELOCITY], moved / h
    mean = _advance_force(state, plant, h)
    pull = mean * moved
    viscous, coulomb = plant.damping * v1 * moved, plant.coulomb * abs(moved)
    state[ACTUATOR_WORK] -= pull
    state[VISCOUS] += viscous
    state[COULOMB] += coulomb
    work = pull + viscous + coulomb + 0.5 * plant.mass * (v1 - v0) * (v1 + v0)
    state[HAND_WORK] += work
    state[SOURCE_WORK] += work
    state[POSITION] = target
    state[VELOCITY] = v1
    state[DIRECTION] = 1.0 if v1 > 0.0 else (-1.0 if v1 < 0.0 else 0.0)


@compiled
def _advance_force(state: Array, plant: Plant, h: float) -> float:
    """Move the actuator force on by h; returns its mean over that time."""
    start, goal = state[FORCE], state[GOAL]
    gap = goal - start
    if gap == 0.0:
        return start
    if plant.lag > 0.0:
        share = -expm1(-h / plant.lag)
        state[FORCE] = goal - gap * (1.0 - share)
        return goal - gap * share * plant.lag / h
    reach = abs(gap) / plant.slew
    if reach >= h:
        state[FORCE] = start + gap * (h / reach)
        return start + 0.5 * gap * (h / reach)
    state[FORCE] = goal
    return goal - 0.5 * gap * (reach / h)
