"""Recursive least squares, a step per sample, compiled.

    y = F − F₋₁ = φᵀθ,   φ = (−g F₋₁, g S u, S Δu),   θ = ((1 + p)/g, (b0 + b1)/(g S), −b1/S)
    ε = y − φᵀθ,   L = P φ/(λ + φᵀ P φ),   θ ← θ + L ε,   P ← (P − L φᵀ P)/λ

is F = −p F₋₁ + b0 u + b1 u₋₁ written with differences.  S = μ0 + μ1 and g = T/τ are of the solid at the
start: all numbers are near 1 then, where 1 + p and b0 + b1 would be lost among p, b0 and b1.  F₋₁ in φ is
the measured one (least squares) or the F̂₋₁ of a model run beside (output error).  With instruments ζ = (−g
F̂₋₁, g S u, S Δu) that recursion runs away where ζφᵀ has been nearly singular; so the sums themselves are
kept, and θ takes a damped step to where they want it:

    R ← λ R + ζ φᵀ,   r ← λ r + ζ y,   z ← λ² z + ζᵀζ
    θ ← θ + (RᵀR + κ² I)⁻¹ Rᵀ (r − R θ),    κ² = σ² z

σ the noise of the force: κ is what noise makes of r, and a direction that R knows no better is hardly moved.

The model run beside is F̂ = −p F̂₋₁ + b0 u + b1 u₋₁: for output error with the admissible parameters of the
moment, for the instruments with those of the start, for ever.  Instruments need not be right, only free of
the noise and like the force; ones that follow the estimate can lead it astray.  u = max(x, 0); only where
this sample and the last are inside is anything learnt.
"""

from __future__ import annotations

from math import expm1, inf, log1p

from zwidth.native.compiled import Array, compiled

LEAST_SQUARES, INSTRUMENTAL, OUTPUT_ERROR = 0.0, 1.0, 2.0
RAMP, BILINEAR, BACKWARD = 0.0, 1.0, 2.0

# the numbers of a tracker
(
    FORGETTING,
    DEAD_ZONE,
    LARGEST_TRACE,
    METHOD,
    RULE,
    PERIOD,
    SCALE,
    SHARE,
    STIFFEST,
    SHORTEST,
    LONGEST,
    VARIANCE,
    START,
) = range(13)

# its memory: whether a sample was before, its u, F and F̂; the admissible p, b0, b1; their μ0, μ1, η1; the
# last ε; θ and P of it, or R, by rows; r; z; the trace of P; then room to reckon
STARTED, DEPTH, FORCE, MODEL, ADMISSIBLE, SOLID, ERROR, THETA, COVARIANCE = 0, 1, 2, 3, 4, 7, 10, 11, 14
WANTED, SQUARES, TRACE, ROOM = 23, 26, 27, 28
MEMORY = ROOM + 15


@compiled
def learn(theta: Array, p: Array, phi: Array, gain: Array, error: float, forgetting: float) -> float:
    """One step of θ and P in place; the trace of P after it, or −1 for a step not to be trusted nor taken."""
    n = theta.size
    scale = forgetting
    for i in range(n):
        gain[i] = 0.0
        for j in range(n):
            gain[i] += p[i * n + j] * phi[j]
        scale += phi[i] * gain[i]
    if not scale >= 0.5 * forgetting:  # P has lost its sign to rounding
        return -1.0
    trace = 0.0
    for i in range(n):
        theta[i] += gain[i] * error / scale
        for j in range(n):
            p[i * n + j] = (p[i * n + j] - gain[i] * gain[j] / scale) / forgetting
        trace += p[i * n + i]
    return trace


@compiled
def instruct(q: Array, memory: Array, phi: Array, zeta: Array, wants: Array, y: float) -> None:
    """One step by instruments: R, r and z take the sample in, θ its damped step."""
    r, right, theta = (
        memory[COVARIANCE : COVARIANCE + 9],
        memory[WANTED : WANTED + 3],
        memory[THETA : THETA + 3],
    )
    keep = q[FORGETTING]
    squares = keep * keep * memory[SQUARES]
    for i in range(3):
        for j in range(3):
            r[3 * i + j] = keep * r[3 * i + j] + zeta[i] * phi[j]
        right[i] = keep * right[i] + zeta[i] * y
        squares += zeta[i] * zeta[i]
    memory[SQUARES] = squares
    damped = q[VARIANCE] * squares
    a = _product(r, 0, 0) + damped
    b, c = _product(r, 0, 1), _product(r, 0, 2)
    d = _product(r, 1, 1) + damped
    e = _product(r, 1, 2)
    f = _product(r, 2, 2) + damped
    for j in range(3):
        wants[j] = 0.0
        for i in range(3):
            left = right[i] - r[3 * i] * theta[0] - r[3 * i + 1] * theta[1] - r[3 * i + 2] * theta[2]
            wants[j] += r[3 * i + j] * left
    # the inverse of the symmetric matrix (a b c; b d e; c e f) by its cofactors
    aa, bb, cc = d * f - e * e, c * e - b * f, b * e - c * d
    dd, ee, ff = a * f - c * c, b * c - a * e, a * d - b * b
    whole = a * aa + b * bb + c * cc
    if not whole > 0.0:
        return
    theta[0] += (aa * wants[0] + bb * wants[1] + cc * wants[2]) / whole
    theta[1] += (bb * wants[0] + dd * wants[1] + ee * wants[2]) / whole
    theta[2] += (cc * wants[0] + ee * wants[1] + ff * wants[2]) / whole
    memory[TRACE] = squares * (aa + dd + ff) / whole


