"""One step of a scene: the port has moved, its mean force over the step comes out.

    G q = −Σ α (b + R c v) − Nᵀ f      v of the port; q the free nodes, G = L D Lᵀ
    f = φ(N q + c v)                   the elements that are not linear
    F = Σ c f̄                          what the port feels

The scene is packed into one array of doubles, what it remembers into another.  Nothing is allocated, and the
step depends on nothing but these.
"""

from __future__ import annotations

from zwidth.model.scene.forces import (
    FACTOR,
    FORCE,
    HEADER,
    LEFT_OVER,
    LINEAR,
    NODES,
    OTHER_ROWS,
    OTHERS,
    PERIOD,
    READING,
    ROW,
    WAVES,
    WORK,
    coupled_forces,
    lost,
    mean_force,
    moved_on,
)
from zwidth.native.compiled import Array, compiled


@compiled
def across(p: Array, row: int, m: Array, nodes: int, v: float) -> float:
    """v̄ across an element: α q_i + β q_j + c v."""
    i, j = int(p[row + 2]), int(p[row + 4])
    return p[row + 3] * m[nodes + i] + p[row + 5] * m[nodes + j] + p[row + 6] * v


@compiled
def put(p: Array, row: int, m: Array, nodes: int, force: float) -> None:
    """The force of an element on its nodes, against their motion."""
    i, j = int(p[row + 2]), int(p[row + 4])
    m[nodes + i] -= p[row + 3] * force
    m[nodes + j] -= p[row + 5] * force


@compiled
def solve(p: Array, at: int, factor: int, count: int, m: Array, nodes: int) -> None:
    """q = G⁻¹ r in place of r."""
    for i in range(count):
        begin = at + int(p[factor + 3 * i])
        for pair in range(begin, begin + 2 * int(p[factor + 3 * i + 1]), 2):
            m[nodes + int(p[pair])] -= p[pair + 1] * m[nodes + i]
        # what is below needs r_i as it is here; D is put in on the way back
    for i in range(count - 1, -1, -1):
        q = m[nodes + i] * p[factor + 3 * i + 2]
        begin = at + int(p[factor + 3 * i])
        for pair in range(begin, begin + 2 * int(p[factor + 3 * i + 1]), 2):
            q -= p[pair + 1] * m[nodes + int(p[pair])]
        m[nodes + i] = q


@compiled
def scene_force(p: Array, at: int, m: Array, slot: int, reading: float) -> float:
    """The mean force over the step that ends at a reading of the port; what is remembered moves on."""
    period, count = p[at + PERIOD], int(p[at + NODES])
    linear, others = int(p[at + LINEAR]), int(p[at + OTHERS])
    rows, other_rows = at + HEADER, at + int(p[at + OTHER_ROWS])
    factor = at + int(p[at + FACTOR])
    waves = slot + WAVES
    states = waves + linear
    forces = states + others
    nodes = forces + others
    places = nodes + count
    work = places + count
    loss = work + linear + others
    room = loss + linear + others
    v = (reading - m[slot + READING]) / period
    m[slot + READING] = reading
    # the nodes as the linear elements alone would move them
    for i in range(count):
        m[nodes + i] = 0.0
    for e in range(linear):
        row = rows + ROW * e
        put(p, row, m, nodes, m[waves + e] + p[row] * p[row + 6] * v)
    if others > 0:
        for i in range(count):
            m[room + i] = m[nodes + i]
        solve(p, at, factor, count, m, nodes)
        free = room + count
        for e in range(others):
            m[free + e] = across(p, other_rows + ROW * e, m, nodes, v)
        coupled_forces(p, at, m, states, free)
        for i in range(count):
            m[nodes + i] = m[room + i]
        for e in range(others):
            put(p, other_rows + ROW * e, m, nodes, m[forces + e])
    solve(p, at, factor, count, m, nodes)
    # each element takes in what its own force does; what is not its own is left over
    felt, given = 0.0, 0.0
    for e in range(linear):
        row = rows + ROW * e
        w = across(p, row, m, nodes, v)
        f = p[row] * w + m[waves + e]
        felt += p[row + 6] * f
        energy = f * w * period
        given += energy
        m[work + e] += energy
        if p[row + 1] == 0.0:
            m[loss + e] += energy
        m[waves + e] = p[row + 1] * (f + p[row] * w)
    for e in range(others):
        row = other_rows + ROW * e
        w = across(p, row, m, nodes, v)
        state, number = m[states + e], at + int(p[row + 1])
        felt += p[row + 6] * m[forces + e]
        own, _slope = mean_force(p, p[row], number, state, w, period)
        given += own * w * period
        m[work + linear + e] += own * w * period
        m[loss + linear + e] += lost(p, p[row], number, state, w, own, period)
        m[states + e] = moved_on(p[row], state, w, period)
    for i in range(count):
        m[places + i] += period * m[nodes + i]
    taken = felt * v * period
    m[slot + LEFT_OVER] += taken - given
    m[slot + WORK] += taken
    m[slot + FORCE] = felt
    return felt
