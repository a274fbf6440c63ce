"""One stretch of motion and its energies: slide, stop, stick, break away, turn round; or as prescribed.

At rest the net external force F_e = F + k (x_a − x) + c ẋ_a − f_a is balanced by friction up to the stiction
f_s; beyond it the mass slides, against f_c sgn v, until its velocity is 0 again.  Each of these events is
found where it happens; between two of them the motion has a closed form.
"""

from __future__ import annotations

from typing import NamedTuple

from zwidth.loop.plant import (
    ACTUATOR_WORK,
    COULOMB,
    DIRECTION,
    FAULT,
    FORCE,
    GOAL,
    HAND_LOSS,
    HAND_WORK,
    KEPT,
    POSITION,
    SOURCE_WORK,
    STOPS,
    TERMS,
    VELOCITY,
    VISCOUS,
    Drive,
    Plant,
    expand,
    first_zero,
    free_response,
    free_stop,
    integral,
    pieces,
    product_integral,
    value,
)
from zwidth.native.compiled import Array, compiled
from zwidth.quantity.elementary import exp, expm1, log

_MOST_EVENTS = 100_000
_BISECTIONS = 200
ROUNDING = 4 * 2.3e-16
"""Of the sum of forces, relative to their sizes."""


@compiled
def advance(
    state: Array, plant: Plant, force: float, anchor: float, anchor_speed: float, h: float, work: Array
) -> None:
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
        Scratch, `plant.WORK` long.
    """
    elapsed = 0.0
    for _ in range(_MOST_EVENTS):
        left = h - elapsed
        if left <= 0.0:
            return
        ramp, reach = slewing(state, plant)
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
def is_free(plant: Plant) -> bool:
    """True where nothing but a force moves the mass, and the amplifier gives its force at once."""
    return plant.stiffness == 0.0 and plant.hand_damping == 0.0 and plant.lag == 0.0 and plant.slew == 0.0


class Response(NamedTuple):
    """Of a free mass over a whole interval: 1/M, h1, h2, h3 of `free_response`, h1/M, h2/M."""

    inverse: float
    h1: float
    h2: float
    h3: float
    g1: float
    g2: float


@compiled
def response_of(plant: Plant, h: float) -> Response:
    """The response over h seconds; all 0 of an interval of none."""
    if h == 0.0:
        return Response(0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    inverse = 1.0 / (plant.mass + plant.hand_mass)
    h1, h2, h3 = free_response(plant.damping * inverse, h)
    return Response(inverse, h1, h2, h3, inverse * h1, inverse * h2)


@compiled
def glide(
    state: Array, plant: Plant, response: Response, f: float, force: float, h: float, work: Array
) -> None:
    """`advance` of a mass that is free."""
    v0, side = state[VELOCITY], state[DIRECTION]
    if side == 0.0 and abs(force - f) <= plant.stiction:
        return
    inverse, h1, h2, h3, g1, g2 = response
    base = (force - side * plant.coulomb - plant.damping * v0) * inverse
    v1 = (v0 + base * h1) - f * g1
    if v1 * side > 0.0:
        ahead, back = v0 * h + base * h2, f * g2
        a0, moved = base - f * inverse, ahead - back
        state[POSITION] = (state[POSITION] + ahead) - back
        state[VELOCITY] = v1
        state[VISCOUS] += plant.damping * (v0 * v0 * h + 2.0 * v0 * a0 * h2 + a0 * a0 * h3)
        state[COULOMB] += plant.coulomb * abs(moved)
        state[ACTUATOR_WORK] -= f * moved
        state[HAND_WORK] += force * moved - 0.5 * plant.hand_mass * (v1 - v0) * (v1 + v0)
        state[SOURCE_WORK] += force * moved
    else:
        advance(state, plant, force, 0.0, 0.0, h, work)


@compiled
def slewing(state: Array, plant: Plant) -> tuple[float, float]:
    """(df_a/dt, time until the goal): a force that a limited voltage drives; (0, ∞) otherwise."""
    gap = state[GOAL] - state[FORCE]
    if plant.slew == 0.0 or gap == 0.0:
        return 0.0, 1e300
    return (plant.slew, gap / plant.slew) if gap > 0.0 else (-plant.slew, -gap / plant.slew)


@compiled
def _stretch(
    state: Array, plant: Plant, force: float, anchor: float, speed: float, ramp: float, h: float, work: Array
) -> float:
    """Move by at most h seconds, up to the first stop; returns the time used."""
    slack = anchor - state[POSITION]
    transient = state[FORCE] - state[GOAL] if plant.lag > 0.0 else 0.0
    pull, drag = plant.stiffness * slack, plant.hand_damping * speed
    external = force + pull + drag - state[FORCE]
    drive = Drive(force, slack, speed, external, plant.stiffness * speed - ramp, ramp, transient)
    if state[DIRECTION] == 0.0:
        size = abs(force) + abs(pull) + abs(drag) + abs(state[FORCE]) + abs(state[GOAL])
        if _holds(drive, plant, ROUNDING * size):
            return _rest(state, plant, drive, h)
        state[DIRECTION] = 1.0 if external > 0.0 else -1.0
    if drive.rate == 0.0 and transient == 0.0 and plant.stiffness == 0.0:
        return _slide_free(state, plant, drive, h, work)
    return _slide_tied(state, plant, drive, h, work)


@compiled
def _holds(drive: Drive, plant: Plant, rounding: float) -> bool:
    """True where friction holds a mass at rest: |F_e| ≤ f_s; or F_e falls, and is beyond by rounding only.

    Such a mass would stop again before any of the forces has changed in its last digit.
    """
    beyond = abs(drive.external) - plant.stiction
    if beyond <= 0.0:
        return True
    slope = drive.rate + (drive.transient / plant.lag if plant.lag > 0.0 else 0.0)
    falls = slope < 0.0 if drive.external > 0.0 else slope > 0.0
    return beyond <= rounding and falls


@compiled
def _rest(state: Array, plant: Plant, drive: Drive, h: float) -> float:
    wait, side = breakaway(drive, plant, h)
    book_rest(state, plant, drive, wait)
    state[DIRECTION] = side if wait < h else 0.0  # what comes after h may hold it
    return wait


@compiled
def breakaway(drive: Drive, plant: Plant, h: float) -> tuple[float, float]:
    """When |F_e| exceeds what holds the mass at t = 0, the stiction: (time, side), or (h, 0).

    F_e has one turning point at most.
    """
    rate, transient, lag = drive.rate, drive.transient, plant.lag
    if rate == 0.0 and transient == 0.0:
        return h, 0.0
    held = max(plant.stiction, abs(drive.external))
    turn = h
    if transient != 0.0 and rate != 0.0 and -transient / (lag * rate) > 0.0:
        turn = min(h, max(0.0, lag * log(-transient / (lag * rate))))
    start = 0.0
    for end in (turn, h):
        level = _external(drive, lag, end)
        if abs(level) > held:
            side = 1.0 if level > 0.0 else -1.0
            return _crossing(drive, lag, held * side, side, start, end), side
        start = end
    return h, 0.0


@compiled
def _external(drive: Drive, lag: float, t: float) -> float:
    faded = drive.transient * expm1(-t / lag) if lag > 0.0 else 0.0
    return drive.external + drive.rate * t - faded


@compiled
def _crossing(drive: Drive, lag: float, level: float, side: float, start: float, end: float) -> float:
    """The time in [start, end] at which the monotone external force passes `level`."""
    if drive.transient == 0.0:
        return min(end, max(start, (level - drive.external) / drive.rate))
    for _ in range(_BISECTIONS):
        middle = 0.5 * (start + end)
        if middle <= start or middle >= end:
            break
        if side * (_external(drive, lag, middle) - level) > 0.0:
            end = middle
        else:
            start = middle
    return end


@compiled
def _slide_free(state: Array, plant: Plant, drive: Drive, h: float, work: Array) -> float:
    inverse = 1.0 / (plant.mass + plant.hand_mass)
    drag = plant.damping + plant.hand_damping
    side, v0, f = state[DIRECTION], state[VELOCITY], state[FORCE]
    if v0 == 0.0:  # from rest: what friction leaves may be less than the last digit of either force
        base, held = (drive.external - side * plant.coulomb) * inverse, 0.0
    else:
        others = drive.force + plant.hand_damping * drive.speed - side * plant.coulomb - drag * v0
        base, held = others * inverse, f  # the actuator's part comes last: its force is known last
    a0 = base - held * inverse
    t = h
    h1, h2, h3 = _kept_response(drag * inverse, t, work)
    v1 = (v0 + base * h1) - held * (inverse * h1)
    stopped = v1 * side <= 0.0 and a0 * side < 0.0
    if stopped:
        t = min(h, free_stop(drag * inverse, v0, a0))
        h1, h2, h3 = free_response(drag * inverse, t)
        v1 = 0.0
    ahead = v0 * t + base * h2
    moved = ahead - held * (inverse * h2)
    squares = v0 * v0 * t + 2.0 * v0 * a0 * h2 + a0 * a0 * h3
    book(state, plant, drive, t, moved, 0.0, squares, f * moved, v0, v1)
    _arrive(state, (state[POSITION] + ahead) - held * (inverse * h2), v1, stopped)
    return t


@compiled
def _kept_response(rate: float, t: float, work: Array) -> tuple[float, float, float]:
    """`free_response`, and that of the interval before where it is the same: with a regular clock, always."""
    if work[KEPT] != rate or work[KEPT + 1] != t:
        work[KEPT], work[KEPT + 1] = rate, t
        work[KEPT + 2], work[KEPT + 3], work[KEPT + 4] = free_response(rate, t)
    return work[KEPT + 2], work[KEPT + 3], work[KEPT + 4]


@compiled
def _slide_tied(state: Array, plant: Plant, drive: Drive, h: float, work: Array) -> float:
    length = h / pieces(plant, h)
    side, v0 = state[DIRECTION], state[VELOCITY]
    net = drive.external - side * plant.coulomb
    if v0 == 0.0 and side * drive.external <= plant.stiction:  # it has just broken away
        net = side * (plant.stiction - plant.coulomb)
    terms = expand(plant, v0, net, drive.rate, drive.transient, length, work)
    u = first_zero(work, 0, terms, side)
    stopped = u <= 1.0
    if not stopped:
        u = 1.0
    t = length if u == 1.0 else u * length
    v1 = value(work, 0, terms, u)
    if stopped or v1 * side <= 0.0:
        stopped, v1 = True, 0.0
    moved = value(work, TERMS, terms, u)
    squares = length * product_integral(work, 0, 0, terms, u)
    area = length * integral(work, TERMS, terms, u)
    if plant.lag > 0.0:
        pull = state[GOAL] * moved + length * product_integral(work, 0, 2 * TERMS, terms, u)
    else:
        pull = state[FORCE] * moved + drive.ramp * (t * moved - area)
    book(state, plant, drive, t, moved, area, squares, pull, v0, v1)
    _arrive(state, state[POSITION] + moved, v1, stopped)
    return t


@compiled
def _arrive(state: Array, position: float, velocity: float, stopped: bool) -> None:
    state[POSITION] = position
    state[VELOCITY] = velocity
    if stopped:
        state[DIRECTION] = 0.0
        state[STOPS] += 1.0


# The energies of one stretch, by closed form.
#
# With Δx the distance, t the time, Q = ∫v² dt, A = ∫ξ dt (ξ from the start of the
# stretch), e0 the slack x_a − x at the start and u the speed of the anchor,
#
#     viscous   b Q           Coulomb   f_c |Δx|        actuator   −∫ f_a v dt
#     spring on the device    ∫ k e v = k [Δx (e0 − Δx/2) + u (t Δx − A)]
#     damper on the device    ∫ c (u − v) v = c (u Δx − Q)
#     the hand's own mass     −m_h (v1² − v0²)/2
#     anchor, by the muscles  u ∫ (k e + c (u − v)) = u [k (e0 t + u t²/2 − A) + c (u t − Δx)]
#     hand's damper           c ∫ (u − v)² = c (u² t − 2 u Δx + Q)


@compiled
def book(
    state: Array,
    plant: Plant,
    drive: Drive,
    t: float,
    moved: float,
    area: float,
    squares: float,
    pull: float,
    v0: float,
    v1: float,
) -> None:
    """Add the energies of a stretch of sliding to the state; `pull` is ∫ f_a v dt."""
    k, c = plant.stiffness, plant.hand_damping
    slack, speed = drive.slack, drive.speed
    state[VISCOUS] += plant.damping * squares
    state[COULOMB] += plant.coulomb * abs(moved)
    state[ACTUATOR_WORK] -= pull
    spring = k * (moved * (slack - 0.5 * moved) + speed * (t * moved - area))
    damper = c * (speed * moved - squares)
    inertia = 0.5 * plant.hand_mass * (v1 - v0) * (v1 + v0)
    state[HAND_WORK] += drive.force * moved + spring + damper - inertia
    anchor = speed * (k * (slack * t + 0.5 * speed * t * t - area) + c * (speed * t - moved))
    state[SOURCE_WORK] += drive.force * moved + anchor
    state[HAND_LOSS] += c * (speed * speed * t - 2.0 * speed * moved + squares)


@compiled
def book_rest(state: Array, plant: Plant, drive: Drive, t: float) -> None:
    """Add the energies of a stretch at rest: only the anchor moves."""
    k, c, speed = plant.stiffness, plant.hand_damping, drive.speed
    state[SOURCE_WORK] += speed * (k * (drive.slack * t + 0.5 * speed * t * t) + c * speed * t)
    state[HAND_LOSS] += c * speed * speed * t


# A stretch whose motion is prescribed: constant velocity, after an impulse of the hand on the mass; then
# the hand works against the actuator, f_c sgn v and b v.


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
