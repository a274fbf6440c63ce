"""One stretch of motion under given forces: slide, stop, stick, break away, turn round.

At rest the net external force F_e = F + k (x_a − x) + c ẋ_a − f_a is balanced by
friction up to the stiction f_s; beyond it the mass slides, against f_c sgn v,
until its velocity is 0 again.  Each of these events is found where it happens;
between two of them the motion has a closed form.
"""

from __future__ import annotations

from math import exp, log

from zwidth.loop.compiled import compiled
from zwidth.loop.free import free_response, free_stop
from zwidth.loop.ledger import book, book_rest
from zwidth.loop.plant import (
    DIRECTION,
    FAULT,
    FORCE,
    GOAL,
    POSITION,
    STOPS,
    VELOCITY,
    Plant,
)
from zwidth.loop.series import (
    TERMS,
    expand,
    first_zero,
    integral,
    pieces,
    product_integral,
    value,
)

_MOST_EVENTS = 100_000
_BISECTIONS = 200


@compiled
def advance(state, plant: Plant, force: float, anchor: float, anchor_speed: float, h: float, work) -> None:
    """Move the plant by h seconds under a constant hand force and an anchor at constant speed.

    Parameters
    ----------
    state
        Changed in place; see `plant`.
    force
        F of the hand [N].
    anchor
        x_a at the beginning [m].
    anchor_speed
        ẋ_a [m/s].
    h
        ≥ 0 [s].
    work
        Scratch, `series.WORK` long.
    """
    elapsed = 0.0
    for _ in range(_MOST_EVENTS):
        left = h - elapsed
        if left <= 0.0:
            return
        ramp, reach = _slewing(state, plant)
        ending = reach <= left  # the force reaches its goal inside
        if ending:
            left = reach
        here = anchor + anchor_speed * elapsed
        used = _stretch(state, plant, force, here, anchor_speed, ramp, left, work)
        if plant.lag > 0.0:
            state[FORCE] = state[GOAL] + (state[FORCE] - state[GOAL]) * exp(-used / plant.lag)
        elif ramp != 0.0:
            state[FORCE] = state[GOAL] if ending and used == left else state[FORCE] + ramp * used
        elapsed = h if used == left and not ending else elapsed + used
    state[FAULT] = 1.0


@compiled
def _slewing(state, plant: Plant) -> tuple[float, float]:
    """(df_a/dt, time until the goal): a force that a limited voltage drives; (0, ∞) otherwise."""
    gap = state[GOAL] - state[FORCE]
    if plant.slew == 0.0 or gap == 0.0:
        return 0.0, 1e300
    return (plant.slew, gap / plant.slew) if gap > 0.0 else (-plant.slew, -gap / plant.slew)


@compiled
def _stretch(state, plant: Plant, force, anchor, speed, ramp, h, work) -> float:
    """Move by at most h seconds, up to the first stop; returns the time used."""
    slack = anchor - state[POSITION]
    transient = state[FORCE] - state[GOAL] if plant.lag > 0.0 else 0.0
    settled = state[GOAL] if plant.lag > 0.0 else state[FORCE]
    push = force + plant.stiffness * slack + plant.hand_damping * speed - settled
    rate = plant.stiffness * speed - ramp
    if state[DIRECTION] == 0.0:
        now = push - transient
        if abs(now) <= plant.stiction:
            wait, side = breakaway(push, rate, transient, plant.lag, plant.stiction, h)
            book_rest(state, plant, slack, speed, wait)
            state[DIRECTION] = side
            return wait
        state[DIRECTION] = 1.0 if now > 0.0 else -1.0
    if rate == 0.0 and transient == 0.0 and plant.stiffness == 0.0:
        return _slide_free(state, plant, force, speed, slack, push, h)
    return _slide_tied(state, plant, force, speed, slack, push, rate, transient, h, work)


