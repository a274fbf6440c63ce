"""Recursive least squares, a step per sample, compiled.

    ε = F − φᵀθ,   L = P ζ/(λ + φᵀ P ζ),   θ ← θ + L ε,   P ← (P − L φᵀ P)/λ

φ = (−F₋₁, u, u₋₁) is what F is regressed on, ζ the instruments:

    least squares     φ with the measured F₋₁,    ζ = φ
    instrumental      φ with the measured F₋₁,    ζ with the F̂₋₁ of a model run beside, free of the noise
    output error      φ with the model's F̂₋₁,     ζ = φ

The model run beside is F̂ = −p F̂₋₁ + b0 u + b1 u₋₁ with the admissible parameters of the moment.  u = max(x, 0); only
where this sample and the last are inside is anything learnt.
"""

from __future__ import annotations

from math import exp, expm1, log

from zwidth.compiled import Array, compiled

LEAST_SQUARES, INSTRUMENTAL, OUTPUT_ERROR = 0.0, 1.0, 2.0
RAMP, BILINEAR, BACKWARD = 0.0, 1.0, 2.0

# the numbers of a tracker
FORGETTING, DEAD_ZONE, LARGEST_TRACE, METHOD, RULE, PERIOD, SCALE, STIFFEST, SHORTEST, LONGEST = range(10)

# its memory: whether a sample was before, its u, F and F̂; the admissible p, b0, b1; μ0, μ1, η1 of these; the last ε;
# θ = (p, b0/S, b1/S) and P of it by rows; then room for φ, ζ, P ζ and φᵀ P
STARTED, DEPTH, FORCE, MODEL, ADMISSIBLE, SOLID, ERROR, THETA, COVARIANCE, ROOM = 0, 1, 2, 3, 4, 7, 10, 11, 14, 23
MEMORY = ROOM + 12


@compiled
def learn(theta: Array, p: Array, phi: Array, zeta: Array, room: Array, error: float, forgetting: float) -> float:
    """One step of θ and P in place; the trace of P after it, or −1 for a step not to be trusted, and not taken."""
    n = theta.size
    scale = forgetting
    for i in range(n):
        gain, row = 0.0, 0.0
        for j in range(n):
            gain += p[i * n + j] * zeta[j]
            row += phi[j] * p[j * n + i]
        room[i], room[n + i] = gain, row
        scale += phi[i] * gain
    if not scale >= 1e-3 * forgetting:  # instruments that point elsewhere
        return -1.0
    trace = 0.0
    for i in range(n):
        theta[i] += room[i] * error / scale
        for j in range(n):
            p[i * n + j] = (p[i * n + j] - room[i] * room[n + j] / scale) / forgetting
        trace += p[i * n + i]
    return trace


@compiled
def pole(rule: float, period: float, relaxation: float) -> float:
    """p of a relaxation time."""
    if rule == BILINEAR:
        return (period - 2.0 * relaxation) / (period + 2.0 * relaxation)
    if rule == BACKWARD:
        return -relaxation / (period + relaxation)
    return -exp(-period / relaxation)


@compiled
def admit(q: Array, memory: Array) -> None:
    """The solid of θ, each number moved to its bound where it is beyond; and the recursion of that solid."""
    rule, period, most = q[RULE], q[PERIOD], q[STIFFEST]
    p = memory[THETA]
    p = min(max(p, pole(rule, period, q[LONGEST])), pole(rule, period, q[SHORTEST]))
    b0, b1 = q[SCALE] * memory[THETA + 1], q[SCALE] * memory[THETA + 2]
    mu0 = min(max((b0 + b1) / (1.0 + p), 0.0), most)
    share = 1.0
    if rule == BILINEAR:
        relaxation = period * (1.0 - p) / (2.0 * (1.0 + p))
        mu1 = (b0 - b1) / (1.0 - p) - mu0
    elif rule == BACKWARD:
        relaxation = -period * p / (1.0 + p)
        mu1 = b1 / p - mu0
    else:
        x = -log(-p)
        relaxation, share = period / x, -expm1(-x) / x
        mu1 = (b0 - mu0) / share
    mu1 = min(max(mu1, 0.0), most)
    memory[SOLID], memory[SOLID + 1], memory[SOLID + 2] = mu0, mu1, mu1 * relaxation
    memory[ADMISSIBLE] = p
    if rule == BILINEAR:
        viscous = (mu0 + mu1) * (1.0 - p) / 2.0
        memory[ADMISSIBLE + 1] = mu0 * (1.0 + p) / 2.0 + viscous
        memory[ADMISSIBLE + 2] = mu0 * (1.0 + p) / 2.0 - viscous
    elif rule == BACKWARD:
        memory[ADMISSIBLE + 1] = mu0 * (1.0 + p) - p * (mu0 + mu1)
        memory[ADMISSIBLE + 2] = p * (mu0 + mu1)
    else:
        memory[ADMISSIBLE + 1] = mu0 + mu1 * share
        memory[ADMISSIBLE + 2] = mu0 * p - mu1 * share


