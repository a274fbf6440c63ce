"""The forces of all elements of a scene that are not linear, at one step, together.

    f_i = φ_i(w_i),   w = w° − M f,   M = N G⁻¹ Nᵀ      w° without them

Each φ_i is monotone, so that with a_i = w_i + M_ii f_i the force is one nondecreasing function J_i(a_i),
found by bracketed Newton steps or, for friction, at once.  One element is done with that.  Several are the
least of

    ½ fᵀ M f − w°ᵀ f + Σ Φ_i*(f_i),      Φ_i* the conjugate of the potential of φ_i,

convex, and strictly so in each f_i alone: to take them in turn, each at its least, converges always (Tseng
2001).  Between two rounds Newton's step for f = J(w° − (M − D) f) is tried, and kept where it halves the
error; D is the diagonal of M.
"""

from __future__ import annotations

from zwidth.compiled import Array, compiled
from zwidth.scene.layout import ROW
from zwidth.scene.mean_force import mean_force
from zwidth.scene.nonlinear import COULOMB

ROUNDS = 100
"""Then what is left over is booked."""

CLOSE = 1e-15
"""Of the largest force: rounding."""


@compiled
def one_force(
    p: Array, at: int, row: int, state: float, a: float, m_ii: float, period: float
) -> tuple[float, float]:
    """J(a) and its slope: f = φ(a − M_ii f)."""
    code, number = p[row], at + int(p[row + 1])
    if code == COULOMB:
        most = p[number]
        f = min(max(a / m_ii, -most), most)
        return f, 1.0 / m_ii if abs(f) < most else 0.0
    f, slope = mean_force(p, code, number, state, a, 0.0, period)
    if f == 0.0:
        return 0.0, slope / (1.0 + m_ii * slope)
    low, high = min(a, a - m_ii * f), max(a, a - m_ii * f)  # φ is monotone: w lies between
    w = low
    for _ in range(100):
        f, slope = mean_force(p, code, number, state, w, 0.0, period)
        over = w + m_ii * f - a
        if over > 0.0:
            high = w
        else:
            low = w
        after = w - over / (1.0 + m_ii * slope)
        if not low < after < high:
            after = 0.5 * (low + high)
        if after == w or abs(after - w) <= 1e-16 * abs(w):
            break
        w = after
    f, slope = mean_force(p, code, number, state, w, 0.0, period)
    return f, slope / (1.0 + m_ii * slope)


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
    tried, gaps, slopes = free + count, free + 2 * count, free + 3 * count
    matrix = free + 4 * count
    best = -1.0
    for _ in range(ROUNDS):
        change, largest = 0.0, 0.0
        for i in range(count):
            before = m[forces + i]
            a = m[free + i] - others(p, compliance, count, m, forces, i)
            f, _slope = one_force(
                p, at, rows + ROW * i, m[states + i], a, p[compliance + i * count + i], period
            )
            m[forces + i] = f
            change, largest = max(change, abs(f - before)), max(largest, abs(f))
        if count == 1 or change <= CLOSE * largest:
            return
        error = gap(p, at, rows, compliance, count, m, states, forces, free, gaps, slopes, period)
        if best < 0.0 or error < best:
            best = error
        newton(p, compliance, count, m, forces, gaps, slopes, tried, matrix)
        error = gap(p, at, rows, compliance, count, m, states, tried, free, gaps, slopes, period)
        if error <= 0.5 * best:
            best = error
            for i in range(count):
                m[forces + i] = m[tried + i]


@compiled
def others(p: Array, compliance: int, count: int, m: Array, forces: int, i: int) -> float:
    """What the other forces take of w_i."""
    taken = 0.0
    for j in range(count):
        if j != i:
            taken += p[compliance + i * count + j] * m[forces + j]
    return taken


@compiled
def gap(
    p: Array,
    at: int,
    rows: int,
    compliance: int,
    count: int,
    m: Array,
    states: int,
    forces: int,
    free: int,
    gaps: int,
    slopes: int,
    period: float,
) -> float:
    """f − J(w° − (M − D) f) and the slopes of J, each in its place; the largest in magnitude is returned."""
    most = 0.0
    for i in range(count):
        a = m[free + i] - others(p, compliance, count, m, forces, i)
        f, slope = one_force(p, at, rows + ROW * i, m[states + i], a, p[compliance + i * count + i], period)
        m[gaps + i], m[slopes + i] = m[forces + i] - f, slope
        most = max(most, abs(m[gaps + i]))
    return most


@compiled
def newton(
    p: Array,
    compliance: int,
    count: int,
    m: Array,
    forces: int,
    gaps: int,
    slopes: int,
    tried: int,
    matrix: int,
) -> None:
    """[I + J'(M − D)] Δ = −gap, and f + Δ in its place; f where a pivot vanishes, which is then refused."""
    wide = count + 1
    for i in range(count):
        for j in range(count):
            own = p[compliance + i * count + j] * m[slopes + i]
            m[matrix + i * wide + j] = 1.0 if i == j else own
        m[matrix + i * wide + count] = -m[gaps + i]
        m[tried + i] = m[forces + i]
    for k in range(count):
        top = k
        for i in range(k + 1, count):
            if abs(m[matrix + i * wide + k]) > abs(m[matrix + top * wide + k]):
                top = i
        if m[matrix + top * wide + k] == 0.0:
            return
        for j in range(wide):
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
            total -= m[matrix + i * wide + j] * (m[tried + j] - m[forces + j])
        m[tried + i] = m[forces + i] + total / m[matrix + i * wide + i]
