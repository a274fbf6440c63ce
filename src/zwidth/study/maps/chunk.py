"""One chunk of a map: every cell decided, by floats with bounds where they suffice, else exactly."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from zwidth.passivity.stability.characteristic import decided, family
from zwidth.quantity.exact import Exact
from zwidth.study.chunks.layout import Layers, Place, cells
from zwidth.study.maps.kernel import STABLE, UNKNOWN, decide_block
from zwidth.study.maps.plan import Contact, HandPlan, Plan
from zwidth.study.maps.request import CHUNK, Array

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
