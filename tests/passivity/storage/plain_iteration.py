"""Value iteration once more, by its definition: explicit readings, one move at a time."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from itertools import product
from math import ceil, floor


def exact_force(law, readings, resolution):
    """The force for the readings q_k, q_{k−1}, … in counts, from the law's definition [N]."""
    q = [n * resolution for n in readings]
    if law.points:
        x, below = q[0], [p for p in law.points if p[0] <= q[0]]
        if not below:
            total = law.points[0][1]
        elif len(below) == len(law.points):
            total = law.points[-1][1]
        else:
            (x0, f0), (x1, f1) = below[-1], law.points[len(below)]
            total = f0 * (x1 - x) / (x1 - x0) + f1 * (x - x0) / (x1 - x0)
        if law.rate:
            total += total * law.rate * (q[0] - q[1])
    else:
        u = [max(v, 0) for v in q] if law.surface == "penetration" else q
        total = sum(c * v for c, v in zip(law.taps, u, strict=True))
    if law.clamped and total < 0:
        total = 0
    if law.force_step is not None:
        below = Fraction(total) // law.force_step * law.force_step
        total = below if total - below < law.force_step / 2 else below + law.force_step
    if law.force_limit is not None:
        total = min(law.force_limit, max(-law.force_limit, total))
    return Fraction(0) if law.surface != "none" and q[0] <= 0 else Fraction(total)


class PlainIteration:
    """States (cell, node, readings before) and all their moves, in whole units of force × step."""

    def __init__(self, law, losses, domain, steps, nodes, approximation, unit):
        self.law, self.losses, self.domain, self.steps, self.nodes = law, losses, domain, steps, nodes
        self.outer, self.unit = approximation == "outer", unit
        self.memory = law.memory + losses.delay
        self.cells = range(domain.lowest, domain.highest + 1)
        self.states = [
            (cell, node, before)
            for cell in self.cells
            for before in product(self.cells, repeat=self.memory)
            if all(abs(p - q) <= domain.reach for p, q in zip((cell, *before), before, strict=False))
            for node in nodes
        ]
        self.forces = {s: self._rounded_force(s, losses.delay) for s in self.states}
        self.costs = self._all_costs(losses.part)
        if losses.part < 1:
            self.later_forces = {s: self._rounded_force(s, losses.delay - 1) for s in self.states}
            self.later_costs = self._all_costs(1 - losses.part)
        self.moves = {s: list(self._moves(s)) for s in self.states}

    def _all_costs(self, part):
        far = self.domain.speed * part * self.steps
        whole = ceil(far) if self.outer else floor(far)
        if not self.outer and whole == far and whole % self.steps:
            whole = max(whole - 1, 0)  # a hand that stays below an edge may have to go a little farther
        return [self._cost(d, part) for d in range(whole + 1)]

    def _rounded_force(self, state, age):
        """Of the reading of an age and those before it, in units, every tap, limit and point rounded down."""
        law, resolution, unit = self.law, self.losses.resolution, self.unit
        readings = (state[0], *state[2])[age : age + law.memory + 1]
        if law.surface != "none" and readings[0] <= 0:
            return 0
        if law.points or law.force_step is not None:
            total = floor(exact_force(replace(law, force_limit=None), readings, resolution) / unit)
        else:
            total = 0
            for tap, n in zip(law.taps, readings, strict=True):
                total += floor(tap * resolution / unit) * (max(n, 0) if law.surface == "penetration" else n)
        if law.clamped:
            total = max(total, 0)
        if law.force_limit is not None:
            most = floor(law.force_limit / unit)
            total = min(most, max(-most, total))
        return total

    def _cost(self, d, part):
        farthest = max(abs(self.domain.lowest), abs(self.domain.highest))
        off = len(self.law.taps) * farthest + 2
        friction = floor(self.losses.coulomb_friction / self.unit)
        period = self.losses.period * part
        drag = self.losses.damping / period * (self.losses.resolution / self.steps) / self.unit
        if not self.outer:
            return (friction + off + 1) * d + ceil(drag) * d**2
        return (friction - off) * d + (floor(drag) * d**2 - ceil(Fraction(floor(drag), 4)) if d > 1 else 0)

    def _moves(self, state):
        """(energy out, next state) of every move."""
        cell, node, before = state
        for there in self.cells:
            if abs(there - cell) > self.domain.reach:
                continue
            after = (cell, *before)[: self.memory]
            for stop in self.nodes:
                x = (there - cell) * self.steps + stop - node
                for energy in self._energies(state, x):
                    yield energy, (there, stop, after)

    def _energies(self, state, x):
        """Energy out of a move by x: one, or one for each place where the hand may be in between."""
        if self.losses.part == 1:
            if abs(x) < len(self.costs):
                yield -self.forces[state] * x - self.costs[abs(x)]
            return
        cell, node, _ = state
        places = {
            (n - cell) * self.steps + k - node
            for n in self.cells
            if abs(n - cell) <= self.domain.reach
            for k in self.nodes
        }
        for m in places:
            early, late = abs(m), abs(x - m)
            if early < len(self.costs) and late < len(self.later_costs):
                first = -self.forces[state] * m - self.costs[early]
                yield first - self.later_forces[state] * (x - m) - self.later_costs[late]

    def solved(self, guess):
        """V by Bellman and Ford from a first guess, or None and a cycle that gains."""
        value, best = {s: guess.get(s, 0) for s in self.states}, {}
        for _ in range(len(self.states) + 1):
            improved = False
            for s in self.states:
                for energy, after in self.moves[s]:
                    if energy + value[after] > value[s]:
                        value[s], best[s], improved = energy + value[after], after, True
            if not improved:
                return value, None
            loop = self._loop(best)
            if loop:
                return None, loop
        raise AssertionError("more rounds than states, and no cycle")

    def _loop(self, best):
        seen = {}
        for start in best:
            s = start
            while s in best and s not in seen:
                seen[s] = start
                s = best[s]
            if s in best and seen[s] == start:
                loop = [s]
                while best[loop[-1]] != s:
                    loop.append(best[loop[-1]])
                return loop
        return None


def exact_gain(law, losses, positions, cells):
    """Energy that one round of a cycle takes out, in rational arithmetic [J].

    positions in counts, each with the cell it is read as; the last moves on to the first.
    Where the force changes within an interval, the hand is then where it is best, of 2000 places.
    """
    size, total = len(positions), Fraction(0)
    used = law.memory + 1
    for k in range(size):
        forces = [
            exact_force(law, [cells[(k - age - i) % size] for i in range(used)], losses.resolution)
            for age in (losses.delay, losses.delay - 1)
        ]
        start, end = positions[k], positions[(k + 1) % size]
        if losses.part == 1:
            total += _taken(losses, forces[0], end - start, 1)
        else:
            total += max(
                _taken(losses, forces[0], m - start, losses.part)
                + _taken(losses, forces[1], end - m, 1 - losses.part)
                for m in (Fraction(n, 200) + min(start, end) - 5 for n in range(2000))
            )
    return total


def _taken(losses, force, counts, part):
    d = counts * losses.resolution
    drag = losses.damping / (part * losses.period)
    return -force * d - losses.coulomb_friction * abs(d) - drag * d**2
