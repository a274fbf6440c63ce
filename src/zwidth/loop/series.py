"""The tied mass: spring, moving anchor, ramping or lagging force, by its power series.

    M v' = G0 + G1 t − D v − k ξ − φ(t),   ξ' = v,   φ' = −φ/τ

On a stretch h with q = h max(D/M, √(k/M), 1/τ) ≤ 1 the series of v, ξ and φ in
u = t/h converge faster than Σ 1/n!, whichever way the motion is damped: about
ten terms reach the last bit at one kilohertz, and over-, under- and critically damped
hands, springs of no stiffness and equal time constants need no cases.  Longer
stretches are cut.  The energies are integrals of products of these series.
"""

from __future__ import annotations

from math import ceil, sqrt

from zwidth.loop.plant import Plant
from zwidth.native.compiled import Array, compiled

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
def first_zero(work: Array, terms: int, sign: float) -> float:
    """The first u in (0, 1] where v is 0, or 2 if there is none; `sign` · v ≥ 0 at first.

    A zero at u = 0, from which the motion starts, is divided out.  With
    |v''| ≤ C on [0, 1] the parabola p + p' δ − C δ²/2 lies below sign · v: its zero
    is never beyond the first zero sought, and the steps to it converge
    quadratically there.
    """
    skip = 0
    while skip < terms - 1 and work[skip] == 0.0:
        skip += 1
    if work[skip] == 0.0:  # forces so small that the series has no digit of them: it stays where it is
        return 2.0
    if sign * work[skip] < 0.0:
        return 0.0
    rest, curve = 0.0, 0.0
    for n in range(terms - skip - 1, 0, -1):
        c = abs(work[skip + n])
        rest += c
        curve += n * (n - 1.0) * c
    if sign * work[skip] > rest:
        return 2.0
    size = abs(work[skip]) + rest
    u = 0.0
    for _ in range(_SEARCH):
        p, slope = 0.0, 0.0
        for n in range(terms - skip - 1, -1, -1):
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
