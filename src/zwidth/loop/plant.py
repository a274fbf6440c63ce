"""The plant of one loop, as the step functions see it, and its motion between events, in closed form.

Device and hand move together:

    M v̇ = G(t) − D v − k (x − x_a(t)) − f_c sgn v,   M = m + m_h,   D = b + c

Everything is float64 in flat arrays, so that thousands of loops lie side by side.
"""

from __future__ import annotations

from math import ceil, sqrt
from typing import NamedTuple

from zwidth.native.compiled import Array, compiled
from zwidth.quantity.elementary import expm1, log1p


class Plant(NamedTuple):
    """What does not change during a simulation, in SI units.

    `lag` is the time constant of the amplifier, 0 for none; `slew` the fastest
    change of the actuator force, 0 for any.
    """

    mass: float
    hand_mass: float
    damping: float
    coulomb: float
    stiction: float
    stiffness: float
    hand_damping: float
    lag: float
    slew: float


class Drive(NamedTuple):
    """What acts on the plant during one stretch, from its beginning at t = 0.

    `force` F, `slack` x_a − x, `speed` ẋ_a; then the external force at rest,

        F_e = external + rate t + transient (1 − e^{−t/lag})

    and `ramp`, the part of −rate that is the actuator's own change df_a/dt.
    """

    force: float
    slack: float
    speed: float
    external: float
    rate: float
    ramp: float
    transient: float


# The state.  DIRECTION is the sign of the velocity, 0 at rest; FORCE the actuator force now, GOAL the
# force it goes to.  From HAND_WORK on: the energies since the start [J].
POSITION, VELOCITY, DIRECTION, FORCE, GOAL = range(5)
HAND_WORK, ACTUATOR_WORK, VISCOUS, COULOMB, SOURCE_WORK, HAND_LOSS = range(5, 11)
STOPS = 11
"""How often the mass came to rest or turned round."""
FAULT = 12
"""Not 0 if the step functions gave up: too many events in one stretch."""
INSIDE, SATURATED = 13, 14
"""How many samples were taken inside the surface; for how many the command went beyond the force limit."""
STATE_SIZE = 15

TOO_MANY_STOPS = (
    "the motion has too many stops in one sample to be followed: device, hand and forces differ by "
    "so many orders of magnitude that rounding decides; scale them closer together"
)


# The free mass: no spring at the hand, a constant force, in closed form.
#
#     M v̇ = G − D v,   G with the Coulomb friction of one direction in it
#
# With a0 = (G − D v0)/M and λ = D/M,
#
#     v = v0 + a0 h1,   Δx = v0 t + a0 h2,   ∫v² = v0² t + 2 v0 a0 h2 + a0² h3
#     h1 = (1 − e^{−λt})/λ,   h2 = ∫h1,   h3 = ∫h1²
#
# and v is monotone, so that it has one zero at most, where h1 = −v0/a0.  For small
# λt the three are power series: the closed forms then lose their digits.


_SERIES_UP_TO = 1.0
_TERMS = 40
_OVER = (0.0, *(1.0 / n for n in range(1, _TERMS + 3)))
"""1/n: a product takes a third of the time of a quotient."""


@compiled
def free_response(rate: float, t: float) -> tuple[float, float, float]:
    """(h1, h2, h3) [s, s², s³] for λ = `rate` ≥ 0 [1/s] and t ≥ 0 [s]."""
    z = rate * t
    if z > _SERIES_UP_TO:
        h1 = -expm1(-z) / rate
        h2 = (t - h1) / rate
        h3 = (t - 2.0 * h1 - expm1(-2.0 * z) / (2.0 * rate)) / (rate * rate)
        return h1, h2, h3
    # h1 = t Σ (−z)ⁿ/(n+1)!,  h2 = t² Σ (−z)ⁿ/(n+2)!,  h3 = t³ Σ (−z)ⁿ (2ⁿ⁺² − 2)/((n+3) (n+2)!)
    s1, s2, s3 = 1.0, 0.5, 1.0 / 3.0
    term, two = 1.0, 4.0  # (−z)ⁿ/(n+1)! and 2ⁿ⁺², at n = 0
    for n in range(1, _TERMS):
        term *= -z * _OVER[n + 1]
        two += two
        further = term * _OVER[n + 2]
        last = further * ((two - 2.0) * _OVER[n + 3])
        s1 += term
        s2 += further
        s3 += last
        if abs(last) < 1e-18:
            break
    return t * s1, t * t * s2, t * t * t * s3


