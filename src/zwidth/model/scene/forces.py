"""The forces of all elements of a scene that are not linear, at one step, together.

    f_i = φ_i(w_i),   w = w° − M f,   M = N G⁻¹ Nᵀ      w° without them

Each φ_i is monotone, the derivative of a convex Φ_i, and the velocities sought are the least of the strictly
convex P(q) = ½ qᵀ G q − rᵀ q + Σ Φ_i(N_i q).  On the iterates q = q° − G⁻¹ Nᵀ λ Newton's step for P is

    (I + S M) δ = φ(w) − λ,   S = diag φ_i'      always solvable: S M has no eigenvalue below 0

and along it the slope of P, Δw·(φ(w + t Δw) − λ − t δ) with Δw = −M δ, rises with t: the step ends where that
is 0.  So P falls in every step, to its least.  Coulomb friction is no function at w = 0: it is taken as
clip(c + w/ε, ±F) and c as the force that was found last, the method of multipliers, until what sticks has
w = 0 (Rockafellar 1976).
"""

from __future__ import annotations

import numpy as np

from zwidth.model.scene.nonlinear import CONTACT, COULOMB
from zwidth.native.compiled import Array, compiled

STEPS = 40
"""Of Newton, and of the multipliers; what is left then is booked."""

CLOSE = 1e-15
"""Of a force, and of the terms of its velocity: rounding."""

_BESIDE = 1e-19
"""Of the largest force: no joule that is booked knows of it."""

_ROUNDING = 1e-12
"""Of the terms of a sum: what is less may be rounding alone."""


@compiled
def coupled_forces(p: Array, at: int, m: Array, states: int, free: int) -> None:
    """f in its place in `m`, begun with that of the step before; w° stands at `free`, then there is room."""
    count, rows, compliance = int(p[at + OTHERS]), at + int(p[at + OTHER_ROWS]), at + int(p[at + COMPLIANCE])
    forces, w = states + count, free + count
    for i in range(count):
        own = p[compliance + i * count + i]
        if p[rows + ROW * i] == COULOMB and own > 0.0:  # alone it is found at once
            most = p[at + int(p[rows + ROW * i + 1])]
            m[states + i] = min(max(m[free + i] / own, -most), most)
            m[forces + i] = m[states + i]
    for _ in range(STEPS):
        least_of(p, at, m, states, free)
        sticks = True
        for i in range(count):
            if p[rows + ROW * i] == COULOMB:
                number = at + int(p[rows + ROW * i + 1])
                f, _slope = mean_force(p, COULOMB, number, m[states + i], m[w + i], p[at + PERIOD])
                _w, terms = velocity(p, at, m, states, free, i)
                sticks = sticks and abs(f - m[states + i]) <= 10.0 * CLOSE * p[number + 1] * terms
                m[states + i] = f
        if sticks:
            return


@compiled
def velocity(p: Array, at: int, m: Array, states: int, free: int, i: int) -> tuple[float, float]:
    """w = w° − M f of one element, and how large what is added up there is."""
    count, compliance = int(p[at + OTHERS]), at + int(p[at + COMPLIANCE])
    taken, terms = 0.0, abs(m[free + i])
    for j in range(count):
        term = p[compliance + i * count + j] * m[states + count + j]
        taken += term
        terms += abs(term)
    return m[free + i] - taken, terms


@compiled
def least_of(p: Array, at: int, m: Array, states: int, free: int) -> None:
    """λ of the least P for the frictions' c as they are, in the place of f; w of it behind w°."""
    count, rows, compliance = int(p[at + OTHERS]), at + int(p[at + OTHER_ROWS]), at + int(p[at + COMPLIANCE])
    forces, period = states + count, p[at + PERIOD]
    w, gap, step, moved = free + count, free + 2 * count, free + 3 * count, free + 4 * count
    matrix = free + 5 * count
    wide = count + 1
    for _ in range(STEPS):
        found, least = True, 0.0
        for i in range(count):  # a contact in the air need not come to 0 beside forces of others
            least = max(least, _BESIDE * abs(m[forces + i]))
        for i in range(count):
            m[w + i], terms = velocity(p, at, m, states, free, i)
            row = rows + ROW * i
            f, slope = mean_force(p, p[row], at + int(p[row + 1]), m[states + i], m[w + i], period)
            if p[compliance + i * count + i] == 0.0:  # the port alone moves it
                m[forces + i] = f
            m[gap + i] = f - m[forces + i]
            found = found and abs(m[gap + i]) <= CLOSE * (abs(f) + slope * terms) + least
            for j in range(count):
                m[matrix + i * wide + j] = slope * p[compliance + i * count + j]
            m[matrix + i * wide + i] += 1.0
            m[matrix + i * wide + count] = m[gap + i]
        if found:
            return
        eliminated(m, matrix, count, step)
        falls, terms = 0.0, 0.0
        for i in range(count):
            taken = 0.0
            for j in range(count):
                term = p[compliance + i * count + j] * m[step + j]
                taken += term
                terms += abs(term * m[gap + i])
            m[moved + i] = -taken
            falls += taken * m[gap + i]
        t = 1.0  # where forces hold each other and nothing moves, the slope of P is rounding, of any sign
        if falls > _ROUNDING * terms:
            t = how_far(p, at, m, states, free)
        for i in range(count):
            m[forces + i] += t * m[step + i]


