"""A motion re-run through a law with contact made and broken: the energy it takes out, exactly."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import Any

from .contact_law import read_law, read_losses
from .reading import Invalid, get, integer, numbers

MOST_POSITIONS = 100_000


def contact_motion_energy(document: Mapping[str, Any]) -> tuple[Fraction, Fraction]:
    """Energy the hand takes out over the motion, and by one more round of its cycle [J].

    The motion begins at rest with the reading 0 or less, at which the law gives
    no force, and ends wherever it ends.  `repeats` names the part that is done
    `times` times; it must return to where it began.
    """
    losses, law = read_losses(document), read_law(document)
    key = next((k for k in ("positions_m", "positions_rad") if k in document), None)
    if key is None:
        raise Invalid("positions_m is missing")
    x = numbers(document[key], MOST_POSITIONS)
    part = get(document, "repeats")
    first, last, times = (integer(get(part, k)) for k in ("first", "last", "times"))
    if not 0 <= first < last < len(x) or times < 1 or x[first] != x[last]:
        raise Invalid("the repeated part must lie in the motion and return to where it began")
    taps = max(len(law.taps), 1)
    start = losses.resolution * (x[0] // losses.resolution)
    if start > 0 or law.force([start] * taps) != 0:
        raise Invalid("the motion must begin at rest where the law gives no force")

    readings = [start] * (taps + losses.delay + 1)

    def run(begin: int, end: int) -> Fraction:
        out = Fraction(0)
        for k in range(begin, end):
            readings.insert(0, losses.resolution * (x[k] // losses.resolution))
            readings.pop()
            force = law.force(readings[losses.delay : losses.delay + taps])
            d = x[k + 1] - x[k]
            out -= force * d + losses.friction * abs(d) + losses.damping / losses.period * d * d
        return out

    energy = run(0, first)
    done, before, gain = 0, None, Fraction(0)
    while done < times and before != readings:
        before = list(readings)
        gain = run(first, last)
        energy += gain
        done += 1
    energy += gain * (times - done)
    if before != readings:
        raise Invalid("the law has not settled to the cycle: there are too few rounds to tell its gain")
    return energy + run(last, len(x) - 1), gain
