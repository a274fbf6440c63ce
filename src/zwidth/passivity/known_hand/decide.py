"""Does every hand in a box come to rest?  Decided by halving the box.

A box is *stable* where the balls of its characteristic polynomial pass Routh's test: this covers
every value in it.  It is *unstable* where one value, computed exactly or in balls of growing precision,
does not decay.  What is neither after `MOST_BOXES` boxes is undecided.
"""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from typing import Any, Literal, NamedTuple

from zwidth.passivity.known_hand.characteristic import PRECISIONS, decays, precision
from zwidth.passivity.known_hand.plant import Coefficients, Motion, Range

Outcome = Literal["stable", "unstable", "undecided"]

MOST_BOXES = 4000
"""Boxes that are tried: about a second."""

Polynomial = Callable[[Motion], Coefficients]


class Found(NamedTuple):
    """The outcome, and a point of the box that does not decay if there is one."""

    outcome: Outcome
    culprit: Motion | None = None


def decided(motion: Motion, polynomial: Polynomial, most: int = MOST_BOXES) -> Found:
    """Whether the loop decays for every mass, damping and stiffness of the box."""
    if motion.is_certain:
        return _certain(motion, polynomial)
    # the corners and the middle first: an unstable one settles it
    for point in (*corners(motion), _middle(motion)):
        if _certain(point, polynomial).outcome == "unstable":
            return Found("unstable", point)
    left, tried = [motion], 0
    while left:
        box = left.pop()
        tried += 1
        with precision(PRECISIONS[0]):
            if decays(polynomial(box)):
                continue
        point = _middle(box)
        if _certain(point, polynomial).outcome == "unstable":
            return Found("unstable", point)
        if tried + len(left) >= most:
            return Found("undecided")
        left += _halves(box, motion)
    return Found("stable")


def _certain(motion: Motion, polynomial: Polynomial) -> Found:
    for bits in PRECISIONS:
        with precision(bits):
            answer = decays(polynomial(motion))
        if answer is not None:
            return Found("stable") if answer else Found("unstable", motion)
    return Found("undecided")


def corners(motion: Motion) -> list[Motion]:
    """The certain motions at the corners of the box."""
    found = [motion]
    for key, ends in _ranges(motion):
        found = [_with(corner, key, (end, end)) for corner in found for end in dict.fromkeys(ends)]
    return found


def _with(motion: Motion, key: str, ends: Range) -> Motion:
    changed: dict[str, Any] = {key: ends}
    return motion._replace(**changed)


def _middle(motion: Motion) -> Motion:
    point = motion
    for key, (low, high) in _ranges(motion):
        point = _with(point, key, ((low + high) / 2, (low + high) / 2))
    return point


def _halves(box: Motion, whole: Motion) -> list[Motion]:
    """The box cut in two across the side that is longest as a part of the whole."""

    def share(item: tuple[str, Range]) -> Fraction:
        low, high = getattr(whole, item[0])
        return (item[1][1] - item[1][0]) / (high - low) if high > low else Fraction(0)

    key, (low, high) = max(_ranges(box), key=share)
    half = (low + high) / 2
    return [_with(box, key, part) for part in ((low, half), (half, high))]


def _ranges(motion: Motion) -> list[tuple[str, Range]]:
    return [("mass", motion.mass), ("damping", motion.damping), ("stiffness", motion.stiffness)]