@compiled
def slope_at(p: Array, at: int, m: Array, states: int, free: int, t: float) -> float:
    """The slope of P along a step, at the part t of it."""
    count, rows = int(p[at + OTHERS]), at + int(p[at + OTHER_ROWS])
    w, step, moved = free + count, free + 3 * count, free + 4 * count
    total = 0.0
    for i in range(count):
        row = rows + ROW * i
        there = m[w + i] + t * m[moved + i]
        f, _slope = mean_force(p, p[row], at + int(p[row + 1]), m[states + i], there, p[at + PERIOD])
        total += m[moved + i] * (f - m[states + count + i] - t * m[step + i])
    return total


@compiled
def how_far(p: Array, at: int, m: Array, states: int, free: int) -> float:
    """The whole step where the slope has fallen to half there; else where it is about 0."""
    first = slope_at(p, at, m, states, free, 0.0)
    low, high = 0.0, 1.0
    last = slope_at(p, at, m, states, free, 1.0)
    while last < 0.5 * first and high < 1e6:
        low, high = high, 2.0 * high
        last = slope_at(p, at, m, states, free, high)
    if last <= -0.5 * first:
        return high
    for _ in range(STEPS):
        t = 0.5 * (low + high)
        here = slope_at(p, at, m, states, free, t)
        if abs(here) <= 0.1 * abs(first):
            return t
        if here < 0.0:
            low = t
        else:
            high = t
    return 0.5 * (low + high)


@compiled
def eliminated(m: Array, matrix: int, count: int, solution: int) -> None:
    """The solution of a linear system with the right side in its last column; rows are exchanged."""
    wide = count + 1
    for k in range(count):
        top = k
        for i in range(k + 1, count):
            if abs(m[matrix + i * wide + k]) > abs(m[matrix + top * wide + k]):
                top = i
        for j in range(k, wide):
            kept = m[matrix + k * wide + j]
            m[matrix + k * wide + j] = m[matrix + top * wide + j]
            m[matrix + top * wide + j] = kept
        for i in range(k + 1, count):
            share = m[matrix + i * wide + k] / m[matrix + k * wide + k]
            for j in range(k, wide):
                m[matrix + i * wide + j] -= share * m[matrix + k * wide + j]
    for i in range(count - 1, -1, -1):
        total = m[matrix + i * wide + count]
        for j in range(i + 1, count):
            total -= m[matrix + i * wide + j] * m[solution + j]
        m[solution + i] = total / m[matrix + i * wide + i]


# The packed scene: T; how many free nodes, linear elements and others; where the rows of the others begin,
# the factor, and N G⁻¹ Nᵀ.  A row is R and g, or a code and where its numbers begin; then two free nodes,
# each with its weight, and the weight of the port.  The factor has of each node where its column of L begins,
# how long that is, and 1/d; a column is places and values in turn.  Of friction the numbers are F and 1/ε.
PERIOD, NODES, LINEAR, OTHERS, OTHER_ROWS, FACTOR, COMPLIANCE = range(7)
HEADER = 7
ROW = 7

# What a scene remembers: the reading, the force and the work of the port, and the energy that is left over;
# then b of each linear element, the state and the force of each other, the velocity and the position of each
# free node, work and loss of each element, and room to compute in.
READING, FORCE, WORK, LEFT_OVER = range(4)
WAVES = 4


def scene_at_rest(p: Array, at: int, reading: float) -> Array:
    """What a scene remembers at rest, its port at a reading; contacts are as far apart as their gaps say."""
    n, linear, k = (int(p[at + i]) for i in (NODES, LINEAR, OTHERS))
    m = np.zeros(WAVES + linear + 2 * k + 2 * n + 2 * (linear + k) + n + k * (k + 6) + 1)
    m[READING] = reading
    for i in range(k):
        code, number = p[at + int(p[at + OTHER_ROWS]) + ROW * i :][:2]
        if code == CONTACT:
            m[WAVES + linear + i] = -p[at + int(number) + 2]
    return m


