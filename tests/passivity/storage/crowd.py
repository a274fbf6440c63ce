"""Many hands at once on one grid: the law, the energy and V in floating point, from their definitions."""

from __future__ import annotations

import numpy as np

TINY = 2.0**-30


def force(law, readings, resolution):
    """The force for an array of readings, newest first in the last axis, in counts [N]."""
    q = readings * resolution
    if law.points:
        x, f = (np.array([float(v) for v in column]) for column in zip(*law.points, strict=True))
        total = np.interp(q[..., 0], x, f)
    elif law.power is not None:
        total = float(law.power[0]) * np.maximum(q[..., 0], 0.0) ** float(law.power[1])
    else:
        u = np.maximum(q, 0.0) if law.surface == "penetration" else q
        total = sum(float(c) * u[..., i] for i, c in enumerate(law.taps))
    if law.rate:
        total = total * (1 + float(law.rate) * (q[..., 0] - q[..., 1]))
    if law.clamped:
        total = np.maximum(total, 0.0)
    if law.force_step is not None:
        total = float(law.force_step) * np.floor(total / float(law.force_step) + 0.5)
    if law.force_limit is not None:
        total = np.clip(total, -float(law.force_limit), float(law.force_limit))
    return total if law.surface == "none" else np.where(readings[..., 0] > 0, total, 0.0)


class Crowd:
    """A grid, its losses, and hands that are somewhere on it: cells, places in them, readings before."""

    def __init__(self, program, storage=None, seed=0):
        self.law, self.losses, self.domain = program.law, program.losses, program.domain
        self.taps = self.law.memory + 1
        self.memory = self.taps - 1 + self.losses.delay
        self.step, self.random = float(self.losses.resolution), np.random.default_rng(seed)
        self.grid = None if storage is None else storage.grid
        self.value = None if storage is None else storage.value * float(self.grid.energy_unit)

    def energy(self, cells, places, before, next_cells, next_places):
        """What the hand takes out by one move [J]."""
        readings = np.concatenate([cells[..., None], before], axis=-1)[..., self.losses.delay :]
        moved = (next_cells - cells + (next_places - places)) * self.step
        drag = float(self.losses.damping / self.losses.period)
        return (
            -force(self.law, readings[..., : self.taps], self.step) * moved
            - float(self.losses.coulomb_friction) * abs(moved)
            - drag * moved**2
        )

    def stored(self, cells, places, before):
        """V there [J], linear between the nodes."""
        reach, column = self.domain.reach, np.zeros(cells.shape, np.int64)
        newer = cells
        for i in range(self.memory):
            column = column * (2 * reach + 1) + before[..., i] - newer + reach
            newer = before[..., i]
        at = places * self.grid.steps
        node = np.minimum(at.astype(np.int64), self.grid.steps - 1)
        rows = cells - self.domain.lowest
        low, high = self.value[rows, column, node], self.value[rows, column, node + 1]
        return low + (at - node) * (high - low)

    def somewhere(self, number):
        """States at random: readings before as a hand could have left them."""
        low, high, reach = self.domain.lowest, self.domain.highest, self.domain.reach
        readings = [self.random.integers(low, high + 1, number)]
        for _ in range(self.memory):
            ahead = self.random.integers(-reach, reach + 1, number)
            ahead = np.where(self.random.random(number) < 0.5, np.sign(ahead), ahead)
            readings.append(np.clip(readings[-1] + ahead, low, high))
        before = np.stack(readings[1:], axis=-1) if self.memory else np.zeros((number, 0), np.int64)
        return readings[0], self.place(number), before

    def place(self, number):
        """Where in a cell: on its edges, next to them, on a node or anywhere."""
        choices = np.stack(
            [
                np.zeros(number),
                np.full(number, 1 - TINY),
                np.full(number, TINY),
                self.random.integers(0, 64, number) / 64,
                self.random.random(number),
            ]
        )
        return choices[self.random.integers(0, len(choices), number), np.arange(number)]

    def wish(self, cells, places, before):
        """A next position for each hand: stay, an edge, where it was, anywhere it can go."""
        number, reach = cells.size, self.domain.reach
        back = before[:, 0] if self.memory else cells
        wished = np.stack(
            [
                cells,
                cells + self.random.integers(-1, 2, number),
                back,
                cells + self.random.integers(-reach, reach + 1, number),
                cells + self.random.choice([-reach, reach], number),
            ]
        )
        there = wished[self.random.integers(0, len(wished), number), np.arange(number)]
        there = np.clip(there, self.domain.lowest, self.domain.highest)
        stop = self.place(number)
        too_far = abs(there - cells + (stop - places)) > float(self.domain.speed)
        return np.where(too_far, cells, there), np.where(too_far, places, stop)

    def after(self, cells, before):
        """The readings before, one sample later."""
        return np.concatenate([cells[:, None], before], axis=1)[:, : self.memory]

    def round_gain(self, positions):
        """Energy out in each round of cycles, an array (cycles, samples) of positions in counts [J]."""
        cells = np.floor(positions).astype(np.int64)
        ages = [np.roll(cells, self.losses.delay + i, axis=1) for i in range(self.taps)]
        moved = (np.roll(positions, -1, axis=1) - positions) * self.step
        drag = float(self.losses.damping / self.losses.period)
        friction = float(self.losses.coulomb_friction)
        work = force(self.law, np.stack(ages, axis=-1), self.step) * moved
        return -(work + friction * abs(moved) + drag * moved**2).sum(axis=1)

    def allowed(self, positions):
        """Which cycles stay within the domain."""
        moved = abs(np.roll(positions, -1, axis=1) - positions)
        low, high = self.domain.lowest, self.domain.highest + 1
        allowed = (positions >= low) & (positions < high) & (moved <= float(self.domain.speed))
        return allowed.all(axis=1)

    def climbed(self, samples, climbers, rounds):
        """The best gain of cycles of so many samples, each changed at random for the better."""
        deepest = self.domain.highest + 1
        lowest = 0 if self.law.surface != "none" else self.domain.lowest
        x = np.repeat(self.random.uniform(lowest, deepest, (climbers, 1)), samples, axis=1)
        best = self.round_gain(x)
        for _ in range(rounds):
            y = x.copy()
            rows, at = np.arange(climbers), self.random.integers(0, samples, climbers)
            size = 10.0 ** self.random.uniform(-4, np.log10(self.domain.reach), climbers)
            kind = self.random.integers(0, 4, climbers)
            y[rows, at] += np.where(kind == 0, size * self.random.normal(size=climbers), 0.0)
            edge = np.round(y[rows, at]) + self.random.choice([-TINY, 0.0, TINY], climbers)
            y[rows, at] = np.where(kind == 1, edge, y[rows, at])
            far_side = self.random.random((climbers, samples)) < 0.5
            toggled = np.where(far_side, TINY, -TINY) + np.round(y[rows, at])[:, None]
            y = np.where((kind == 2)[:, None], toggled, y)
            apart = np.where(far_side, size[:, None], 0.0) + x.min(axis=1)[:, None]
            y = np.where((kind == 3)[:, None], apart, y)
            gain = self.round_gain(y)
            better = self.allowed(y) & (gain > best)
            x[better], best[better] = y[better], gain[better]
        return float(best.max())
