"""The mean force of an element that is not linear over a step at the mean velocity v̄, from its state.

    contact    f̄ = max(0, [½ K δ₊²]/(T v̄) + B [δ₊]/T),   δ₊ = max(0, d), [·] the change over the step
    friction   f̄ = clip(c + v̄/ε, ±F)             c the force that was found last, see `coupled`
    points     f̄ = mean of f over d … d + T v̄

All are monotone in v̄.  A contact's damping works on the change of the depth, of the sign of v̄, and where the
sum would pull there is no force at all: then the spring's energy is lost, and none is made.
"""

from __future__ import annotations

from zwidth.model.scene.nonlinear import CONTACT, COULOMB
from zwidth.native.compiled import Array, compiled


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