# The mean force of an element that is not linear over a step at the mean velocity v̄, from its state.
#
#     contact    f̄ = max(0, [½ K δ₊²]/(T v̄) + B [δ₊]/T),   δ₊ = max(0, d), [·] the change over the step
#     friction   f̄ = clip(c + v̄/ε, ±F)             c the force that was found last, see `coupled`
#     points     f̄ = mean of f over d … d + T v̄
#
# All are monotone in v̄.  A contact's damping works on the change of the depth, of the sign of v̄, and where
# the sum would pull there is no force at all: then the spring's energy is lost, and none is made.


@compiled
def mean_force(
    p: Array, code: float, number: int, state: float, w: float, period: float
) -> tuple[float, float]:
    """f̄ and its slope over v̄ at w."""
    if code == CONTACT:
        return contact_force(p, number, state, w, period)
    if code == COULOMB:
        most, f = p[number], state + w * p[number + 1]
        return (f, p[number + 1]) if abs(f) < most else (min(max(f, -most), most), 0.0)
    return spring_force(p, number, state, w, period)


@compiled
def contact_force(p: Array, number: int, depth: float, w: float, period: float) -> tuple[float, float]:
    """Of a contact at the depth d, < 0 in the air."""
    k, b, u = p[number], p[number + 1], period * w
    after = depth + u
    if depth <= 0.0 and after <= 0.0:
        return 0.0, 0.0
    if depth >= 0.0 and after >= 0.0:
        f, slope = k * (depth + 0.5 * u) + b * w, 0.5 * k * period + b
    elif after > 0.0:  # it arrives
        f = 0.5 * k * after * after / u + b * after / period
        slope = period * (k * after / u - 0.5 * k * after * after / (u * u)) + b
    else:  # it leaves
        f = -0.5 * k * depth * depth / u - b * depth / period
        slope = period * 0.5 * k * depth * depth / (u * u)
    return (f, slope) if f > 0.0 else (0.0, 0.0)


@compiled
def contact_spring(p: Array, number: int, depth: float, w: float, period: float) -> float:
    """The same of its spring alone."""
    u = period * w
    after = depth + u
    if depth >= 0.0 and after >= 0.0:
        return p[number] * (depth + 0.5 * u)
    inside = max(depth, after)
    return 0.5 * p[number] * inside * inside / abs(u) if inside > 0.0 else 0.0


@compiled
def spring_at(p: Array, number: int, d: float) -> float:
    """The force of points at a stretch: linear between them, constant beyond."""
    count = int(p[number])
    low, high = number + 1, number + count
    if d <= p[low]:
        return p[low + count]
    if d >= p[high]:
        return p[high + count]
    while high - low > 1:
        middle = (low + high) // 2
        if p[middle] <= d:
            low = middle
        else:
            high = middle
    return p[low + count] + (p[high + count] - p[low + count]) * (d - p[low]) / (p[high] - p[low])


@compiled
def spring_force(p: Array, number: int, d: float, w: float, period: float) -> tuple[float, float]:
    """Of points: the trapezia between those that are passed, and no difference of two energies."""
    u = period * w
    begin, end = min(d, d + u), max(d, d + u)
    if begin == end:
        return spring_at(p, number, d), 0.0
    count = int(p[number])
    area, x, f = 0.0, begin, spring_at(p, number, begin)
    for i in range(count):
        place = p[number + 1 + i]
        if begin < place < end:
            after = p[number + 1 + count + i]
            area += 0.5 * (f + after) * (place - x)
            x, f = place, after
    area += 0.5 * (f + spring_at(p, number, end)) * (end - x)
    mean = area / (end - begin)
    u = d + u - d  # as the positions have it
    return mean, max(0.0, (spring_at(p, number, d + u) - mean) / u * period)


@compiled
def lost(p: Array, code: float, number: int, state: float, w: float, f: float, period: float) -> float:
    """What an element turns into heat in a step, never less than 0 [J]."""
    if code == COULOMB:
        return abs(f * w) * period
    if code == CONTACT:
        return max(0.0, (f - contact_spring(p, number, state, w, period)) * w * period)
    return 0.0


@compiled
def moved_on(code: float, state: float, w: float, period: float) -> float:
    """The state after the step: of friction its force."""
    return state if code == COULOMB else state + period * w


def stored_in(p: Array, code: float, number: int, state: float) -> float:
    """½ K δ² of a contact, 0 of friction, the area below the points of a spring [J]."""
    if code == COULOMB:
        return 0.0
    if code == CONTACT:
        return float(0.5 * p[number] * max(0.0, state) ** 2)
    count = int(p[number])
    x, f = p[number + 1 : number + 1 + count], p[number + 1 + count : number + 1 + 2 * count]
    rest = float(np.interp(0.0, f, x)) if f[0] < 0.0 < f[-1] else float(x[np.abs(f).argmin()])
    low, high = min(rest, state), max(rest, state)
    places = np.array([low, *x[(x > low) & (x < high)], high])
    forces = np.array([spring_at(p, number, place) for place in places])
    return float(abs(np.trapezoid(forces, places)))
