"""The last value of a parameter at which a decision still holds, to the last double.

A decision is exact at every rational, so its boundary can be found by halving
the ordered doubles themselves: the answer is a number a person can type, at
which the claim was decided, next to one at which it fails.
"""

from __future__ import annotations

import struct
from collections.abc import Callable
from fractions import Fraction

from zwidth.quantity.exact import Exact

SMALLEST, LARGEST = 1e-15, 1e15
"""Search range for a positive parameter in SI units."""

COARSE = 1 << 30
"""A grain of 2^30 doubles, 2.4e-7 of the value: near enough for advice, in half the decisions."""

COARSER = 1 << 42
"""1e-3 of the value: for advice on laws of high order, of which each decision takes long."""

Holds = Callable[[Fraction], bool]


def largest_holding(holds: Holds, guess: float, grain: int = 1) -> float | None:
    """The largest double in range where `holds` is true, true below and false above it.

    Returns 0.0 if it holds at 0 but nowhere in range, inf if it holds
    throughout, None if it fails even at 0.  With a `grain` the answer is only
    that many doubles near.
    """
    return _search(holds, guess, True, grain)


def smallest_holding(holds: Holds, guess: float, grain: int = 1) -> float | None:
    """The smallest double in range where `holds` is true, false below and true above it.

    Returns 0.0 if it holds at 0, None if it holds nowhere in range; `grain` as
    for `largest_holding`.
    """
    if holds(Fraction(0)):
        return 0.0
    return _search(holds, guess, False, grain)


def _search(holds: Holds, guess: float, upward: bool, grain: int) -> float | None:
    """Gallop outward from the guess in ordered doubles, then halve."""
    start = _index(min(max(guess, SMALLEST), LARGEST))
    here = _at(holds, start)
    outward = here == upward  # which way the boundary lies: True is to larger values
    step, inside = grain, start
    bottom, top = _index(SMALLEST), _index(LARGEST)
    while True:
        probe = min(inside + step, top) if outward else max(inside - step, bottom)
        if _at(holds, probe) != here:
            break
        if probe in (bottom, top):
            return _beyond(holds, probe == top, here, upward)
        inside, step = probe, step * 16
    low, high = sorted((inside, probe))
    while high - low > grain:
        middle = (low + high) // 2
        if _at(holds, middle) == upward:
            low = middle
        else:
            high = middle
    return _double(low if upward else high)


def _beyond(holds: Holds, at_top: bool, here: bool, upward: bool) -> float | None:
    if upward:
        if at_top:
            return float("inf")
        return 0.0 if holds(Fraction(0)) else None
    return None if at_top else SMALLEST


def _at(holds: Holds, index: int) -> bool:
    return holds(Exact(_double(index)).fraction)


def _index(value: float) -> int:
    """Positive doubles in their order, as integers."""
    return int(struct.unpack("<q", struct.pack("<d", value))[0])


def _double(index: int) -> float:
    return float(struct.unpack("<d", struct.pack("<q", index))[0])