@compiled
def breakaway(push, rate, transient, lag, stiction, h) -> tuple[float, float]:
    """When |push + rate t − transient e^{−t/lag}| exceeds the stiction: (time, side), or (h, 0).

    At t = 0 it does not.  The force has one turning point at most.
    """
    if rate == 0.0 and transient == 0.0:
        return h, 0.0
    turn = h
    if transient != 0.0 and rate != 0.0 and -transient / (lag * rate) > 0.0:
        turn = min(h, max(0.0, lag * log(-transient / (lag * rate))))
    start = 0.0
    for end in (turn, h):
        if end > start or end == h:
            level = _external(push, rate, transient, lag, end)
            if abs(level) > stiction:
                side = 1.0 if level > 0.0 else -1.0
                return _crossing(push, rate, transient, lag, stiction * side, side, start, end), side
            start = end
    return h, 0.0


@compiled
def _external(push, rate, transient, lag, t) -> float:
    fading = transient * exp(-t / lag) if lag > 0.0 else 0.0
    return push + rate * t - fading


@compiled
def _crossing(push, rate, transient, lag, level, side, start, end) -> float:
    """The time in [start, end] at which the monotone external force passes `level`."""
    if transient == 0.0:
        return min(end, max(start, (level - push) / rate))
    for _ in range(_BISECTIONS):
        middle = 0.5 * (start + end)
        if middle <= start or middle >= end:
            break
        if side * (_external(push, rate, transient, lag, middle) - level) > 0.0:
            end = middle
        else:
            start = middle
    return end


@compiled
def _slide_free(state, plant: Plant, force, speed, slack, push, h) -> float:
    mass = plant.mass + plant.hand_mass
    drag = plant.damping + plant.hand_damping
    side, v0 = state[DIRECTION], state[VELOCITY]
    a0 = (push - side * plant.coulomb - drag * v0) / mass
    lam = drag / mass
    t = h
    h1, h2, h3 = free_response(lam, t)
    v1 = v0 + a0 * h1
    stopped = v1 * side <= 0.0 and a0 * side < 0.0
    if stopped:
        t = min(h, free_stop(lam, v0, a0))
        h1, h2, h3 = free_response(lam, t)
        v1 = 0.0
    moved = v0 * t + a0 * h2
    squares = v0 * v0 * t + 2.0 * v0 * a0 * h2 + a0 * a0 * h3
    pull = state[FORCE] * moved
    book(state, plant, force, slack, speed, t, moved, 0.0, squares, pull, v0, v1)
    state[POSITION] += moved
    state[VELOCITY] = v1
    if stopped:
        _stop(state)
    return t


@compiled
def _slide_tied(state, plant: Plant, force, speed, slack, push, rate, transient, h, work) -> float:
    t = h / pieces(plant, h)
    side, v0 = state[DIRECTION], state[VELOCITY]
    if v0 == 0.0 and abs(push - transient) <= plant.stiction:  # it has just broken away
        push = side * (plant.stiction - plant.coulomb) + transient
    else:
        push -= side * plant.coulomb
    terms = expand(plant, v0, push, rate, transient, t, work)
    u = first_zero(work, terms, side)
    stopped = u <= 1.0
    if not stopped:
        u = 1.0
    v1 = value(work, 0, terms, u)
    if stopped or v1 * side <= 0.0:
        stopped, v1 = True, 0.0
    moved = value(work, TERMS, terms, u)
    squares = t * product_integral(work, 0, 0, terms, u)
    area = t * integral(work, TERMS, terms, u)
    used = h if u == 1.0 and t == h else u * t
    pull = _actuator_pull(state, plant, rate, speed, transient, moved, area, used, terms, u, work, t)
    book(state, plant, force, slack, speed, used, moved, area, squares, pull, v0, v1)
    state[POSITION] += moved
    state[VELOCITY] = v1
    if stopped:
        _stop(state)
    return used


@compiled
def _actuator_pull(state, plant: Plant, rate, speed, transient, moved, area, used, terms, u, work, t) -> float:
    """∫ f_a v dt of a constant, ramping or lagging force."""
    if plant.lag > 0.0:
        return state[GOAL] * moved + t * product_integral(work, 0, 2 * TERMS, terms, u)
    ramp = plant.stiffness * speed - rate
    return state[FORCE] * moved + ramp * (used * moved - area)


@compiled
def _stop(state) -> None:
    state[DIRECTION] = 0.0
    state[STOPS] += 1.0