@compiled
def free_stop(rate: float, velocity: float, acceleration: float) -> float:
    """The time at which v0 + a0 h1 is 0 [s], for v0 and a0 of opposite sign.

    The caller knows that there is one: the velocity has changed its sign by then.
    """
    ratio = -velocity / acceleration
    z = rate * ratio
    if z == 0.0:
        return ratio
    if z >= 1.0:  # by rounding only: the asymptote itself
        return ratio * 1e3
    return -ratio * log1p(-z) / z


# An interval of the free mass with a stop or a start in it: under a constant force the velocity is 0 once
# at most, so this is all that can happen.  The same as `step.advance`, to the last bit, without its loop.


class Free(NamedTuple):
    """A free mass and its energies: what an interval changes."""

    position: float
    velocity: float
    side: float
    hand: float
    actuator: float
    viscous: float
    dry: float
    source: float


@compiled
def stop_or_start(
    free: Free,
    force: float,
    push: float,
    drag: float,
    coulomb: float,
    stiction: float,
    inverse: float,
    half_hand: float,
    h: float,
) -> Free:
    """The mass after an interval in which it stops, or in which it starts if it can.

    Parameters
    ----------
    free
        At the beginning: at rest, or its velocity is not 0.
    force, push
        f_a and F [N].
    drag, coulomb, stiction
        b, f_c and f_s.
    inverse, half_hand
        1/M and m_h/2.
    h
        Length of the interval [s].
    """
    left, rate = h, drag * inverse
    if free.side != 0.0:
        base = (push - free.side * coulomb - drag * free.velocity) * inverse
        t = min(h, free_stop(rate, free.velocity, base - force * inverse))
        free = _slid(free, 0.0, force, push, drag, coulomb, inverse, half_hand, t, base, force)
        left = h - t
    external = push - force
    if left <= 0.0 or abs(external) <= stiction:
        return free
    side = 1.0 if external > 0.0 else -1.0
    base = (external - side * coulomb) * inverse  # from rest it may be less than the last digit of either
    return _slid(free, side, force, push, drag, coulomb, inverse, half_hand, left, base, 0.0)


@compiled
def _slid(
    free: Free,
    side_after: float,
    force: float,
    push: float,
    drag: float,
    coulomb: float,
    inverse: float,
    half_hand: float,
    t: float,
    base: float,
    held: float,
) -> Free:
    """After a slide; its acceleration is that of `base` less `held` over the mass."""
    h1, h2, h3 = free_response(drag * inverse, t)
    v0, a0 = free.velocity, base - held * inverse
    v1 = 0.0 if side_after == 0.0 else (v0 + base * h1) - held * (inverse * h1)
    ahead = v0 * t + base * h2
    moved = ahead - held * (inverse * h2)
    squares = v0 * v0 * t + 2.0 * v0 * a0 * h2 + a0 * a0 * h3
    return Free(
        (free.position + ahead) - held * (inverse * h2),
        v1,
        side_after,
        free.hand + (push * moved - half_hand * (v1 - v0) * (v1 + v0)),
        free.actuator - force * moved,
        free.viscous + drag * squares,
        free.dry + coulomb * abs(moved),
        free.source + push * moved,
    )


# The tied mass: spring, moving anchor, ramping or lagging force, by its power series.
#
#     M v' = G0 + G1 t − D v − k ξ − φ(t),   ξ' = v,   φ' = −φ/τ
#
# On a stretch h with q = h max(D/M, √(k/M), 1/τ) ≤ 1 the series of v, ξ and φ in
# u = t/h converge faster than Σ 1/n!, whichever way the motion is damped: about
# ten terms reach the last bit at one kilohertz, and over-, under- and critically damped
# hands, springs of no stiffness and equal time constants need no cases.  Longer
# stretches are cut.  The energies are integrals of products of these series.


TERMS = 28
"""Room for the coefficients of one series; 24 of them are below 1e-23."""

KEPT = 4 * TERMS
WORK = KEPT + 5
"""Length of the scratch array: the coefficients of v, ξ, φ and of a product, and what `step` keeps."""

_ROUNDING = 2.3e-16
_SEARCH = 200


