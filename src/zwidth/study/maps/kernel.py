"""Routh's test for a block of walls, each answer with a bound on its rounding.

    c(w) = c_0 + K c_K + B c_B

The coefficients are doubles within a unit of the last place of the true ones, or within `slack`.

Every number carries a bound e on how far it may be from the true one.  A sign is believed
only where |value| > e; the rest is left to exact arithmetic.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from zwidth.native.compiled import Array, compiled
from zwidth.passivity.stability.characteristic import decided, family
from zwidth.quantity.exact import Exact
from zwidth.study.chunks.layout import Layers, Place, cells
from zwidth.study.maps.plan import Contact, HandPlan, Plan
from zwidth.study.maps.request import CHUNK

STABLE, UNSTABLE, UNKNOWN = 1, 0, 2
"""What is known of a cell."""

EPS = 4.5e-16
"""More than four roundings, 4 · 2⁻⁵³: each formula below has at most three."""


@compiled
def decide_block(
    free: Array, stiff: Array, damped: Array, stiffness: Array, damping: Array,
    slack: float, upper: Array, lower: Array, out: NDArray[np.uint8],
) -> None:  # fmt: skip
    """Fill out[i, j] for every K and B; `upper` and `lower` are scratch: a row of values, a row of bounds."""
    for i in range(stiffness.size):
        for j in range(damping.size):
            out[i, j] = decide(free, stiff, damped, stiffness[i], damping[j], slack, upper, lower)


@compiled
def decide(
    free: Array, stiff: Array, damped: Array, k: float, b: float, slack: float, upper: Array, lower: Array
) -> int:
    """One wall: STABLE, UNSTABLE or UNKNOWN."""
    size = free.size
    count_upper, count_lower = (size + 1) // 2, size // 2
    for n in range(size):
        x, y = k * stiff[n], b * damped[n]
        value = free[n] + x + y
        bound = 2.0 * EPS * (abs(free[n]) + abs(x) + abs(y)) + slack * (1.0 + abs(k) + abs(b))
        row = upper if n % 2 == 0 else lower
        row[0, n // 2] = value
        row[1, n // 2] = bound
    while count_upper > 0:
        if not upper[0, 0] > upper[1, 0]:
            return UNSTABLE if upper[0, 0] < -upper[1, 0] else UNKNOWN
        if count_lower == 0:
            return STABLE
        if not lower[0, 0] > lower[1, 0]:
            return UNSTABLE if lower[0, 0] < -lower[1, 0] else UNKNOWN
        a, ea, p, ep = upper[0, 0], upper[1, 0], lower[0, 0], lower[1, 0]
        ratio = a / p
        error = (ea + ratio * ep) / (p - ep) * (1.0 + 8.0 * EPS) + EPS * ratio
        for n in range(count_upper - 1):
            q = lower[0, n + 1] if n + 1 < count_lower else 0.0
            eq = lower[1, n + 1] if n + 1 < count_lower else 0.0
            above, bound = upper[0, n + 1], upper[1, n + 1]
            product = ratio * q
            upper[0, n] = above - product
            grown = bound + ratio * eq + abs(q) * error + error * eq
            upper[1, n] = grown * (1.0 + 8.0 * EPS) + EPS * (abs(above) + abs(product))
        left = count_upper - 1
        # the lower row becomes the upper one
        for n in range(max(count_lower, left)):
            for part in range(2):
                kept = lower[part, n] if n < count_lower else 0.0
                lower[part, n] = upper[part, n] if n < left else 0.0
                upper[part, n] = kept
        count_upper, count_lower = count_lower, left
    return STABLE


_SHY = 1e-14
"""By how much every number of the admissible speed is taken to its safe side: more than its rounding."""


def compute(ready: Plan, place: Place) -> Layers:
    """Every layer of one chunk, by the name of its array."""
    rows, columns = cells(place, (CHUNK, CHUNK))
    k, b = ready.stiffness[rows], ready.damping[columns]
    indices = np.arange(len(ready.stiffness))[rows]
    passive = indices[:, None] < ready.passive[columns][None, :]
    first, past = ready.sustained[:, columns]
    layers: Layers = {
        "passive": passive,
        "passive_sustained": (indices[:, None] >= first) & (indices[:, None] < past),
        "admissible_speed": _speed(ready.contact, k, b, passive),
    }
    layers.update((f"stable_{hand.name}", _stable(hand, k, b)) for hand in ready.hands)
    return layers


def _speed(contact: Contact | None, k: Array, b: Array, passive: NDArray[np.bool_]) -> Array:
    """(f_c − F)/(b_need − b), rounded to the safe side; inf where passive, 0 where small motions gain."""
    if contact is None:
        return np.where(passive, np.inf, 0.0)
    stiff, damped = k[:, None] * (1 + _SHY), np.abs(b)[None, :] * (1 + _SHY)
    friction = (stiff + contact.variation * damped) * contact.half_step * (1 + _SHY)
    surplus = contact.friction * (1 - _SHY) - friction
    linear, asked = contact.hold * stiff + contact.gain * damped, contact.gain * damped
    root = np.sqrt(linear**2 + contact.part * (contact.period * stiff + 2 * asked) ** 2)
    deficit = (linear + root) / 2 * (1 + _SHY) - contact.damping * (1 - _SHY)
    with np.errstate(divide="ignore", invalid="ignore"):
        speed = np.where((surplus > 0) & (deficit > 0), surplus / deficit * (1 - _SHY), 0.0)
    return np.where(passive, np.inf, speed)


def _stable(hand: HandPlan, k: Array, b: Array) -> NDArray[np.bool_]:
    """True where the loop with this hand is proved to decay."""
    out = np.empty((len(k), len(b)), dtype=np.uint8)
    upper, lower = np.zeros((2, len(hand.free))), np.zeros((2, len(hand.free)))
    decide_block(hand.free, hand.stiff, hand.damped, k, b, hand.slack, upper, lower, out)
    for i, j in np.argwhere(out == UNKNOWN):
        out[i, j] = _exactly(hand, float(k[i]), float(b[j]))
    return np.asarray(out == STABLE)


def _exactly(hand: HandPlan, k: float, b: float) -> bool:
    stiffness, damping = Exact(k).fraction, Exact(b).fraction
    found = decided(hand.motion, lambda motion: family(motion, hand.velocity).at(stiffness, damping))
    return found.outcome == "stable"