@compiled
def step(q: Array, memory: Array, position: float, force: float) -> None:
    """One sample of a tracker: q its numbers, its memory in place."""
    u = max(position, 0.0)
    before, measured = memory[DEPTH], memory[FORCE]
    beside = memory[MODEL]
    memory[DEPTH], memory[FORCE] = u, force
    if memory[STARTED] == 0.0:
        memory[STARTED], memory[MODEL] = 1.0, force if u > 0.0 else 0.0
        return
    a = ADMISSIBLE
    model = -memory[a] * beside + memory[a + 1] * u + memory[a + 2] * before
    if u > 0.0 and before > 0.0:
        _learnt(q, memory, u, before, force, measured, beside)
    memory[MODEL] = model


@compiled
def _learnt(
    q: Array, memory: Array, u: float, before: float, force: float, measured: float, beside: float
) -> None:
    phi, zeta, room = memory[ROOM : ROOM + 3], memory[ROOM + 3 : ROOM + 6], memory[ROOM + 6 : ROOM + 12]
    theta, p = memory[THETA : THETA + 3], memory[COVARIANCE : COVARIANCE + 9]
    scale = q[SCALE]
    phi[0] = -beside if q[METHOD] == OUTPUT_ERROR else -measured
    zeta[0] = -measured if q[METHOD] == LEAST_SQUARES else -beside
    phi[1] = zeta[1] = scale * u
    phi[2] = zeta[2] = scale * before
    error = force - phi[0] * theta[0] - phi[1] * theta[1] - phi[2] * theta[2]
    memory[ERROR] = error
    if abs(error) <= q[DEAD_ZONE]:
        return
    trace = learn(theta, p, phi, zeta, room, error, q[FORGETTING])
    if trace > q[LARGEST_TRACE]:
        for i in range(9):
            p[i] *= q[LARGEST_TRACE] / trace
    if trace >= 0.0:
        admit(q, memory)


@compiled
def run(q: Array, memory: Array, position: Array, force: Array, out: Array) -> None:
    """All samples; in out μ0, μ1, η1, ε and the trace of P after each."""
    for k in range(position.size):
        step(q, memory, position[k], force[k])
        for i in range(4):
            out[i, k] = memory[SOLID + i]
        out[4, k] = memory[COVARIANCE] + memory[COVARIANCE + 4] + memory[COVARIANCE + 8]


@compiled
def run_five(
    theta: Array, p: Array, room: Array, position: Array, force: Array, forgetting: float, out: Array
) -> None:
    """The printed five-parameter form; in out θ and the trace of P after each sample; room for 20 numbers."""
    phi = room[:5]
    for k in range(2, position.size):
        phi[0], phi[1] = -force[k - 1], -force[k - 2]
        phi[2], phi[3], phi[4] = position[k], position[k - 1], position[k - 2]
        error = force[k]
        for i in range(5):
            error -= phi[i] * theta[i]
        trace = learn(theta, p, phi, phi, room[5:], error, forgetting)
        for i in range(5):
            out[i, k] = theta[i]
        out[5, k] = trace
