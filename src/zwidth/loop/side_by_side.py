"""Plain loops side by side: one interval of LANES of them at a time, in vector instructions.

The arithmetic of each lane is that of `plain.run_plain`, to the last bit.  A lane
that stops or turns round in an interval leaves the straight line: it is stepped
alone by `step.advance`, and the others do not wait.

All numbers lie in one flat buffer, quantity by quantity and lane by lane: only
then does the compiler see that they do not overlap.
"""

from __future__ import annotations

import numpy as np

from zwidth.loop.compiled import Array, compiled
from zwidth.loop.free import free_response
from zwidth.loop.kernel import packed_plant
from zwidth.loop.law import BILATERAL, GATE, HEADER, LIMIT, PHASE, RESOLUTION, STEP
from zwidth.loop.plant import (
    ACTUATOR_WORK,
    COULOMB,
    DIRECTION,
    FAULT,
    FORCE,
    GOAL,
    HAND_WORK,
    INSIDE,
    POSITION,
    SATURATED,
    SOURCE_WORK,
    STATE_SIZE,
    STOPS,
    VELOCITY,
    VISCOUS,
)
from zwidth.loop.step import advance
from zwidth.loop.summary import DEEPEST, EXTRACTED, HIGHEST, LOWEST, PEAK, SUMMARY

LANES = 32
"""Loops in one block: enough to hide the chain of one behind the others."""

# Offsets of the quantities in the buffer.
_L = LANES
_X, _V, _SIDE, _F = 0, _L, 2 * _L, 3 * _L
_HAND, _ACT, _VISC, _DRY, _SOURCE = 4 * _L, 5 * _L, 6 * _L, 7 * _L, 8 * _L
_COUNT, _PHASE, _GAIN, _STEP, _LIMIT, _OPEN = 9 * _L, 10 * _L, 11 * _L, 12 * _L, 13 * _L, 14 * _L
_DRAG, _FC, _FS, _INV, _HALF = 15 * _L, 16 * _L, 17 * _L, 18 * _L, 19 * _L
_H, _H1, _H2, _H3, _G1, _G2 = 20 * _L, 21 * _L, 22 * _L, 23 * _L, 24 * _L, 25 * _L
_PUSH, _LEFT, _INSIDE, _SATURATED = 26 * _L, 27 * _L, 28 * _L, 29 * _L
_DEEP, _PEAK, _OUT, _HIGH, _LOW = 30 * _L, 31 * _L, 32 * _L, 33 * _L, 34 * _L
_COMMAND = 35 * _L
BUFFER = 36 * _L


@compiled
def run_side_by_side(
    states: Array,
    numbers: Array,
    laws: Array,
    periods: Array,
    late: int,
    force: Array,
    shared: bool,
    samples: int,
    buffer: Array,
    queue: Array,
    work: Array,
    summaries: Array,
) -> None:
    """Run LANES plain loops over all samples.

    Parameters
    ----------
    states, numbers, laws
        One row per lane, see `plain.run_plain`; the states are changed.
    periods
        T of each lane [s].
    late
        Whole samples of delay, the same for all.
    force
        F of every interval, samples × 1 if `shared`, else samples × LANES.
    buffer, queue, work
        Scratch: BUFFER, (late + 1) · LANES and `series.WORK` long.
    summaries
        One row per lane, filled in; see `summary`.
    """
    _load(states, numbers, laws, periods, buffer)
    quarter = samples - samples // 4
    for k in range(samples + 1):
        slot = (k % (late + 1)) * LANES
        oldest = ((k + 1) % (late + 1)) * LANES
        _measure(buffer)
        _apply(buffer, queue, slot, oldest, k >= late)
        _watch(buffer, k >= quarter)
        if k == samples:
            break
        for i in range(LANES):
            buffer[_PUSH + i] = force[k, 0] if shared else force[k, i]
        if _move(buffer) > 0:
            for i in range(LANES):
                if buffer[_LEFT + i] > 0.0:
                    _alone(buffer, i, states[i], numbers[i], periods[i], work)
    _store(states, buffer, summaries)


