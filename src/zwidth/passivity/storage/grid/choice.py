"""Which cells a motion is sought on: every n-th count of a fine encoder first, then every count.

A hand that keeps to the first of every n counts is a hand like any other.  On cells of n counts it is
found as quickly as behind a coarse encoder, and its motion gains behind the fine one, where it is counted.
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from math import floor

from zwidth.passivity.storage.domain import Domain, states_of, too_large
from zwidth.passivity.storage.law import FiniteLaw
from zwidth.passivity.storage.losses import Losses

_REACHES = (4, 12, 24)
"""Cells that the hand may go in one sample, about."""

_FEW = 24
"""Counts a sample up to which every count is looked at, and nothing else."""

_NEAR = 12
"""Counts a sample of a hand that stays near an edge, where there are too many for all of them."""

_MAX_DEPTH = 64
"""Cells that are looked at: for a law that is linear inside, depth by itself is of no use."""

_MOST_WORK = 60_000
"""States of a grid times the cells in reach, up to which a motion is sought on it."""


def grids(law: FiniteLaw, losses: Losses, domain: Domain) -> list[tuple[int, Domain]]:
    """Counts in a cell, and the cells within the bounds; coarse to fine; none on which no hand moves."""
    within = domain.within
    far = min(domain.speed, Fraction(within.highest))
    remembered = law.memory + losses.delay
    found = []
    many = far > _FEW or _work(law, losses, within) > _MOST_WORK
    for reach in _REACHES if many else ():
        counts = _counts(far, reach)
        cells = domain.every(counts, remembered, _two_sided(law)) if counts > 1 else None
        if cells is not None:
            found.append((counts, _shallow(law, cells)))
    here = within, _shallow(law, within), _near(law, within, remembered)
    chosen = next((d for d in here if _work(law, losses, d) <= _MOST_WORK), here[-1])
    whole = [] if chosen == within or too_large(law, losses, within) else [(1, within)]  # last, as it is slow
    return [(counts, cells) for counts, cells in (*found, (1, chosen), *whole) if cells.reach > 0]


def _work(law: FiniteLaw, losses: Losses, domain: Domain) -> int:
    more = 1 if law.memory + losses.delay else 2 * domain.reach + 1
    return states_of(law, losses, domain) * more


def _counts(far: Fraction, reach: int) -> int:
    """Counts in a cell with which the longest way is about `reach` cells and hardly anything more."""
    about = far / reach
    candidates = range(max(1, floor(about * 3 / 4)), max(1, floor(about * 4 / 3)) + 1)
    return max(candidates, key=lambda n: (floor((far + 1) / n) * n / (far + 1), n))


def _two_sided(law: FiniteLaw) -> bool:
    return law.surface == "none" or (law.relaxing is not None and law.surface == "position")


def _shallow(law: FiniteLaw, domain: Domain) -> Domain:
    """Only some cells deep, where the law is linear inside."""
    if law.is_curve or law.relaxing is not None:
        return domain
    lowest = max(domain.lowest, -_MAX_DEPTH) if law.surface == "none" else domain.lowest
    return replace(domain, lowest=lowest, highest=min(domain.highest, max(_MAX_DEPTH, 3 * domain.reach)))


def _near(law: FiniteLaw, domain: Domain, remembered: int) -> Domain:
    """A hand that stays near an edge: few counts deep, few counts in a sample."""
    reach = min(domain.reach, _NEAR // (1 + remembered))
    highest = min(domain.highest, 2 * _NEAR)
    lowest = max(domain.lowest, -2 * _NEAR if _two_sided(law) else 1 - (remembered + 1) * reach)
    return replace(
        domain, lowest=lowest, highest=highest, reach=reach, max_speed=min(domain.speed, Fraction(reach))
    )
