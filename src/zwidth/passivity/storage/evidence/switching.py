"""Where the hand is best at the instant within a sample at which the force changes.

From x to x' in one interval, f for its first part αT and f' for the rest:

    m = x + α D + (T/2b) α (1 − α) (f' − f − φ (s − s')),      D = x' − x

s and s' the signs of both moves; or an end of a move, or of what is allowed.
"""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise

from zwidth.passivity.storage.grid.grid import Grid
from zwidth.passivity.storage.losses import Losses
from zwidth.passivity.witness.motion import Repeat

_GRID = 2**20
"""Positions between samples are whole multiples of a count over this, to keep them short."""


def switch_positions(grid: Grid, x: list[Fraction], part: Repeat) -> tuple[Fraction, ...]:
    """One position for each interval of a motion whose repeated part goes on for ever; none without need."""
    if grid.losses.part == 1:
        return ()
    law, losses = grid.law, grid.losses
    used = law.memory + 1
    step = grid.encoder.resolution
    readings = [step * (x[0] // step)] * (used + losses.delay)
    found: dict[int, Fraction] = {}
    rounds = 2 + len(readings) // (part.last - part.first)  # until all readings are of the cycle
    for k in [*range(part.first), *[*range(part.first, part.last)] * rounds, *range(part.last, len(x) - 1)]:
        readings = [step * (x[k] // step), *readings[:-1]]
        older = law.force(tuple(readings[losses.delay : losses.delay + used]))
        newer = law.force(tuple(readings[losses.delay - 1 : losses.delay - 1 + used]))
        found[k] = _best(losses, x[k], x[k + 1], older, newer, *_allowed(grid, x[k], x[k + 1]))
    return tuple(found[k] for k in range(len(x) - 1))


def _allowed(grid: Grid, start: Fraction, end: Fraction) -> tuple[Fraction, Fraction]:
    """Between which positions the hand keeps to its bounds."""
    losses, domain = grid.losses, grid.domain
    max_speed = domain.speed
    early, late = (max_speed * losses.resolution * part for part in (losses.part, 1 - losses.part))
    max_depth = (domain.highest + 1 if domain.max_depth is None else domain.max_depth) * losses.resolution
    low, high = max(start - early, end - late), min(start + early, end + late, max_depth)
    if grid.law.surface == "none":
        low = max(low, -max_depth)
    return low, max(low, high)


def _best(
    losses: Losses,
    start: Fraction,
    end: Fraction,
    older: Fraction,
    newer: Fraction,
    low: Fraction,
    high: Fraction,
) -> Fraction:
    part, friction = losses.part, losses.coulomb_friction
    candidates = [start, end, low, high]
    if losses.damping:
        step = losses.period / (2 * losses.damping) * part * (1 - part)
        for signs in (-2, 0, 2):
            m = start + part * (end - start) + step * (newer - older - friction * signs)
            candidates.append(round(m / losses.resolution * _GRID) * losses.resolution / _GRID)

    def taken(m: Fraction) -> Fraction:
        out = Fraction(0)
        for (a, b), force, span in zip(
            pairwise((start, m, end)), (older, newer), (part, 1 - part), strict=True
        ):
            out -= force * (b - a) + losses.lost(b - a, span)
        return out

    return max((min(max(m, low), high) for m in candidates), key=taken)