@compiled
def _measure(b: Array) -> None:
    """What each lane's law commands now."""
    for i in range(LANES):
        x, count, step, limit = b[_X + i], b[_COUNT + i], b[_STEP + i], b[_LIMIT + i]
        quotient = x / (count if count > 0.0 else 1.0) + b[_PHASE + i]
        reading = count * np.floor(quotient) if count > 0.0 else x
        inside = 1.0 if reading > 0.0 else b[_OPEN + i]
        command = b[_GAIN + i] * reading if inside > 0.0 else 0.0
        rounded = step * np.floor(command / (step if step > 0.0 else 1.0) + 0.5)
        command = rounded if step > 0.0 else command
        over = 1.0 if abs(command) > limit else 0.0
        bound = limit if command > 0.0 else -limit
        b[_COMMAND + i] = bound if over > 0.0 else command
        b[_INSIDE + i] += inside
        b[_SATURATED + i] += over


@compiled
def _move(b: Array) -> int:
    """One interval of the lanes that have no stop in it; returns how many have, and marks them."""
    left = 0
    for i in range(LANES):
        x, v, f, push = b[_X + i], b[_V + i], b[_F + i], b[_PUSH + i]
        external = push - f
        onward = 1.0 if external > 0.0 else -1.0
        still = 1.0 if abs(external) <= b[_FS + i] else 0.0
        resting = still if b[_SIDE + i] == 0.0 else 0.0
        side = onward if b[_SIDE + i] == 0.0 else b[_SIDE + i]
        base = (push - side * b[_FC + i] - b[_DRAG + i] * v) * b[_INV + i]
        v1 = (v + base * b[_H1 + i]) - f * b[_G1 + i]
        onwards = 1.0 if v1 * side > 0.0 else 0.0
        goes = onwards if resting == 0.0 else 0.0
        ahead = v * b[_H + i] + base * b[_H2 + i]
        moved = ahead - f * b[_G2 + i]
        a0 = base - f * b[_INV + i]
        lost = b[_DRAG + i] * (v * v * b[_H + i] + 2.0 * v * a0 * b[_H2 + i] + a0 * a0 * b[_H3 + i])
        inertia = b[_HALF + i] * (v1 - v) * (v1 + v)
        b[_VISC + i] += lost if goes > 0.0 else 0.0
        b[_DRY + i] += b[_FC + i] * abs(moved) if goes > 0.0 else 0.0
        b[_ACT + i] -= f * moved if goes > 0.0 else 0.0
        b[_SOURCE + i] += push * moved if goes > 0.0 else 0.0
        b[_HAND + i] += push * moved - inertia if goes > 0.0 else 0.0
        b[_X + i] = (x + ahead) - f * b[_G2 + i] if goes > 0.0 else x
        b[_V + i] = v1 if goes > 0.0 else v
        b[_SIDE + i] = 0.0 if resting > 0.0 else side
        b[_LEFT + i] = 1.0 - goes - resting
        left += 1 if goes + resting == 0.0 else 0
    return left


@compiled
def _apply(b: Array, queue: Array, slot: int, oldest: int, ready: bool) -> None:
    """The command joins the queue, and the one whose time has come is the force."""
    for i in range(LANES):
        queue[slot + i] = b[_COMMAND + i]
    for i in range(LANES):
        b[_F + i] = queue[oldest + i] if ready else 0.0


@compiled
def _watch(b: Array, ending: bool) -> None:
    """Extremes so far, at the samples; the range of the position over the last quarter."""
    for i in range(LANES):
        x, f, out = b[_X + i], abs(b[_F + i]), -b[_HAND + i]
        b[_DEEP + i] = x if x > b[_DEEP + i] else b[_DEEP + i]
        b[_PEAK + i] = f if f > b[_PEAK + i] else b[_PEAK + i]
        b[_OUT + i] = out if out > b[_OUT + i] else b[_OUT + i]
    if ending:
        for i in range(LANES):
            x = b[_X + i]
            b[_HIGH + i] = x if x > b[_HIGH + i] else b[_HIGH + i]
            b[_LOW + i] = x if x < b[_LOW + i] else b[_LOW + i]