@compiled
def pieces(plant: Plant, h: float) -> float:
    """Into how many parts a stretch of h seconds is cut for the series."""
    mass = plant.mass + plant.hand_mass
    q = max((plant.damping + plant.hand_damping) / mass, sqrt(plant.stiffness / mass)) * h
    if plant.lag > 0.0:
        q = max(q, h / plant.lag)
    return max(1.0, ceil(q))


@compiled
def expand(plant: Plant, v0: float, net: float, ramp: float, transient: float, h: float, work: Array) -> int:
    """Fill `work` with the coefficients of v, ξ and φ; returns how many of each.

    `net` G0 − φ(0) [N], `ramp` G1 [N/s], `transient` φ(0) [N].
    """
    mass = plant.mass + plant.hand_mass
    drag = plant.damping + plant.hand_damping
    scale = h / mass
    v, x, p = 0, TERMS, 2 * TERMS
    work[v], work[x], work[p] = v0, 0.0, transient
    size, small = abs(v0) * h, 0
    given = net
    for n in range(TERMS - 1):
        work[v + n + 1] = scale * (given - drag * work[v + n] - plant.stiffness * work[x + n]) / (n + 1.0)
        work[x + n + 1] = h * work[v + n] / (n + 1.0)
        work[p + n + 1] = -h * work[p + n] / (plant.lag * (n + 1.0)) if plant.lag > 0.0 else 0.0
        given = (ramp * h if n == 0 else 0.0) - work[p + n + 1]
        term = max(abs(work[v + n + 1]) * h, abs(work[x + n + 1]))
        if transient != 0.0:
            term = max(term, scale * h * abs(work[p + n + 1]))
        size = max(size, term)
        small = small + 1 if term <= 1e-19 * size else 0
        if small >= 3:
            return n + 2
    return TERMS


@compiled
def value(work: Array, start: int, terms: int, u: float) -> float:
    """Σ cₙ uⁿ."""
    total = 0.0
    for n in range(terms - 1, -1, -1):
        total = total * u + work[start + n]
    return total


@compiled
def integral(work: Array, start: int, terms: int, u: float) -> float:
    """∫₀ᵘ Σ cₙ uⁿ."""
    total = 0.0
    for n in range(terms - 1, -1, -1):
        total = total * u + work[start + n] / (n + 1.0)
    return total * u


@compiled
def product_integral(work: Array, first: int, second: int, terms: int, u: float) -> float:
    """∫₀ᵘ of the product of two series, each term of it integrated."""
    total = 0.0
    for m in range(2 * terms - 2, -1, -1):
        c = 0.0
        low = m - terms + 1 if m >= terms else 0
        high = m if m < terms else terms - 1
        for i in range(low, high + 1):
            c += work[first + i] * work[second + m - i]
        total = total * u + c / (m + 1.0)
    return total * u


@compiled
def first_zero(work: Array, start: int, terms: int, sign: float) -> float:
    """The first u in (0, 1] where v is 0, or 2 if there is none; `sign` · v ≥ 0 at first.

    A zero at u = 0, from which the motion starts, is divided out.  With
    |v''| ≤ C on [0, 1] the parabola p + p' δ − C δ²/2 lies below sign · v: its zero
    is never beyond the first zero sought, and the steps to it converge
    quadratically there.
    """
    skip = start
    while skip < start + terms - 1 and work[skip] == 0.0:
        skip += 1
    if work[skip] == 0.0:  # forces so small that the series has no digit of them: it stays where it is
        return 2.0
    if sign * work[skip] < 0.0:
        return 0.0
    rest, curve = 0.0, 0.0
    for n in range(start + terms - skip - 1, 0, -1):
        c = abs(work[skip + n])
        rest += c
        curve += n * (n - 1.0) * c
    if sign * work[skip] > rest:
        return 2.0
    size = abs(work[skip]) + rest
    u = 0.0
    for _ in range(_SEARCH):
        p, slope = 0.0, 0.0
        for n in range(start + terms - skip - 1, -1, -1):
            slope = slope * u + p
            p = p * u + sign * work[skip + n]
        if p <= _ROUNDING * size and slope < 0.0:
            return u
        below = sqrt(slope * slope + 2.0 * curve * max(p, 0.0))
        if slope < 0.0:
            step = 2.0 * p / (below - slope)
        elif curve > 0.0:
            step = (slope + below) / curve
        else:
            return 2.0
        if u + step > 1.0:
            return 2.0
        if u + step == u:
            return u
        u += step
    return 2.0
