"""The last value of a parameter at which a decision still holds, to the last double.

A decision is exact at every rational, so its boundary can be found by halving the ordered doubles themselves:
the answer is a number a person can type, at which the claim was decided, next to one at which it fails.
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Iterable
from fractions import Fraction

from zwidth.quantity.exact import Exact

SMALLEST, LARGEST = 1e-15, 1e15
"""Search range for a positive parameter in SI units."""

COARSE = 1 << 30
"""A grain of 2^30 doubles, 2.4e-7 of the value: near enough for advice, in half the decisions."""

COARSER = 1 << 42
"""1e-3 of the value: for advice on laws of high order, of which each decision takes long."""

_BESIDE, _ANYWHERE = 4, 17
"""Steps of a gallop, each 16 times as long: around where the boundary is likely, and through all doubles."""

Holds = Callable[[Fraction], bool]


def largest_holding(holds: Holds, guess: float, grain: int = 1, likely: float | None = None) -> float | None:
    """The largest double in range where `holds` is true, true below and false above it.

    Returns 0.0 if it holds at 0 but nowhere in range, inf if it holds throughout, None if it fails even at 0.
    With a `grain` the answer is only that many doubles near.  Where it probably is, `likely`, is looked at
    first, and then from `guess` on.
    """
    return _search(holds, guess, True, grain, likely)


def smallest_holding(holds: Holds, guess: float, grain: int = 1, likely: float | None = None) -> float | None:
    """The smallest double in range where `holds` is true, false below and true above it.

    Returns 0.0 if it holds at 0, None if it holds nowhere in range; `grain` and
    `likely` as for `largest_holding`.
    """
    if holds(Fraction(0)):
        return 0.0
    return _search(holds, guess, False, grain, likely)


def asked_seldom(holds: Holds, near: float | None, beside: Iterable[Fraction], upward: bool = True) -> Holds:
    """The same answers, of what turns once: `upward` it holds below a place and not above, else above.

    What follows from an answer is not asked again.  First it is asked at these parts beside the place where
    it probably turns, `near`, until it turns between them.
    """
    low: Fraction | None = None
    high: Fraction | None = None

    def asked(value: Fraction) -> bool:
        nonlocal low, high
        if low is not None and value <= low:
            return upward
        if high is not None and value >= high:
            return not upward
        answer = holds(value)
        low, high = (value, high) if answer == upward else (low, value)
        return answer

    for part in beside if near else ():
        place = Fraction(near or 0)
        if asked(place * (1 - part)) != asked(place * (1 + part)):
            break
    return asked


def _search(holds: Holds, guess: float, upward: bool, grain: int, likely: float | None) -> float | None:
    """Gallop outward from the guess in ordered doubles, or begin where it is likely; then halve."""
    start = _in_range(guess)
    here = _at(holds, start)
    outward = here == upward  # which way the boundary lies: True is to larger values
    end = _in_range(LARGEST if outward else SMALLEST)
    bracket = None
    if likely is not None and (_in_range(likely) > start) == outward:
        at = _in_range(likely)
        there = _at(holds, at)
        if at == end and there == here:
            return _beyond(holds, outward, here, upward)
        bracket = _turn(holds, at, there, end if there == here else start, grain, _BESIDE)
    bracket = bracket or _turn(holds, start, here, end, grain, _ANYWHERE)
    if bracket is None:
        return _beyond(holds, outward, here, upward)
    low, high = bracket
    while high - low > grain:
        middle = (low + high) // 2
        if _at(holds, middle) == upward:
            low = middle
        else:
            high = middle
    return _double(low if upward else high)


def _turn(holds: Holds, inside: int, here: bool, end: int, grain: int, most: int) -> tuple[int, int] | None:
    """Two places between which the answer turns, in so many steps; None where it does not up to the end."""
    step = grain if end > inside else -grain
    for _ in range(most):
        probe = min(inside + step, end) if step > 0 else max(inside + step, end)
        if _at(holds, probe) != here:
            return min(inside, probe), max(inside, probe)
        if probe == end:
            break
        inside, step = probe, step * 16
    return None


def _beyond(holds: Holds, at_top: bool, here: bool, upward: bool) -> float | None:
    if upward:
        if at_top:
            return float("inf")
        return 0.0 if holds(Fraction(0)) else None
    return None if at_top else SMALLEST


def _at(holds: Holds, index: int) -> bool:
    return holds(Exact(_double(index)).fraction)


def _in_range(value: float) -> int:
    return _index(min(max(value, SMALLEST), LARGEST))


def _index(value: float) -> int:
    """Positive doubles in their order, as integers."""
    return int(struct.unpack("<q", struct.pack("<d", value))[0])


def _double(index: int) -> float:
    return float(struct.unpack("<d", struct.pack("<q", index))[0])
