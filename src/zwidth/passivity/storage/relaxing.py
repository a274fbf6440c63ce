"""Laws that relax: the game with one continuous memory.

A Maxwell branch or a one-pole filter gives

    y = g (u_k − a_k),      a_{k+1} = p a_k + (1 − p) u_k

a the average of all readings before, with weights that die out.  V is linear
between levels of a as well.  A move from a leads to an a' that moves by p times as
much, so that between two neighbouring levels V(s', a') has one kink at most: a
move that is harmless at both levels and at that kink is harmless between them.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from itertools import product
from math import ceil, floor

import numpy as np

from zwidth.compiled import compiled
from zwidth.passivity.storage.board import NOWHERE, Board, Integers

ONE = 1 << 16
"""Weights of interpolation are whole multiples of 1/ONE, taken from both sides."""


@dataclass(frozen=True)
class RelaxingBoard(Board):
    """A board with levels of the average reading as a further dimension of its states.

    Parameters
    ----------
    levels
        Levels of a per count.
    """

    levels: int = 1

    @property
    def _largest_energy(self) -> int:
        """Smaller, because energies are multiplied with weights."""
        return 2**44

    @property
    def pole(self) -> Fraction:
        """p of the relaxing memory."""
        assert self.law.relaxing is not None
        return self.law.relaxing[0]

    @cached_property
    def readings(self) -> tuple[int, int]:
        """The least and the largest u that is averaged, in counts."""
        low = 0 if self.law.surface == "penetration" else self.domain.lowest
        return low, max(self.domain.highest, low + 1)

    @property
    def averages(self) -> int:
        """How many levels of a there are."""
        low, high = self.readings
        return (high - low) * self.levels + 1

    @cached_property
    def branch_unit(self) -> int:
        """g times one level of a, in force units."""
        assert self.law.relaxing is not None
        return floor(self.law.relaxing[1] * self.losses.resolution / self.levels / self.force_unit)

    @property
    def rounding(self) -> int:
        """Units by which a force may be off."""
        return super().rounding + 2 * self.averages + 2

    @cached_property
    def rows(self) -> Integers:
        """Which cell the hand was in when the force was computed, as a row; −1 off the board."""
        cells = np.arange(self.domain.cells, dtype=np.int64)[:, None]
        differences = np.arange(-self.domain.reach, self.domain.reach + 1, dtype=np.int64)
        columns = np.array(list(product(differences, repeat=self.memory)), dtype=np.int64)
        columns = columns.reshape(self.histories, self.memory)
        out: Integers = np.where(self.forces == NOWHERE, -1, cells + columns.sum(axis=1)[None, :])
        return out

    @cached_property
    def all_forces(self) -> tuple[Integers, Integers]:
        """The force of each cell (rows) at each level of a, for a move inwards and for one outwards.

        They differ where a law that never pulls begins to push between two levels:
        there a move inwards is given the cheaper force of the two.
        """
        low, _ = self.readings
        cells = np.arange(self.domain.lowest, self.domain.highest + 1, dtype=np.int64)[:, None]
        u = np.maximum(cells, 0) if self.law.surface == "penetration" else cells
        levels = np.arange(self.averages, dtype=np.int64)[None, :]
        spring = floor(self.law.taps[0] * self.losses.resolution / self.force_unit)
        force = spring * u + self.branch_unit * ((u - low) * self.levels - levels)
        inwards = force
        if self.law.clamped:
            pushes = force > 0
            lonely = np.zeros_like(pushes)  # pushes, and a neighbouring level does not
            lonely[:, 1:] |= pushes[:, 1:] & ~pushes[:, :-1]
            lonely[:, :-1] |= pushes[:, :-1] & ~pushes[:, 1:]
            force = np.where(pushes, force, 0)
            inwards = np.where(lonely, 0, force) if self.rules == "generous" else force
        if self.law.surface != "none":
            force, inwards = (np.where(cells > 0, f, 0) for f in (force, inwards))
        return inwards, force

    @cached_property
    def images(self) -> tuple[Integers, Integers, Integers]:
        """Where a goes from each level (columns) under each reading (rows): level, and weight of the next.

        The third is the weight rounded up: the truth lies between the two.
        """
        low, _ = self.readings
        shape = (self.domain.cells, self.averages)
        at, below, above = (np.zeros(shape, np.int64) for _ in range(3))
        for row, n in enumerate(range(self.domain.lowest, self.domain.highest + 1)):
            u = max(n, 0) if self.law.surface == "penetration" else n
            forgotten = self.law.resets and u <= 0
            for i in range(self.averages):
                image = self.pole * i + (1 - self.pole) * (u - low) * self.levels
                image = Fraction(-low * self.levels) if forgotten else image
                whole = min(floor(image), self.averages - 2)
                weight = (image - whole) * ONE
                at[row, i], below[row, i], above[row, i] = whole, floor(weight), ceil(weight)
        return at, below, above

    @cached_property
    def relaxing_guess(self) -> Integers:
        """A start of the search: the energy of the spring."""
        guess = np.ceil(self._spring_energy() * self.steps).astype(np.int64)
        shape = (self.domain.cells, self.histories, self.averages, len(self.knots))
        out: Integers = np.broadcast_to(guess[:, None, None, :], shape).copy()
        return out


@compiled
def sweep_relaxing(
    value: Integers,
    before: Integers,
    rows: Integers,
    inwards: Integers,
    outwards: Integers,
    at: Integers,
    below: Integers,
    above: Integers,
    costs: Integers,
    knots: Integers,
    steps: int,
    first: int,
    last: int,
    reach: int,
    kinks: bool,
) -> int:
    """Improve the states of the cells first … last − 1; returns how many improved.

    value is (cells, histories, levels, knots); before is value as it was before this round.  Of other
    cells before is read: what they become meanwhile depends on which thread is the faster.
    """
    cells, histories, levels, edges = value.shape
    older = histories // (2 * reach + 1) if histories > 1 else 1
    there = np.empty((cells, edges), np.int64)
    improved = 0
    for n in range(first, last):
        low, high = max(0, n - reach), min(cells - 1, n + reach)
        for h in range(histories):
            row = rows[n, h]
            if row < 0:
                continue
            newer = h // (2 * reach + 1)
            for i in range(levels):
                m = at[row, i]
                for n2 in range(low, high + 1):
                    h2 = (n - n2 + reach) * older + newer if histories > 1 else 0
                    goals = value[n2, h2] if first <= n2 < last else before[n2, h2]
                    for j2 in range(edges):
                        a = goals[m, j2]
                        step = goals[m + 1, j2] - a
                        weight = above[row, i] if step > 0 else below[row, i]
                        there[n2, j2] = a - ((-step * weight) >> 16)
                for j in range(edges):
                    best = value[n, h, i, j]
                    for n2 in range(low, high + 1):
                        for j2 in range(edges):
                            d = (n2 - n) * steps + knots[j2] - knots[j]
                            if abs(d) >= costs.size:
                                continue
                            f = inwards[row, i] if d > 0 else outwards[row, i]
                            a = there[n2, j2] - costs[abs(d)] - f * d
                            best = max(best, a)
                    if best > value[n, h, i, j]:
                        value[n, h, i, j] = best
                        improved += 1
                if not kinks or i == 0:
                    continue
                # between the levels i − 1 and i: where the image passes a level
                m = at[row, i - 1] + 1
                if m > at[row, i] or (m == at[row, i] and above[row, i] == 0):
                    continue
                span = (at[row, i] - at[row, i - 1]) * (1 << 16) + above[row, i] - below[row, i - 1]
                part = (1 << 16) - above[row, i - 1]
                early = (part << 16) // span
                late = -((-(part + 1) << 16) // max(span - 2, 1))
                late = min(late, 1 << 16)
                for n2 in range(low, high + 1):
                    h2 = (n - n2 + reach) * older + newer if histories > 1 else 0
                    goals = value[n2, h2] if first <= n2 < last else before[n2, h2]
                    for j2 in range(edges):
                        goal = goals[m, j2]
                        for j in range(edges):
                            d = (n2 - n) * steps + knots[j2] - knots[j]
                            if abs(d) >= costs.size:
                                continue
                            f0 = inwards[row, i - 1] if d > 0 else outwards[row, i - 1]
                            f1 = inwards[row, i] if d > 0 else outwards[row, i]
                            start = value[n, h, i - 1, j] + f0 * d
                            rise = value[n, h, i, j] + f1 * d - start
                            least = start + min((rise * early) >> 16, (rise * late) >> 16)
                            lack = goal - costs[abs(d)] - least
                            if lack > 0:
                                value[n, h, i - 1, j] += lack
                                value[n, h, i, j] += lack
                                improved += 1
    return improved
