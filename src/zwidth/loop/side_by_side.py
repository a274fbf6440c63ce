"""Plain loops side by side: one interval of LANES of them at a time, in vector instructions.

The arithmetic of each lane is that of `plain.run_plain`, to the last bit.  A lane
that starts, stops or turns round in an interval leaves the straight line: it is stepped
alone by `turn`, and the others do not wait.

All numbers lie in one flat buffer, quantity by quantity and lane by lane: only
then does the compiler see that they do not overlap.
"""

from __future__ import annotations

import numpy as np

from zwidth.compiled import Array, compiled
from zwidth.loop.free import free_response
from zwidth.loop.kernel import packed_plant
from zwidth.loop.law import BILATERAL, GATE, HEADER, LIMIT, PHASE, RESOLUTION, STEP
from zwidth.loop.plant import (
    ACTUATOR_WORK,
    COULOMB,
    DIRECTION,
    FORCE,
    GOAL,
    HAND_WORK,
    INSIDE,
    POSITION,
    SATURATED,
    SOURCE_WORK,
    STOPS,
    VELOCITY,
    VISCOUS,
)
from zwidth.loop.summary import DEEPEST, EXTRACTED, HIGHEST, LOWEST, PEAK
from zwidth.loop.turn import Free, turn

LANES = 32
"""Loops in one block: enough to hide the chain of one behind the others."""

# Offsets of the quantities in the buffer.
_X, _V, _SIDE, _HAND, _ACT, _VISC, _DRY, _SOURCE = range(0, 8 * LANES, LANES)
_COUNT, _PHASE, _GAIN, _STEP, _LIMIT, _OPEN = range(8 * LANES, 14 * LANES, LANES)
_DRAG, _FC, _FS, _INV, _HALF, _H, _H1, _H2, _H3, _G1, _G2 = range(14 * LANES, 25 * LANES, LANES)
_LEFT, _INSIDE, _SATURATED, _STOPS = range(25 * LANES, 29 * LANES, LANES)
_DEEP, _PEAK, _OUT, _HIGH, _LOW = range(29 * LANES, 34 * LANES, LANES)
_PUSH, _F, _NEW = range(34 * LANES, 37 * LANES, LANES)
BUFFER = 37 * LANES


@compiled
def run_side_by_side(
    states: Array,
    numbers: Array,
    laws: Array,
    periods: Array,
    late: int,
    force: Array,
    samples: int,
    buffer: Array,
    queue: Array,
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
        F of every interval, samples × LANES.
    buffer, queue
        Scratch: BUFFER and late · LANES long; the queue all 0.
    summaries
        One row per lane, filled in; see `summary`.
    """
    _load(states, numbers, laws, periods, buffer)
    quarter = samples - samples // 4
    slot = 0
    for k in range(samples + 1):
        _take(buffer, force, min(k, samples - 1))
        _measure(buffer)
        if late > 0:
            _delay(buffer, queue, slot)
            slot = 0 if slot == (late - 1) * LANES else slot + LANES
        _watch(buffer, k >= quarter)
        if k == samples:
            break
        if _move(buffer) > 0:
            for i in range(LANES):
                if buffer[_LEFT + i] > 0.0:
                    _alone(buffer, i)
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
        b[_F + i] = bound if over > 0.0 else command
        b[_INSIDE + i] += inside
        b[_SATURATED + i] += over


@compiled
def _move(b: Array) -> int:
    """One interval of the lanes that neither stop nor start in it; returns how many do, and marks them."""
    left = 0
    for i in range(LANES):
        x, v, f, push = b[_X + i], b[_V + i], b[_F + i], b[_PUSH + i]
        side = b[_SIDE + i]
        still = 1.0 if abs(push - f) <= b[_FS + i] else 0.0
        resting = still if side == 0.0 else 0.0
        base = (push - side * b[_FC + i] - b[_DRAG + i] * v) * b[_INV + i]
        v1 = (v + base * b[_H1 + i]) - f * b[_G1 + i]
        goes = 1.0 if v1 * side > 0.0 else 0.0
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
        b[_LEFT + i] = 1.0 - goes - resting
        left += 1 if goes + resting == 0.0 else 0
    return left


@compiled
def _take(b: Array, force: Array, k: int) -> None:
    """The force of the hand in interval k."""
    for i in range(LANES):
        b[_PUSH + i] = force[k, i]


@compiled
def _delay(b: Array, queue: Array, slot: int) -> None:
    """The new command waits in the queue; the one that has waited longest is the force."""
    for i in range(LANES):
        b[_NEW + i] = b[_F + i]
    for i in range(LANES):  # one row to one row each time, in vectors
        b[_F + i] = queue[slot + i]
    for i in range(LANES):
        queue[slot + i] = b[_NEW + i]


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
def _alone(b: Array, i: int) -> None:
    """One interval of lane i, with its stop or its start."""
    free = Free(
        b[_X + i],
        b[_V + i],
        b[_SIDE + i],
        b[_HAND + i],
        b[_ACT + i],
        b[_VISC + i],
        b[_DRY + i],
        b[_SOURCE + i],
    )
    f, push, drag, dry, most = b[_F + i], b[_PUSH + i], b[_DRAG + i], b[_FC + i], b[_FS + i]
    free = turn(free, f, push, drag, dry, most, b[_INV + i], b[_HALF + i], b[_H + i])
    b[_STOPS + i] += abs(b[_SIDE + i])
    b[_X + i], b[_V + i], b[_SIDE + i], b[_HAND + i] = free[0], free[1], free[2], free[3]
    b[_ACT + i], b[_VISC + i], b[_DRY + i], b[_SOURCE + i] = free[4], free[5], free[6], free[7]


@compiled
def _load(states: Array, numbers: Array, laws: Array, periods: Array, b: Array) -> None:
    for i in range(LANES):
        p, law, h = packed_plant(numbers[i, :]), laws[i, :], periods[i]
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
        b[_INSIDE + i] = b[_SATURATED + i] = b[_STOPS + i] = 0.0
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
        states[i, STOPS] = b[_STOPS + i]
        summaries[i, DEEPEST], summaries[i, PEAK], summaries[i, EXTRACTED] = (
            b[_DEEP + i],
            b[_PEAK + i],
            b[_OUT + i],
        )
        summaries[i, HIGHEST], summaries[i, LOWEST] = b[_HIGH + i], b[_LOW + i]
