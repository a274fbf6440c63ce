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

from zwidth.model.scene.layout import ROW
from zwidth.model.scene.mean_force import mean_force
from zwidth.model.scene.nonlinear import COULOMB
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
def coupled_forces(
    p: Array,
    at: int,
    rows: int,
    compliance: int,
    count: int,
    m: Array,
    states: int,
    forces: int,
    free: int,
    period: float,
) -> None:
    """f in its place in `m`, begun with that of the step before; w° stands at `free`, then there is room."""
    w = free + count
    for i in range(count):
        own = p[compliance + i * count + i]
        if p[rows + ROW * i] == COULOMB and own > 0.0:  # alone it is found at once
            most = p[at + int(p[rows + ROW * i + 1])]
            m[states + i] = min(max(m[free + i] / own, -most), most)
            m[forces + i] = m[states + i]
    for _ in range(STEPS):
        least_of(p, at, rows, compliance, count, m, states, forces, free, period)
        sticks = True
        for i in range(count):
            if p[rows + ROW * i] == COULOMB:
                number = at + int(p[rows + ROW * i + 1])
                f, _slope = mean_force(p, COULOMB, number, m[states + i], m[w + i], period)
                _w, terms = velocity(p, compliance, count, m, forces, free, i)
                sticks = sticks and abs(f - m[states + i]) <= 10.0 * CLOSE * p[number + 1] * terms
                m[states + i] = f
        if sticks:
            return


@compiled
def velocity(
    p: Array, compliance: int, count: int, m: Array, forces: int, free: int, i: int
) -> tuple[float, float]:
    """w = w° − M f of one element, and how large what is added up there is."""
    taken, terms = 0.0, abs(m[free + i])
    for j in range(count):
        term = p[compliance + i * count + j] * m[forces + j]
        taken += term
        terms += abs(term)
    return m[free + i] - taken, terms


@compiled
def least_of(
    p: Array,
    at: int,
    rows: int,
    compliance: int,
    count: int,
    m: Array,
    states: int,
    forces: int,
    free: int,
    period: float,
) -> None:
    """λ of the least P for the frictions' c as they are, in the place of f; w of it behind w°."""
    w, gap, step, moved = free + count, free + 2 * count, free + 3 * count, free + 4 * count
    matrix = free + 5 * count
    wide = count + 1
    for _ in range(STEPS):
        found, least = True, 0.0
        for i in range(count):  # a contact in the air need not come to 0 beside forces of others
            least = max(least, _BESIDE * abs(m[forces + i]))
        for i in range(count):
            m[w + i], terms = velocity(p, compliance, count, m, forces, free, i)
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
            t = how_far(p, at, rows, count, m, states, forces, w, step, moved, period)
        for i in range(count):
            m[forces + i] += t * m[step + i]


@compiled
def slope_at(
    p: Array,
    at: int,
    rows: int,
    count: int,
    m: Array,
    states: int,
    forces: int,
    w: int,
    step: int,
    moved: int,
    period: float,
    t: float,
) -> float:
    """The slope of P along a step, at the part t of it."""
    total = 0.0
    for i in range(count):
        row = rows + ROW * i
        there = m[w + i] + t * m[moved + i]
        f, _slope = mean_force(p, p[row], at + int(p[row + 1]), m[states + i], there, period)
        total += m[moved + i] * (f - m[forces + i] - t * m[step + i])
    return total


@compiled
def how_far(
    p: Array,
    at: int,
    rows: int,
    count: int,
    m: Array,
    states: int,
    forces: int,
    w: int,
    step: int,
    moved: int,
    period: float,
) -> float:
    """The whole step where the slope has fallen to half there; else where it is about 0."""
    first = slope_at(p, at, rows, count, m, states, forces, w, step, moved, period, 0.0)
    low, high = 0.0, 1.0
    last = slope_at(p, at, rows, count, m, states, forces, w, step, moved, period, 1.0)
    while last < 0.5 * first and high < 1e6:
        low, high = high, 2.0 * high
        last = slope_at(p, at, rows, count, m, states, forces, w, step, moved, period, high)
    if last <= -0.5 * first:
        return high
    for _ in range(STEPS):
        t = 0.5 * (low + high)
        here = slope_at(p, at, rows, count, m, states, forces, w, step, moved, period, t)
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
