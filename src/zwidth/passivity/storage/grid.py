"""A grid of the dynamic program: positions, memory and forces in whole numbers.

A cell is one encoder count, cut into small steps; the hand stands on some of them, its nodes, both edges of
the cell among them.  A state is the cell n, the last differences e_i = n_{k−i} − n_{k−i+1} and a node.
Forces are whole multiples of one small unit, so that energies are whole multiples of unit × step and nothing
is rounded while values are iterated.

Two approximations of what a hand can do, one for each side of the bracket:

outer      every step is a node.  A move over D steps costs φ D + β (D² − ¼), but
           φ D if D ≤ 1, and forces are rounded in the hand's favour.  A hand that
           gains nothing by these numbers gains nothing at all: a function that is
           linear between the nodes and satisfies every move between nodes satisfies
           every move (see the documentation).
inner      it costs φ D + β D², forces rounded against the hand.  A cycle that gains
           by these numbers is a real motion that gains.  The nodes lie close to the
           edges, where it pays to be.

Of a fine encoder a hand may keep to every n-th count.  A cell is then n counts long
and the hand stands in the first of them only: an inner approximation with few cells,
in which every reading and every move is one of the fine encoder.
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

from zwidth.passivity.storage.domain import Domain, Integers, Losses, inner_costs, outer_costs
from zwidth.passivity.storage.hull import NOWHERE, ONE_MOVE, sweep, sweep_turning
from zwidth.passivity.storage.law import FiniteLaw
from zwidth.passivity.storage.value_iteration import BestMoves, Move, Sweep
from zwidth.quantity.text import exact_text

Approximation = Literal["outer", "inner"]

_BY_ONE_HULL, _BY_HULLS, _BY_MOVES = 5e-8, 2e-7, 2e-8
"""What a state, or a move from it, costs in a round by each kernel, in the unit of `effort`."""


@dataclass(frozen=True)
class Grid:
    """The law, the losses and the domain on a grid of nodes."""

    # the loop, and where the hand may be
    law: FiniteLaw
    losses: Losses
    domain: Domain
    steps: int  # into how many a cell is cut
    approximation: Approximation  # "outer" or "inner"
    # counts of the encoder in a cell; more than 1 in an inner approximation only.  Losses and domain are in
    # cells.
    every: int = 1

    @cached_property
    def nodes(self) -> Integers:
        """Where in a cell the hand may stand, in steps."""
        if self.approximation == "outer":
            return np.arange(self.steps + 1, dtype=np.int64)
        if self.every > 1:  # where in its count the hand stands hardly matters
            return np.array([0, self.count_steps], dtype=np.int64)
        spans = (self.losses.part, 1 - self.losses.part)
        far = (self._longest_move(span) % self.steps for span in spans)  # from an edge as far as it may go
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
    def differences(self) -> Integers:
        """Of each history (rows) the last differences of readings, the newest first."""
        one = range(-self.domain.reach, self.domain.reach + 1)
        every = np.array(list(product(one, repeat=self.memory)), dtype=np.int64)
        return every.reshape(self.histories, self.memory)

    @cached_property
    def force_unit(self) -> Fraction:
        """A power of two, so small that rounding does not matter and so large that sums are exact."""
        span = 4 * self.domain.cells * self.steps
        most = max(self._max_force, self.losses.max_friction[0], Fraction(1, 10**12))
        exponent = _power_above(most * span / self._max_energy)
        return Fraction(2) ** exponent

    @property
    def _max_energy(self) -> int:
        """Force × span stays below: sums of moves stay exact in doubles and products in 64 bits."""
        return 2**48

    @property
    def _max_force(self) -> Fraction:
        n = max(abs(self.domain.lowest), abs(self.domain.highest)) + self.domain.reach
        spring = max((abs(f) for _, f in self.law.points), default=Fraction(0))
        if self.law.power is not None:
            spring = self.law.resting(self.domain.highest * self.losses.resolution)
        spring *= 1 + abs(self.law.rate) * self.domain.reach * self.losses.resolution
        relaxing = Fraction(0) if self.law.relaxing is None else 2 * abs(self.law.relaxing[1])
        stiffness = sum((abs(c) for c in self.law.taps), Fraction(0)) + relaxing
        shortest = min(self.losses.part, 1 - self.losses.part) or Fraction(1)
        drag = self.losses.max_friction[1] / self.losses.period * (self.domain.reach + 1 / shortest)
        return (stiffness * n + drag) * self.losses.resolution + spring + (self.law.force_step or 0)

    def law_document(self, motion: str, places: Iterable[Fraction] | None = None) -> dict[str, Any]:
        """The law as exact data, a contact by its force at every reading on the grid, or of these places."""
        step = self.encoder.resolution
        if places is None:
            readings = set(range((self.domain.highest + 1) * self.every))
        else:
            readings = {0, *(max(x // step, 0) for x in places)}
        return self.law.document(motion, (n * step for n in sorted(readings)))

    def domain_document(self) -> dict[str, Any]:
        """Where the hand may be and how far it may go, as data."""
        far = self.domain.speed
        return {
            "lowest_count": self.domain.lowest,
            "highest_count": self.domain.highest,
            "largest_move_counts": int(far) if far.denominator == 1 else exact_text(far),
            "steps_per_count": self.steps,
        }

    def remembered(self, value: Integers) -> tuple[str, Any, NDArray[np.float64]]:
        """What the law remembers, by its name and its values, and V by it, cell and node; NaN off the grid.

        Here the reading before [counts], and all that came before it alike.
        """
        cells, reach = self.domain.cells, self.domain.reach if self.memory else 0
        stride = self.histories // self.width if self.memory else 1
        out = np.full((cells, cells, self.nodes.size), np.nan)
        for i in range(cells):
            for before in range(max(0, i - reach), min(cells - 1, i + reach) + 1):
                out[before, i] = value[i, self.histories // 2 + (before - i) * stride]
        return "reading_before", np.arange(self.domain.lowest, self.domain.highest + 1), out

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
        far = np.arange(self._longest_move(part) + 1, dtype=np.int64)
        costs = outer_costs if self.approximation == "outer" else inner_costs
        return costs(self.losses, far, span, step, self.force_unit, self.rounding)

    def _longest_move(self, part: Fraction) -> int:
        """The longest move, in steps; outer: between two nodes it reaches no farther than the next one."""
        longest = self.domain.speed * part * self.steps
        if self.approximation == "outer":
            return ceil(longest)
        whole = floor(longest)  # a hand that stays below an edge may have to go a little farther
        return max(whole - 1, 0) if longest == whole and whole % self.steps else whole

    @cached_property
    def forces(self) -> Integers:
        """Force in units for every cell (rows) and history (columns); NOWHERE off the grid.

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
        readings = [cells + self.differences[:, :i].sum(axis=1)[None, :] for i in range(self.memory + 1)]
        on_grid = np.ones((len(cells), self.histories), dtype=bool)
        for reading in readings:
            on_grid &= (reading >= low) & (reading <= high)
        used = readings[age : age + self.law.memory + 1]
        forces: Integers = np.where(on_grid, self._force(used), NOWHERE)
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

    @property
    def places(self) -> Integers:
        """Where each cell begins, in steps from the first."""
        return np.arange(self.domain.cells, dtype=np.int64) * self.steps

    def sweep(self) -> Sweep:
        """What value iteration begins with, and the kernel that improves it."""
        tables: tuple[Any, ...]
        groups = len(self.forces) * (self.histories // self.width if self.memory else 1)
        rest = self.first_guess.copy(), groups, self.move_at
        tables = self.forces, self.costs, self.nodes, self.places, self.domain.reach
        if self.losses.part == 1:
            work = _BY_ONE_HULL if self.hull_steps else _BY_HULLS
            return BestMoves(*rest, sweep, (*tables, self.hull_steps, *ONE_MOVE), work)
        later = self.later_forces, self.later_costs
        if self.every == 1:
            return BestMoves(*rest, sweep, (*tables, 0, *later), _BY_HULLS)
        moves = self.width * self.nodes.size
        return BestMoves(*rest, sweep_turning, (*tables, *later, *self._turning), _BY_MOVES * moves)

    @property
    def hull_steps(self) -> int:
        """Steps of a cell where one hull serves all its nodes; 0 where costs are not φ d + β d²."""
        return self.steps if self.losses.curve is None else 0

    @property
    def _turning(self) -> tuple[float, float, int, int]:
        """Where a hand turns within a sample, in steps and force units; of no use without damping.

        The part of the sample before the turn, (T/2b) α (1 − α), f_c, and how deep the hand may go.
        """
        losses, domain = self.losses, self.domain
        step = losses.resolution / self.steps
        swing = (
            losses.period / (2 * losses.damping) * losses.part * (1 - losses.part) if losses.damping else 0
        )
        top = domain.highest + 1 if domain.max_depth is None else domain.max_depth
        return (
            float(losses.part),
            float(swing * self.force_unit / step),
            int(losses.coulomb_friction / self.force_unit),
            int((top - domain.lowest) * self.steps),
        )

    def move_at(self, state: int) -> Move:
        """The node of a state, in steps from the lower edge of cell 0, and its cell."""
        cell, node = state // (self.histories * self.nodes.size), state % self.nodes.size
        count = cell + self.domain.lowest
        return count * self.steps + int(self.nodes[node]), count

    @cached_property
    def first_guess(self) -> Integers:
        """Where the search for a storage function starts: that of a damped wall, rounded.

        V = ∫ f from the middle of the first cell + ½ Σ_j (Σ_{i≥j} |w_i|) d_j², d_j the least the hand can
        have moved.  Any start ends at a storage function if there is one; from this one the search is short.
        """
        energy = self._spring_energy()[:, None, :] + np.zeros((1, self.histories, 1))
        weights = self._lag_weights()
        for lag, distance in enumerate(self._least_moves()):
            energy = energy + 0.5 * sum(weights[lag:]) * distance**2
        guess: Integers = np.ceil(np.maximum(energy, 0.0) * self.steps).astype(np.int64)
        return guess

    def _spring_energy(self) -> NDArray[np.float64]:
        """Energy of the resting hand's force, cell by node, in force units times counts."""
        at_rest = self.forces[:, self.histories // 2].astype(float)  # the middle history: no differences
        middles = np.concatenate(([0.0], np.cumsum((at_rest[1:] + at_rest[:-1]) / 2)))
        x = np.arange(self.domain.cells)[:, None] + self.nodes / self.steps - 0.5
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
        xi = self.nodes / self.steps
        moves: list[NDArray[np.float64]] = []
        for lag in range(self.memory):
            e = self.differences[:, lag][None, :, None]
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
