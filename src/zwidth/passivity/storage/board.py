"""The board of the game: positions, memory and forces in whole numbers.

A cell is one encoder count, cut into small steps; the hand stands on some of
them, its knots, both edges of the cell among them.  A state is the cell n, the
last differences e_i = n_{k−i} − n_{k−i+1} and a knot.  Forces are whole multiples
of one small unit, so that energies are whole multiples of unit × step and nothing
is rounded while the game is played.

Two sets of rules, one for each side of the bracket:

generous   every step is a knot.  A move over D steps costs φ D + β (D² − ¼), but
           φ D if D ≤ 1, and forces are rounded in the hand's favour.  Whoever
           cannot win by these rules cannot win at all: a function that is linear
           between the knots and satisfies every move between knots satisfies
           every move (see the documentation).
strict     it costs φ D + β D², forces rounded against the hand.  Whoever wins by
           these rules has a real motion that gains.  The knots lie close to the
           edges, where it pays to be.

Of a fine encoder a hand may keep to every n-th count.  A cell is then n counts long
and the hand stands in the first of them only: a strict game with few cells, in which
every reading and every move is one of the fine encoder.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from itertools import product
from math import ceil, floor, isqrt, lcm
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from zwidth.passivity.storage.law import FiniteLaw
from zwidth.passivity.storage.losses import Losses, generous, strict

Integers = NDArray[np.int64]
Rules = Literal["generous", "strict"]

NOWHERE = 2**62
"""In place of the force of a state that is not on the board."""


@dataclass(frozen=True)
class Domain:
    """Where the hand may be and how far it may go in one sample, in counts.

    Parameters
    ----------
    lowest, highest
        The first and the last cell.
    reach
        The largest difference of two successive readings.
    deepest, fastest
        The bounds themselves, which need not be whole counts: no motion goes beyond
        them.  None: the upper edge of the last cell, and the reach.
    """

    lowest: int
    highest: int
    reach: int
    deepest: Fraction | None = None
    fastest: Fraction | None = None

    @property
    def cells(self) -> int:
        """How many there are."""
        return self.highest - self.lowest + 1

    @property
    def speed(self) -> Fraction:
        """The longest way in one sample, in counts."""
        return Fraction(self.reach) if self.fastest is None else self.fastest

    def every(self, counts: int, remembered: int, sides: bool) -> Domain | None:
        """Cells of so many counts within the bounds, the hand in the first count of each; None without any.

        `remembered` readings before the last one; `sides`: the board ends outside as it does inside.
        """
        within = self.within
        highest, reach = within.highest // counts, floor((self.speed + 1) / counts)
        if highest < 1 or reach < 1:
            return None
        lowest = 1 - (remembered + 1) * reach
        if sides:
            lowest = -(-within.lowest // counts)
        deepest = self.highest + 1 if self.deepest is None else self.deepest
        return Domain(lowest, highest, reach, Fraction(deepest) / counts, self.speed / counts)

    @property
    def within(self) -> Domain:
        """Only the cells that lie within the bounds."""
        if self.deepest is None:
            return self
        highest = floor(self.deepest) - 1
        beyond = self.lowest < -self.highest - 1  # farther out than deep: no depth counts there
        lowest = self.lowest if beyond else max(self.lowest, -floor(self.deepest))
        return Domain(lowest, highest, self.reach, self.deepest, self.fastest)


@dataclass(frozen=True)
class Board:
    """The law, the losses and the domain on a grid of knots.

    Parameters
    ----------
    law, losses, domain
        What is played.
    steps
        Into how many a cell is cut.
    rules
        "generous" or "strict".
    every
        Counts of the encoder in a cell; more than 1 by the strict rules only.  Losses and
        domain are in cells.
    """

    law: FiniteLaw
    losses: Losses
    domain: Domain
    steps: int
    rules: Rules
    every: int = 1

    @cached_property
    def knots(self) -> Integers:
        """Where in a cell the hand may stand, in steps."""
        if self.rules == "generous":
            return np.arange(self.steps + 1, dtype=np.int64)
        if self.every > 1:  # where in its count the hand stands hardly matters
            return np.array([0, self.count_steps], dtype=np.int64)
        spans = (self.losses.part, 1 - self.losses.part)
        far = (self._farthest(span) % self.steps for span in spans)  # from an edge as far as it may go
        count = self.count_steps
        near = [0, 1, isqrt(count), count // 4, *far]
        if self.losses.part < 1:  # the hand turns within the cell
            near += range(0, count, max(count // 16, 1))
        places = np.unique([*near, count // 2, *(count - k for k in near)]).astype(np.int64)
        return places[(places >= 0) & (places <= count)]

    @property
    def count_steps(self) -> int:
        """Steps in one count of the encoder."""
        return self.steps // self.every

    @property
    def encoder(self) -> Losses:
        """The losses with the encoder as it is, a cell being one count or more."""
        return replace(self.losses, resolution=self.losses.resolution / self.every)

    @property
    def memory(self) -> int:
        """Readings besides the last one that a state holds."""
        return self.law.memory + self.losses.delay

    @property
    def width(self) -> int:
        """Values of one difference of readings."""
        return 2 * self.domain.reach + 1

    @property
    def histories(self) -> int:
        """Values of all differences together."""
        return int(self.width**self.memory)

    @cached_property
    def force_unit(self) -> Fraction:
        """A power of two, so small that rounding does not matter and so large that sums are exact."""
        span = 4 * self.domain.cells * self.steps
        most = max(self._largest_force, self.losses.largest[0], Fraction(1, 10**12))
        exponent = _power_above(most * span / self._largest_energy)
        return Fraction(2) ** exponent

    @property
    def _largest_energy(self) -> int:
        """Force × span stays below: sums of moves stay exact in doubles and products in 64 bits."""
        return 2**48

    @property
    def _largest_force(self) -> Fraction:
        n = max(abs(self.domain.lowest), abs(self.domain.highest)) + self.domain.reach
        spring = max((abs(f) for _, f in self.law.points), default=Fraction(0))
        if self.law.power is not None:
            spring = self.law.resting(self.domain.highest * self.losses.resolution)
        spring *= 1 + abs(self.law.rate) * self.domain.reach * self.losses.resolution
        relaxing = Fraction(0) if self.law.relaxing is None else 2 * abs(self.law.relaxing[1])
        stiffness = sum((abs(c) for c in self.law.taps), Fraction(0)) + relaxing
        shortest = min(self.losses.part, 1 - self.losses.part) or Fraction(1)
        drag = self.losses.largest[1] / self.losses.period * (self.domain.reach + 1 / shortest)
        return (stiffness * n + drag) * self.losses.resolution + spring + (self.law.force_step or 0)

    def law_document(self, motion: str, places: Iterable[Fraction] | None = None) -> dict[str, Any]:
        """The law as exact data, a contact by its force at every reading on the board, or of these places."""
        step = self.encoder.resolution
        if places is None:
            readings = set(range((self.domain.highest + 1) * self.every))
        else:
            readings = {0, *(max(x // step, 0) for x in places)}
        return self.law.document(motion, (n * step for n in sorted(readings)))

    @property
    def rounding(self) -> int:
        """Units by which a force may be off: each tap is rounded down and times a reading."""
        farthest = max(abs(self.domain.lowest), abs(self.domain.highest))
        return len(self.law.taps) * farthest + 2

    @property
    def energy_unit(self) -> Fraction:
        """One force unit over one step [J]."""
        return self.force_unit * self.losses.resolution / self.steps

    @cached_property
    def costs(self) -> Integers:
        """What a move over 0, 1, … steps costs while the first force of an interval acts, in energy units."""
        return self._costs(self.losses.part)

    @cached_property
    def later_costs(self) -> Integers:
        """The same for the rest of the interval; of no use where there is none."""
        return self._costs(1 - self.losses.part)

    def _costs(self, part: Fraction) -> Integers:
        span = part * self.losses.period
        step = self.losses.resolution / self.steps
        far = np.arange(self._farthest(part) + 1, dtype=np.int64)
        rule = generous if self.rules == "generous" else strict
        return rule(self.losses, far, span, step, self.force_unit, self.rounding)

    def _farthest(self, part: Fraction) -> int:
        """The longest move, in steps; generous: between two knots it reaches no farther than the next one."""
        longest = self.domain.speed * part * self.steps
        if self.rules == "generous":
            return ceil(longest)
        whole = floor(longest)  # a hand that stays below an edge may have to go a little farther
        return max(whole - 1, 0) if longest == whole and whole % self.steps else whole

    @cached_property
    def forces(self) -> Integers:
        """Force in units for every cell (rows) and history (columns); NOWHERE off the board.

        The first of the interval, where a delay makes two.
        """
        return self._forces(self.losses.delay)

    @cached_property
    def later_forces(self) -> Integers:
        """The force in the rest of the interval; of no use where there is none."""
        return self._forces(self.losses.delay - 1)

    def _forces(self, age: int) -> Integers:
        low, high = self.domain.lowest, self.domain.highest
        cells = np.arange(low, high + 1, dtype=np.int64)[:, None]
        differences = np.arange(-self.domain.reach, self.domain.reach + 1, dtype=np.int64)
        columns = np.array(list(product(differences, repeat=self.memory)), dtype=np.int64)
        columns = columns.reshape(self.histories, self.memory)
        readings = [cells + columns[:, :i].sum(axis=1)[None, :] for i in range(self.memory + 1)]
        on_board = np.ones((len(cells), self.histories), dtype=bool)
        for reading in readings:
            on_board &= (reading >= low) & (reading <= high)
        used = readings[age : age + self.law.memory + 1]
        forces: Integers = np.where(on_board, self._force(used), NOWHERE)
        return forces

    def _force(self, readings: list[Integers]) -> Integers:
        force: Integers
        law, shape = self.law, np.broadcast_shapes(*(r.shape for r in readings))
        if law.force_step is not None or law.is_curve:
            force = self._floored(*self._wish(readings))
        else:
            force = np.zeros(shape, dtype=np.int64)
            for tap, reading in zip(law.taps, readings, strict=True):
                u = np.maximum(reading, 0) if law.surface == "penetration" else reading
                force = force + floor(tap * self.losses.resolution / self.force_unit) * u
        if law.clamped:
            force = np.maximum(force, 0)
        if law.force_limit is not None:
            most = floor(law.force_limit / self.force_unit)
            force = np.clip(force, -most, most)
        if law.surface != "none":
            force = np.where(np.broadcast_to(readings[0], shape) > 0, force, 0)
        return force

    def _floored(self, wish: NDArray[np.object_], per: int) -> Integers:
        """Forces in units, those of a converter after its rounding, which is decided exactly."""
        force: Integers
        step, unit = self.law.force_step, self.force_unit
        if step is None:
            force = (wish * unit.denominator // (per * unit.numerator)).astype(np.int64)
            return force
        steps = (2 * wish * step.denominator + per * step.numerator) // (2 * per * step.numerator)
        several, where = np.unique(steps, return_inverse=True)
        units = np.array([floor(k * step / unit) for k in several], dtype=np.int64)
        force = units[where].reshape(steps.shape)
        return force

    def _wish(self, readings: list[Integers]) -> tuple[NDArray[np.object_], int]:
        """The force of the law alone, exactly: whole numbers of any size, over one denominator [N; N·m]."""
        law, resolution = self.law, self.losses.resolution
        if law.is_curve:
            low, high = self.domain.lowest, self.domain.highest
            table = [law.resting(n * resolution) for n in range(low, high + 1)]
            per = lcm(*(f.denominator for f in table))
            whole = np.array([int(f * per) for f in table], dtype=object)
            resting = whole[np.clip(readings[0] - low, 0, high - low)]
            if not law.rate:
                return np.broadcast_to(resting, np.broadcast_shapes(*(r.shape for r in readings))), per
            rise = law.rate * resolution
            moved = (readings[0] - readings[1]).astype(object)
            return resting * (rise.denominator + rise.numerator * moved), per * rise.denominator
        counts = [np.maximum(r, 0) if law.surface == "penetration" else r for r in readings]
        per = lcm(*((c * resolution).denominator for c in law.taps))
        taps = [int(c * resolution * per) for c in law.taps]
        parts = [c * u.astype(object) for c, u in zip(taps, counts, strict=True)]
        return np.add.reduce(np.broadcast_arrays(*parts)), per

    @cached_property
    def first_guess(self) -> Integers:
        """Where the search for a storage function starts: that of a damped wall, rounded.

        V = ∫ f from the middle of the first cell + ½ Σ_j (Σ_{i≥j} |w_i|) d_j², d_j the
        least the hand can have moved.  Any start ends at a storage function if
        there is one; from this one the search is short.
        """
        energy = self._spring_energy()[:, None, :] + np.zeros((1, self.histories, 1))
        weights = self._lag_weights()
        for lag, distance in enumerate(self._least_moves()):
            energy = energy + 0.5 * sum(weights[lag:]) * distance**2
        guess: Integers = np.ceil(np.maximum(energy, 0.0) * self.steps).astype(np.int64)
        return guess

    def _spring_energy(self) -> NDArray[np.float64]:
        """Energy of the resting hand's force, cell by knot, in force units times counts."""
        at_rest = self.forces[:, self.histories // 2].astype(float)  # the middle history: no differences
        middles = np.concatenate(([0.0], np.cumsum((at_rest[1:] + at_rest[:-1]) / 2)))
        x = np.arange(self.domain.cells)[:, None] + self.knots / self.steps - 0.5
        low = np.clip(np.floor(x).astype(np.int64), 0, self.domain.cells - 1)
        slope = np.append(np.diff(at_rest), 0.0)[low]
        energy: NDArray[np.float64] = middles[low] + at_rest[low] * (x - low) + slope * (x - low) ** 2 / 2
        energy -= energy.min()
        return energy

    def _lag_weights(self) -> list[float]:
        """|w_i| of f = K u + Σ w_i (u_{k−i} − u_{k−i−1}) in force units per count, delay included."""
        if not self.memory:
            return []
        unit = float(self.losses.resolution / self.force_unit)
        taps = [float(c) * unit for c in self.law.taps] or [0.0]
        stiffness = float(self.law.static_stiffness) * unit
        taps[0] -= stiffness
        damper = [abs(w) for w in np.cumsum(taps)[:-1]]
        return [abs(stiffness)] * self.losses.delay + damper

    def _least_moves(self) -> list[NDArray[np.float64]]:
        """How far the hand has at least moved in each remembered interval, in counts."""
        differences = np.arange(-self.domain.reach, self.domain.reach + 1)
        columns = np.array(list(product(differences, repeat=self.memory))).reshape(
            self.histories, self.memory
        )
        xi = self.knots / self.steps
        moves: list[NDArray[np.float64]] = []
        for lag in range(self.memory):
            e = columns[:, lag][None, :, None]
            if lag == 0:  # from the edge of the cell before to where in its cell the hand is now
                moves.append(np.maximum(np.maximum(xi - (e + 1), e - xi), 0.0))
            else:
                moves.append(np.maximum(np.abs(e) - 1, 0) + 0.0 * xi)
        return moves


def _power_above(value: Fraction) -> int:
    """The least whole e with 2^e ≥ value > 0."""
    e = value.numerator.bit_length() - value.denominator.bit_length()
    while Fraction(2) ** e < value:
        e += 1
    while Fraction(2) ** (e - 1) >= value:
        e -= 1
    return e
