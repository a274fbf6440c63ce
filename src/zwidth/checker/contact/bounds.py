"""The bounds on the hand that a motion is said to keep: how deep, how far outside, how fast.

x ≤ depth,    x ≥ −outside,    |Δx| ≤ speed · t    over each time t in which one force is held
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from itertools import pairwise
from typing import Any

from ..document.reading import Invalid, number
from .law import Losses


def require_within(
    document: Mapping[str, Any], losses: Losses, x: Sequence[Fraction], switches: Sequence[Fraction]
) -> None:
    """Where a document states bounds, every position and every move keeps to them."""
    if "bounds" not in document:
        return
    bounds = document["bounds"]
    if not isinstance(bounds, Mapping):
        raise Invalid("the bounds of a motion must be an object")
    for key, value in bounds.items():
        name, _, unit = str(key).partition("_")
        most = number(value)
        if (name, unit) in (("speed", "m_per_s"), ("speed", "rad_per_s")):
            kept = _slow(losses, x, switches, most)
        elif name in ("depth", "outside") and unit in ("m", "rad"):
            side = 1 if name == "depth" else -1
            kept = all(side * place <= most for place in (*x, *switches))
        else:
            raise Invalid(f"a bound that is not understood: {str(key)[:40]}")
        if not kept:
            raise Invalid(f"the motion does not keep to its {name}")


def _slow(losses: Losses, x: Sequence[Fraction], switches: Sequence[Fraction], speed: Fraction) -> bool:
    if losses.part == 1:
        return all(abs(b - a) <= speed * losses.period for a, b in pairwise(x))
    early, late = speed * losses.period * losses.part, speed * losses.period * (1 - losses.part)
    turns = zip(pairwise(x), switches, strict=True)
    return all(abs(m - a) <= early and abs(b - m) <= late for (a, b), m in turns)
