"""Motions that a one-sided wall sustains: periodic, and found by solving, not by waiting.

    f = K max(x − g, 0),    x(j) = −Σ G_n(j − i) f(i),    i, j over one period of n samples

The pattern of samples inside is guessed, from simulated motions and from the simplest patterns, and corrected
until the solution has the pattern it was computed for; see `orbit`.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from zwidth.errors import InputError
from zwidth.passivity.certificate import FORMAT, Certificate
from zwidth.passivity.stability.absolute.orbit import Array, corrected, growth_of, returns, simulated
from zwidth.passivity.stability.absolute.plant import Plant
from zwidth.quantity.exact import Exact
from zwidth.quantity.text import exact_text

_RUNS = 4
_SHORT = 14
"""Periods up to which every pattern with one touch is tried."""

_LARGEST = 1e6
_SMALLEST = 1e-6
"""Of |gap|: a smaller swing is rest, larger positions are on their way to infinity."""

_NEAR = (1.001, 1.002, 1.005, 1.01, 1.02, 1.05, 1.12, 1.25, 1.5)
_FACTORS = (*_NEAR, 1.75, 2.0, 2.5, 3.0, 4.0, 5.0, 5.5, 6.0, 7.0, 8.0, 10.0)
_HALVINGS = 14


class PeriodicMotion(NamedTuple):
    """A motion that repeats itself for ever, without any force from outside.

    `positions` are from where the hand rests without a wall; the wall begins at `gap`. `growth` is the
    largest factor by which a small deviation grows in one period: below 1 the motion attracts. `basin` is the
    share of the simulated starts that did not come to rest; `source` says of which plant it is a motion.
    ``certificate`` lets the independent checker solve for it.
    """

    slope: float
    gap: float
    positions: tuple[float, ...]
    growth: float
    basin: float
    source: dict[str, Any]

    @property
    def period(self) -> int:
        """In samples."""
        return len(self.positions)

    @property
    def inside(self) -> tuple[bool, ...]:
        """Which samples find the wall."""
        return tuple(x > self.gap for x in self.positions)

    @property
    def swing(self) -> float:
        """From the outermost to the innermost sample."""
        return max(self.positions) - min(self.positions)

    @property
    def certificate(self) -> Certificate:
        """Slope, gap and pattern, of kind "vibration": the checker solves for the motion itself."""
        document = {
            "format": FORMAT,
            "kind": "vibration",
            **self.source,
            "slope": exact_text(Exact(self.slope).fraction),
            "gap": exact_text(Exact(self.gap).fraction),
            "inside": list(self.inside),
        }
        return Certificate((document,))


def periodic_motion(plant: Plant, slope: float, gap: float, longest: int = 120) -> PeriodicMotion | None:
    """A periodic motion of at most `longest` samples, confirmed by the checker; None if none was found.

    One that attracts is preferred.

    Parameters
    ----------
    plant
        G.
    slope
        K > 0 of the wall.
    gap
        From where the hand rests to the surface, ≠ 0; < 0 for a hand that presses.
    longest
        Longest period tried [samples], 2 … 1000.
    """
    if not slope > 0 or gap == 0 or not 2 <= longest <= 1000:
        raise InputError(
            f"slope must be > 0, gap not 0 and longest 2 … 1000, got {slope:g}, {gap:g} and {longest}: "
            "a wall at the anchor itself has motions of every size or none"
        )
    runs = simulated(plant, slope, gap)
    alive = [run for run in runs if np.ptp(run) > _SMALLEST * abs(gap)]
    found: PeriodicMotion | None = None
    for guess in _guesses(alive, gap, longest):
        positions = corrected(plant, slope, gap, guess)
        if positions is None or np.ptp(positions) <= _SMALLEST * abs(gap):
            continue
        growth = growth_of(plant, slope, positions > gap)
        if found is not None and growth >= min(found.growth, 1.0):
            continue
        share = len(alive) / len(runs)
        motion = PeriodicMotion(slope, gap, tuple(positions.tolist()), growth, share, plant.source)
        if motion.certificate.verify():
            found = motion
            if growth < 1:
                break
    return found


def smallest_motion(plant: Plant, low: float, gap: float, longest: int = 120) -> PeriodicMotion | None:
    """The periodic motion of the smallest slope found, a few slopes from `low` up to ten times as much tried.

    Not the smallest there is: between those slopes, and with other patterns, there may be others.
    """
    for factor in _FACTORS:
        found = periodic_motion(plant, low * factor, gap, longest)
        if found is not None:
            return _softened(plant, found, low)
    return None


def _guesses(runs: list[Array], gap: float, longest: int) -> Iterator[Array]:
    """One period each: ends of simulated motions, then one touch of every length."""
    finite = [run for run in runs if np.abs(run).max() < _LARGEST * abs(gap)]
    for run in finite[:: max(1, len(finite) // _RUNS)]:
        for period in returns(run, longest):
            yield run[-period:]
    for period in range(2, min(_SHORT, longest) + 1):
        for touches in range(1, period):
            yield np.where(np.arange(period) < touches, gap + 1.0, gap - 1.0)


def _softened(plant: Plant, motion: PeriodicMotion, low: float) -> PeriodicMotion:
    """The same motion, followed to the smallest slope down to which it exists."""
    best, gap = motion, motion.gap
    for _ in range(_HALVINGS):
        slope = (low + best.slope) / 2
        positions = corrected(plant, slope, gap, np.array(best.positions))
        if positions is None or np.ptp(positions) <= _SMALLEST * abs(gap):
            low = slope
            continue
        growth = growth_of(plant, slope, positions > gap)
        softer = motion._replace(slope=slope, positions=tuple(positions.tolist()), growth=growth)
        if softer.certificate.verify():
            best = softer
        else:
            low = slope
    runs = simulated(plant, best.slope, gap)
    moving = sum(bool(np.ptp(run) > _SMALLEST * abs(gap)) for run in runs)
    best = best._replace(basin=moving / len(runs))
    return best