@compiled
def _alone(b: Array, i: int, state: Array, numbers: Array, h: float, work: Array) -> None:
    """One interval of lane i, with its stops."""
    state[POSITION], state[VELOCITY], state[DIRECTION] = b[_X + i], b[_V + i], b[_SIDE + i]
    state[FORCE] = state[GOAL] = b[_F + i]
    state[HAND_WORK], state[ACTUATOR_WORK] = b[_HAND + i], b[_ACT + i]
    state[VISCOUS], state[COULOMB], state[SOURCE_WORK] = b[_VISC + i], b[_DRY + i], b[_SOURCE + i]
    advance(state, packed_plant(numbers), b[_PUSH + i], 0.0, 0.0, h, work)
    b[_X + i], b[_V + i], b[_SIDE + i] = state[POSITION], state[VELOCITY], state[DIRECTION]
    b[_HAND + i], b[_ACT + i] = state[HAND_WORK], state[ACTUATOR_WORK]
    b[_VISC + i], b[_DRY + i], b[_SOURCE + i] = state[VISCOUS], state[COULOMB], state[SOURCE_WORK]


@compiled
def _load(states: Array, numbers: Array, laws: Array, periods: Array, b: Array) -> None:
    for i in range(LANES):
        p, law, h = packed_plant(numbers[i]), laws[i], periods[i]
        inverse = 1.0 / (p.mass + p.hand_mass)
        b[_X + i], b[_V + i], b[_SIDE + i] = states[i, POSITION], states[i, VELOCITY], states[i, DIRECTION]
        b[_HAND + i] = b[_ACT + i] = b[_VISC + i] = b[_DRY + i] = b[_SOURCE + i] = 0.0
        b[_COUNT + i], b[_PHASE + i], b[_GAIN + i] = law[RESOLUTION], law[PHASE], law[HEADER + 1]
        b[_STEP + i], b[_LIMIT + i] = law[STEP], law[LIMIT] if law[LIMIT] > 0.0 else 1e300
        b[_OPEN + i] = 1.0 if law[GATE] == BILATERAL else 0.0
        b[_DRAG + i], b[_FC + i], b[_FS + i], b[_INV + i] = p.damping, p.coulomb, p.stiction, inverse
        b[_HALF + i] = 0.5 * p.hand_mass
        h1, h2, h3 = free_response(p.damping * inverse, h)
        b[_H + i], b[_H1 + i], b[_H2 + i], b[_H3 + i] = h, h1, h2, h3
        b[_G1 + i], b[_G2 + i] = inverse * h1, inverse * h2
        b[_INSIDE + i] = b[_SATURATED + i] = 0.0
        b[_DEEP + i] = b[_OUT + i] = b[_HIGH + i] = -1e300
        b[_PEAK + i], b[_LOW + i] = 0.0, 1e300


@compiled
def _store(states: Array, b: Array, summaries: Array) -> None:
    for i in range(LANES):
        states[i, POSITION], states[i, VELOCITY], states[i, DIRECTION] = b[_X + i], b[_V + i], b[_SIDE + i]
        states[i, FORCE] = states[i, GOAL] = b[_F + i]
        states[i, HAND_WORK], states[i, ACTUATOR_WORK] = b[_HAND + i], b[_ACT + i]
        states[i, VISCOUS], states[i, COULOMB], states[i, SOURCE_WORK] = (
            b[_VISC + i],
            b[_DRY + i],
            b[_SOURCE + i],
        )
        states[i, INSIDE], states[i, SATURATED] = b[_INSIDE + i], b[_SATURATED + i]
        summaries[i, DEEPEST], summaries[i, PEAK], summaries[i, EXTRACTED] = (
            b[_DEEP + i],
            b[_PEAK + i],
            b[_OUT + i],
        )
        summaries[i, HIGHEST], summaries[i, LOWEST] = b[_HIGH + i], b[_LOW + i]
