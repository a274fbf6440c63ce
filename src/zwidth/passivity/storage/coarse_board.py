"""A board for encoders that are finer than what is looked at: cells of any length, V at their ends.

y = x − Δ; the law acts inside where y ≥ 0.  A reading is y + Δ/2 but for Δ/2, which Coulomb friction pays for
(‖c‖₁ Δ/2); the force of y + Δ/2 is linear within the cells.  By the rules of this board

    a move over D cells costs  φ D,  φ − κ,  φ D + β D² − (β + κ)/4     for D = 0, D = 1, D ≥ 2

κ = max(Σ c⁺, Σ c⁻): a hand that cannot win at the cells' ends cannot win in between (see the documentation).
At y = 0 there are two ends, the outer and the inner one.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from math import ceil, floor

import numpy as np

from zwidth.compiled import compiled
from zwidth.passivity.storage.board import NOWHERE, Board, Domain, Integers
from zwidth.passivity.storage.law import FiniteLaw
from zwidth.passivity.storage.losses import Losses
from zwidth.passivity.storage.parts import second_moves
from zwidth.passivity.storage.sweep import extremes, improve


@dataclass(frozen=True, kw_only=True)
class CoarseBoard(Board):
    """Ends of cells in a row; domain and losses are in cells, the ends counted from the lowest.

    Parameters
    ----------
    count
        Δ, the encoder's own [m; rad].
    """

    count: Fraction

    @property
    def sheets(self) -> int:
        """1 where the surface is two ends."""
        return int(self.law.surface != "none")

    @property
    def width(self) -> int:
        """Values of one difference between two ends."""
        return 2 * self.domain.reach + 1

    @cached_property
    def knots(self) -> Integers:
        """One for each end."""
        return np.zeros(1, np.int64)

    @cached_property
    def places(self) -> Integers:
        """Where each end is, in cells."""
        ends = np.arange(self.domain.lowest, self.domain.highest + 1, dtype=np.int64)
        return ends - self.sheets * (ends > 0)

    @property
    def rounding(self) -> int:
        """Units by which a force may be off."""
        return len(self.law.taps) * (int(np.abs(self.places).max()) + 1)

    def _costs(self, part: Fraction) -> Integers:
        taps, unit, cell = self.law.taps, self.force_unit, self.losses.resolution
        far = np.arange(ceil(self.domain.speed * part) + 1, dtype=np.int64)
        friction = self.losses.coulomb_friction - sum(map(abs, taps), Fraction(0)) * self.count / 2
        drag = floor(self.losses.damping / (part * self.losses.period) * cell / unit)
        rising, falling = (sum((max(s * c, Fraction(0)) for c in taps), Fraction(0)) for s in (1, -1))
        lost = ceil(max(rising, falling) * cell / unit)
        curved = np.where(far > 1, drag * far**2 - (drag + lost + 3) // 4, np.where(far > 0, -lost, 0))
        out: Integers = (floor(friction / unit) - self.rounding) * far + curved
        return out

    def _force(self, readings: list[Integers]) -> Integers:
        """Of ends in place of readings."""
        sheets, law, unit = self.sheets, self.law, self.force_unit
        force = np.zeros(np.broadcast_shapes(*(r.shape for r in readings)), dtype=np.int64)
        for tap, end in zip(law.taps, readings, strict=True):
            place = end - sheets * (end > 0)
            fed = floor(tap * self.losses.resolution / unit) * place + floor(tap * self.count / 2 / unit)
            force = force + (np.where(end > 0, fed, 0) if law.surface == "penetration" else fed)
        return np.where(np.broadcast_to(readings[0], force.shape) > 0, force, 0) if sheets else force

    @cached_property
    def first_guess(self) -> Integers:
        """The energy of the spring."""
        stiffness = self.law.static_stiffness * self.losses.resolution / self.force_unit
        depth = np.maximum(self.places, 0) if self.sheets else self.places
        energy = np.ceil(np.maximum(float(stiffness) * depth.astype(float) ** 2 / 2, 0)).astype(np.int64)
        shape = (len(self.places), self.histories, 1)
        out: Integers = np.broadcast_to(energy[:, None, None], shape).copy()
        return out


def coarse_board(law: FiniteLaw, losses: Losses, domain: Domain, cells: int) -> CoarseBoard | None:
    """The board on which the longest move is so many cells; None for a law that is not linear inside."""
    bent = law.is_curve or law.clamped or law.relaxing is not None or law.rate
    if bent or law.force_limit is not None or law.force_step is not None or losses.curve is not None:
        return None
    counts = domain.speed / cells
    if counts <= 1 or not law.taps:
        return None
    sheets = law.surface != "none"
    highest = ceil((domain.highest + 1) / counts)
    memory = law.memory + losses.delay
    lowest = -(memory + 1) * cells if sheets else -highest - 1
    within = Domain(lowest, highest + sheets, cells + sheets, None, Fraction(cells))
    cell = replace(losses, resolution=losses.resolution * counts)
    return CoarseBoard(law, cell, within, 1, "generous", count=losses.resolution)


@compiled
def sweep_line(
    value: Integers,
    choice: Integers,
    forces: Integers,
    costs: Integers,
    places: Integers,
    first: int,
    last: int,
    reach: int,
) -> int:
    """As `sweep`, on the ends of cells; value is (ends, histories, 1)."""
    values, choices = value.reshape(-1), choice.reshape(-1)
    most = 2 * reach + 1
    worth, place, there = np.empty(most, np.int64), np.empty(most, np.int64), np.empty(most, np.int64)
    gain, move, goal = np.empty(most, np.int64), np.empty(most, np.int64), np.empty(most, np.int64)
    knots = np.zeros(1, np.int64)
    improved = 0
    for group in range(first, last):
        least, greatest = extremes(forces, group, reach)
        if least > greatest:
            continue
        points = ends_in_reach(values, forces, places, group, reach, worth, place, there)
        improved += improve(
            values, choices, forces, costs, knots, group, reach, least, greatest, points, values, there,
            place, there, 0, gain, move, goal,
        )  # fmt: skip
    return improved


@compiled
def sweep_line_parts(
    value: Integers,
    choice: Integers,
    forces: Integers,
    costs: Integers,
    places: Integers,
    later_forces: Integers,
    later_costs: Integers,
    first: int,
    last: int,
    reach: int,
) -> int:
    """As `sweep_parts`, on the ends of cells."""
    values, choices = value.reshape(-1), choice.reshape(-1)
    per_cell = forces.shape[1] // (2 * reach + 1)
    most = 2 * reach + 1
    worth, place, there = np.empty(most, np.int64), np.empty(most, np.int64), np.empty(most, np.int64)
    gain, move, goal = np.empty(most, np.int64), np.empty(most, np.int64), np.empty(most, np.int64)
    best, stops, itself = np.empty(most, np.int64), np.empty(most, np.int64), np.arange(most)
    knots = np.zeros(1, np.int64)
    improved = 0
    for group in range(first, last):
        least, greatest = extremes(forces, group, reach)
        if least > greatest:
            continue
        n, newer = group // per_cell, group % per_cell
        later = NOWHERE
        for h in range(newer * (2 * reach + 1), (newer + 1) * (2 * reach + 1)):
            if later == NOWHERE:
                later = later_forces[n, h]
        points = ends_in_reach(values, forces, places, group, reach, worth, place, there)
        second_moves(worth, place, there, points, later, later_costs, best, stops)
        improved += improve(
            values, choices, forces, costs, knots, group, reach, least, greatest, points, best, itself,
            place, stops, 0, gain, move, goal,
        )  # fmt: skip
    return improved


@compiled
def ends_in_reach(
    values: Integers,
    forces: Integers,
    places: Integers,
    group: int,
    reach: int,
    worth: Integers,
    place: Integers,
    there: Integers,
) -> int:
    """Where a group may go, by place, the better of the two ends at the surface; returns how many."""
    ends, histories = forces.shape
    has_memory = histories > 1
    per_cell = histories // (2 * reach + 1) if has_memory else 1
    n, newer = group // per_cell, group % per_cell
    count = 0
    for n2 in range(max(0, n - reach), min(ends - 1, n + reach) + 1):
        target = n2 * histories + ((n - n2 + reach) * per_cell + newer if has_memory else 0)
        y = places[n2] - places[n]
        if count > 0 and place[count - 1] == y:
            count -= 1
            if values[target] <= worth[count]:
                count += 1
                continue
        worth[count], place[count], there[count] = values[target], y, target
        count += 1
    return count