@compiled
def _product(r: Array, i: int, j: int) -> float:
    return r[i] * r[j] + r[3 + i] * r[3 + j] + r[6 + i] * r[6 + j]


@compiled
def rate_of(rule: float, period: float, relaxation: float) -> float:
    """1 + p of a relaxation time."""
    if rule == BILINEAR:
        return 2.0 * period / (period + 2.0 * relaxation)
    if rule == BACKWARD:
        return period / (period + relaxation)
    return -expm1(-period / relaxation)


@compiled
def admit(q: Array, memory: Array) -> None:
    """The solid of θ, each number moved to its bound where it is beyond; and the recursion of that solid."""
    rule, period, most = q[RULE], q[PERIOD], q[STIFFEST]
    rate = q[SHARE] * memory[THETA]
    rate = min(max(rate, rate_of(rule, period, q[LONGEST])), rate_of(rule, period, q[SHORTEST]))
    total = q[SHARE] * q[SCALE] * memory[THETA + 1]
    b1 = -q[SCALE] * memory[THETA + 2]
    mu0 = min(max(total / rate, 0.0), most)
    share = 1.0
    if rule == BILINEAR:
        relaxation = period * (2.0 - rate) / (2.0 * rate)
        mu1 = (total - 2.0 * b1) / (2.0 - rate) - mu0
    elif rule == BACKWARD:
        relaxation = period * (1.0 - rate) / rate
        mu1 = b1 / (rate - 1.0) - mu0
    else:
        x = -log1p(-rate)
        relaxation, share = period / x, rate / x
        mu1 = (total - b1 - mu0) / share
    mu1 = min(max(mu1, 0.0), most)
    memory[SOLID], memory[SOLID + 1], memory[SOLID + 2] = mu0, mu1, mu1 * relaxation
    if rule == BILINEAR:
        b1 = (mu0 * rate - (mu0 + mu1) * (2.0 - rate)) / 2.0
    elif rule == BACKWARD:
        b1 = (rate - 1.0) * (mu0 + mu1)
    else:
        b1 = mu0 * (rate - 1.0) - mu1 * share
    memory[ADMISSIBLE], memory[ADMISSIBLE + 1], memory[ADMISSIBLE + 2] = rate - 1.0, mu0 * rate - b1, b1


@compiled
def step(q: Array, memory: Array, position: float, force: float) -> None:
    """One sample of a tracker: q its numbers, its memory in place."""
    if not (abs(position) < inf and abs(force) < inf):
        memory[STARTED] = 0.0
        return
    u = max(position, 0.0)
    before, measured = memory[DEPTH], memory[FORCE]
    beside = memory[MODEL]
    memory[DEPTH], memory[FORCE] = u, force
    if memory[STARTED] == 0.0:
        memory[STARTED], memory[MODEL] = 1.0, force if u > 0.0 else 0.0
        return
    if q[METHOD] == OUTPUT_ERROR:
        model = -memory[ADMISSIBLE] * beside + memory[ADMISSIBLE + 1] * u + memory[ADMISSIBLE + 2] * before
    else:
        model = -q[START] * beside + q[START + 1] * u + q[START + 2] * before
    if u > 0.0 and before > 0.0:
        _learnt(q, memory, u, before, force, measured, beside)
    memory[MODEL] = model


@compiled
def _learnt(
    q: Array, memory: Array, u: float, before: float, force: float, measured: float, beside: float
) -> None:
    phi, zeta, room = memory[ROOM : ROOM + 3], memory[ROOM + 3 : ROOM + 6], memory[ROOM + 6 : ROOM + 9]
    theta, p = memory[THETA : THETA + 3], memory[COVARIANCE : COVARIANCE + 9]
    last = beside if q[METHOD] == OUTPUT_ERROR else measured
    y = force - last
    phi[0], phi[1], phi[2] = -q[SHARE] * last, q[SHARE] * q[SCALE] * u, q[SCALE] * (u - before)
    error = y - phi[0] * theta[0] - phi[1] * theta[1] - phi[2] * theta[2]
    memory[ERROR] = error
    if abs(error) <= q[DEAD_ZONE]:
        return
    if q[METHOD] == INSTRUMENTAL:
        zeta[0], zeta[1], zeta[2] = -q[SHARE] * beside, phi[1], phi[2]
        instruct(q, memory, phi, zeta, room, y)
    else:
        trace = learn(theta, p, phi, room, error, q[FORGETTING])
        if trace < 0.0:
            return
        if trace > q[LARGEST_TRACE]:
            for i in range(9):
                p[i] *= q[LARGEST_TRACE] / trace
            trace = q[LARGEST_TRACE]
        memory[TRACE] = trace
    admit(q, memory)


@compiled
def run(q: Array, memory: Array, position: Array, force: Array, out: Array) -> None:
    """All samples; in out μ0, μ1, η1, ε and the trace of P after each."""
    for k in range(position.size):
        step(q, memory, position[k], force[k])
        for i in range(4):
            out[i, k] = memory[SOLID + i]
        out[4, k] = memory[TRACE]


@compiled
def run_five(
    theta: Array, p: Array, room: Array, position: Array, force: Array, forgetting: float, out: Array
) -> None:
    """The printed five-parameter form; in out θ and the trace of P after each sample; room for 10 numbers."""
    phi = room[:5]
    for k in range(2, position.size):
        phi[0], phi[1] = -force[k - 1], -force[k - 2]
        phi[2], phi[3], phi[4] = position[k], position[k - 1], position[k - 2]
        error = force[k]
        for i in range(5):
            error -= phi[i] * theta[i]
        trace = learn(theta, p, phi, room[5:10], error, forgetting)
        for i in range(5):
            out[i, k] = theta[i]
        out[5, k] = trace
