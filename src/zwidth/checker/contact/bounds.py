"""The bounds on the hand that a motion is said to keep: how deep, how far outside, how fast.

x ≤ depth,    x ≥ −outside,    |Δx| ≤ speed · t    over each time t in which one force is held
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from itertools import pairwise

from ..document.fields import Number, Read, Record
from ..document.refusal import Invalid
from ..document.unit import LENGTH, SPEED
from .law import Losses

BOUNDS = Record(
    {
        "speed": Number(SPEED, least=0, default=None),
        "depth": Number(LENGTH, default=None),
        "outside": Number(LENGTH, default=None),
    },
    default=None,
)


def require_within(
    bounds: Read | None, losses: Losses, x: Sequence[Fraction], switches: Sequence[Fraction]
) -> None:
    """Where bounds are stated, every position and every move keeps to them."""
    if bounds is None:
        return
    if bounds.speed is not None and not _slow(losses, x, switches, bounds.speed):
        raise Invalid("the motion does not keep to its speed")
    for name, most, side in (("depth", bounds.depth, 1), ("outside", bounds.outside, -1)):
        if most is not None and any(side * place > most for place in (*x, *switches)):
            raise Invalid(f"the motion does not keep to its {name}")


def _slow(losses: Losses, x: Sequence[Fraction], switches: Sequence[Fraction], speed: Fraction) -> bool:
    if losses.part == 1:
        return all(abs(b - a) <= speed * losses.period for a, b in pairwise(x))
    early, late = speed * losses.period * losses.part, speed * losses.period * (1 - losses.part)
    turns = zip(pairwise(x), switches, strict=True)
    return all(abs(m - a) <= early and abs(b - m) <= late for (a, b), m in turns)
