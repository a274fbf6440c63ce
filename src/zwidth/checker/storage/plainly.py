"""The slow twin of the checks of storage functions: standard library alone, one state and one move at a time.

No move of the hand takes out more energy than V falls:

    V(s, x) ≥ −f (x' − x) − c(|x' − x|) + V(s', x')

at all nodes x, x', with the cost c of the lemma that extends it to all positions between.  Positions are
counted in steps (of a line: in cells), energies in units of force times one step.  Forces are those of the
law itself, in rationals: nothing is rounded, and nothing is allowed for.  So a storage function that the fast
checks accept, with what they allow for their rounding, is accepted here as well.

Boards of at most `MOST_MOVES` moves are checked.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from fractions import Fraction
from importlib import import_module
from itertools import pairwise, product
from math import ceil, isfinite
from typing import Any, NamedTuple

from ..contact.law import Law, Losses, law_of, losses_of
from ..document.fields import Read
from ..document.refusal import Invalid, only_if, spend
from . import coarse, row
from .coarse import coarse_storage
from .domain import DOUBLE, listed, proved
from .grid import storage
from .row import storage_of_row

MOST_MOVES = 500_000
Energies = Mapping[int, Any]
"""By position."""


def storage_plainly(told: Read) -> str:
    """Of a grid of counts; says what was proved."""
    losses, law = losses_of(told.loop), law_of(told.law)
    counts = _counts(told, losses, law)
    costs = [
        _costs_of_models(losses, losses.resolution / counts.steps, told.force_unit, part, far)
        for part, far in _parts(losses, told.domain.largest_move_counts * counts.steps)
    ]
    for readings in counts.chain.states():
        acting = readings[losses.delay] * losses.resolution
        for average in counts.averages(acting):
            here = counts.stored(readings, average)
            goal = counts.goal(readings, law.averaged(average, acting))
            forces = [f / told.force_unit for f in counts.forces(readings, average)]
            _require_paid(here, _before(goal, forces, costs), forces[0], costs[0], readings)
    return proved(told.domain, losses, law)


def coarse_storage_plainly(told: Read) -> str:
    """Of a line of cells of any length; says what was proved."""
    losses, law = losses_of(told.loop), law_of(told.law)
    line = _line(told, losses, law)
    costs = [
        [_costs_on_line(losses, law, line.length, told.force_unit, part, far)]
        for part, far in _parts(losses, told.domain.largest_move_cells)
    ]
    for corners in line.chain.states():
        here = {line.places[corners[0]]: line.value[line.chain.place(corners)]}
        forces = [f / told.force_unit for f in line.forces(corners)]
        goal = _before(line.goal(corners), forces, costs)
        _require_paid(here, goal, forces[0], costs[0], corners)
    return coarse.proved(told, losses)


def row_storage_plainly(told: Read) -> str:
    """Of a table of states; says what was proved."""
    losses, domain, table = losses_of(told.loop), told.domain, told.table
    if losses.part < 1:
        raise Invalid("laws in a chain are checked for delays of whole samples")
    reach, steps = ceil(domain.largest_move_counts), domain.steps_per_count
    _require_few(table.states * (steps + 1), (2 * reach + 1) * (steps + 1) * len(losses.models))
    value = _stored(told.storage, table.states * (steps + 1))
    counts, successors = _closed(table, domain, reach)
    if max(table.starts) >= table.states or len(table.starts) > table.states:
        raise Invalid("the hand begins in a state that is not in the table")
    step, far = losses.resolution / steps, ceil(domain.largest_move_counts * steps)
    costs = _costs_of_models(losses, step, told.force_unit, Fraction(1), far)
    for state, force in enumerate(listed(table.forces, table.states, DOUBLE)):
        if not isfinite(force):
            raise Invalid("a force is no number")
        here = dict(enumerate(value[state * (steps + 1) : (state + 1) * (steps + 1)]))
        goal: dict[int, Any] = {}
        for move, then in enumerate(successors[state], start=-reach):
            if then >= 0:
                _raise(goal, move * steps, value[then * (steps + 1) : (then + 1) * (steps + 1)])
        _require_paid(here, goal, Fraction(force) / told.force_unit, costs, (counts[state],))
    return row.proved(domain, table.states)


# --- the theorem ------------------------------------------------------------------------------


def _require_paid(
    here: Energies, goal: Energies, force: Any, models: Sequence[Sequence[Any]], state: Sequence[int]
) -> None:
    """Every move from here costs at least what it brings.

    Of several models of friction each holds at every speed.  On a square of two steps, cut where |d| is
    constant, one of them must do at all corners of a triangle; other triangles may have another.
    """
    far = len(models[0])
    _spend(len(here) * len(goal), [force, *(cost[-1] for cost in models)])
    pays = {
        (x, p): [there - v <= force * (p - x) + cost[abs(p - x)] for cost in models]
        for (x, v), (p, there) in product(here.items(), goal.items())
        if abs(p - x) < far
    }
    for (x, p), ways in pays.items():
        if not any(ways):
            raise _too_much(state, x)
        if len(models) > 1 and (x + 1, p + 1) in pays:
            for third in ((x, p + 1), (x + 1, p)):
                corners = zip(ways, pays[x + 1, p + 1], pays.get(third, ()), strict=False)
                if third in pays and not any(map(all, corners)):
                    raise _too_much(state, x)


def _too_much(state: Sequence[int], x: int) -> Invalid:
    read = ", ".join(map(str, state))
    return Invalid(f"at {x}, with the readings {read}, a move takes out more energy than was stored")


def _before(goal: Energies, forces: Sequence[Any], costs: Sequence[Sequence[Sequence[Any]]]) -> Energies:
    """The most that the later parts of an interval can lead to, the hand anywhere at their beginning."""
    for force, (cost,) in zip(forces[:0:-1], costs[:0:-1], strict=True):
        _spend(len(goal) ** 2, [force, cost[-1]])
        goal = {
            m: max(
                there - force * (p - m) - cost[abs(p - m)]
                for p, there in goal.items()
                if abs(p - m) < len(cost)
            )
            for m in goal
        }
    return goal


def _costs_of_models(
    losses: Losses, step: Fraction, unit: Fraction, part: Fraction, far: int
) -> list[list[Fraction]]:
    """By model, what a move over 0, 1, … steps costs at least."""
    return [
        _costs(friction / unit, damping * step / (part * losses.period * unit), Fraction(0), far)
        for friction, damping in losses.models
    ]


def _costs_on_line(
    losses: Losses, law: Law, cell: Fraction, unit: Fraction, part: Fraction, far: int
) -> list[Fraction]:
    """Friction covers half a count of every tap, and the force bends by κ from corner to corner."""
    ((friction, damping),) = losses.models
    friction -= sum(map(abs, law.taps), Fraction(0)) * losses.resolution / 2
    bend = max(sum((max(sign * c, Fraction(0)) for c in law.taps), Fraction(0)) for sign in (1, -1))
    return _costs(friction / unit, damping * cell / (part * losses.period * unit), bend * cell / unit, far)


def _costs(friction: Fraction, drag: Fraction, bend: Fraction, far: int) -> list[Fraction]:
    """φ D + L(D) with L(0) = 0, L(1) = −κ, L(D) = β D² − (β + κ)/4; κ = 0 where a cell has one force."""
    curved = [Fraction(0), -bend, *(drag * d * d - (drag + bend) / 4 for d in range(2, far + 1))]
    return [friction * d + curved[d] for d in range(far + 1)]


def _parts(losses: Losses, max_move: Fraction) -> list[tuple[Fraction, int]]:
    """The parts of an interval with one force each, and the farthest whole distance of a move in each."""
    parts = (losses.part, 1 - losses.part)
    return [(part, ceil(max_move * part)) for part in parts if part > 0]


def _raise(goal: dict[int, Any], first: int, values: Sequence[Any]) -> None:
    """More places to go to; at the edge of two cells there are two, and the better one counts."""
    for place, value in enumerate(values, start=first):
        goal[place] = max(value, goal.get(place, value))


# --- states -----------------------------------------------------------------------------------


class _Chain(NamedTuple):
    """Readings one after the other, the newest first: each from low to high, and near the one before."""

    low: int
    high: int
    reach: int
    memory: int

    @property
    def size(self) -> int:
        """Places of V, those of histories that leave the grid among them."""
        width: int = (2 * self.reach + 1) ** self.memory
        return (self.high - self.low + 1) * width

    def near(self, reading: int) -> range:
        """What may be read a sample before or after."""
        return range(max(self.low, reading - self.reach), min(self.high, reading + self.reach) + 1)

    def states(self) -> list[tuple[int, ...]]:
        """All readings that are remembered, on the grid."""
        found: list[tuple[int, ...]] = [(reading,) for reading in range(self.low, self.high + 1)]
        for _ in range(self.memory):
            found = [(*readings, older) for readings in found for older in self.near(readings[-1])]
        return found

    def after(self, readings: Sequence[int]) -> Iterator[tuple[int, ...]]:
        """The states that may follow."""
        for reading in self.near(readings[0]):
            yield (reading, *readings)[: self.memory + 1]

    def place(self, readings: Sequence[int]) -> int:
        """The place of a state in V: by reading, then by the differences of those remembered."""
        place = readings[0] - self.low
        for newer, older in pairwise(readings):
            place = place * (2 * self.reach + 1) + older - newer + self.reach
        return place


class _Counts(NamedTuple):
    """A grid of counts in steps; V at levels of the average `least`, `least` + 1/`per_count`, … [counts]."""

    law: Law
    losses: Losses
    chain: _Chain
    steps: int
    least: int
    per_count: int
    levels: int
    value: list[int]

    def averages(self, acting: Fraction) -> list[Fraction]:
        """Between two of these V, what it leads to, and the force are linear in the average [m]."""
        if self.law.relaxing is None:
            return [Fraction(0)]
        cell, (pole, branch) = self.losses.resolution, self.law.relaxing
        levels = [(self.least + Fraction(i, self.per_count)) * cell for i in range(self.levels)]
        fed = self.law.averaged(Fraction(0), acting)  # (1 − p) u, or 0 where it begins anew
        kinks = {(level - fed) / pole for level in levels} if pole else set()
        if self.law.clamped and branch:
            kinks.add((self.law.taps[0] / branch + 1) * acting)  # the force is 0
        return sorted({*levels, *(kink for kink in kinks if levels[0] < kink < levels[-1])})

    def stored(self, readings: Sequence[int], average: Fraction) -> dict[int, Any]:
        """V at the nodes of the cell of the hand."""
        level, between = 0, Fraction(0)
        if self.law.relaxing is not None:
            at = (average / self.losses.resolution - self.least) * self.per_count
            level, between = int(at // 1), at % 1
        if not 0 <= level + between <= self.levels - 1:
            raise Invalid("the average leaves the grid")
        first = (self.chain.place(readings) * self.levels + level) * (self.steps + 1)
        here: list[Any] = self.value[first : first + self.steps + 1]
        if between:
            above = self.value[first + self.steps + 1 : first + 2 * (self.steps + 1)]
            here = [a + between * (b - a) for a, b in zip(here, above, strict=True)]
        return dict(enumerate(here, start=readings[0] * self.steps))

    def goal(self, readings: Sequence[int], average: Fraction) -> dict[int, Any]:
        """The most that is stored where the hand may be a sample later."""
        found: dict[int, Any] = {}
        for then in self.chain.after(readings):
            _raise(found, then[0] * self.steps, list(self.stored(then, average).values()))
        return found

    def forces(self, readings: Sequence[int], average: Fraction) -> Iterator[Fraction]:
        """That of the oldest reading that acts; where it changes within the interval, that of the next."""
        last = self.law.memory + 1
        places = [reading * self.losses.resolution for reading in readings]
        yield self.law.force(places[self.losses.delay :][:last], average)
        if self.losses.part < 1:
            yield self.law.force(places[self.losses.delay - 1 :][:last], average)


def _counts(told: Read, losses: Losses, law: Law) -> _Counts:
    domain = told.domain
    low, high, steps = domain.lowest_count, domain.highest_count, domain.steps_per_count
    chain = _Chain(low, high, ceil(domain.largest_move_counts), law.memory + losses.delay)
    only_if(law.relaxing, domain.levels_per_count, "levels_per_count")
    if high < low:
        raise Invalid("the grid is empty")
    _require_covered(losses, law)
    forgets = law.surface == "penetration" if law.relaxing else law.surface != "none"
    if forgets and low > 1 - (chain.memory + 1) * chain.reach:
        raise Invalid("the grid must reach so far out that a hand beyond it has been forgotten")
    least, per_count, levels = 0, 1, 1
    if law.relaxing is not None:
        least = 0 if law.surface == "penetration" else low
        per_count = domain.levels_per_count
        levels = (max(high, least + 1) - least) * per_count + 1
    nodes = chain.size * levels * (steps + 1)
    goals = (2 * chain.reach + 1) * (steps + 1)
    _require_few(nodes, (2 if law.relaxing else 1) * goals * len(losses.models))
    _require_few(chain.size if losses.part < 1 else 0, goals**2)
    return _Counts(law, losses, chain, steps, least, per_count, levels, _stored(told.storage, nodes))


def _require_covered(losses: Losses, law: Law) -> None:
    if law.relaxing is None:
        return
    if losses.part < 1 or losses.curve:
        raise Invalid("laws that relax are checked for delays of whole samples and one friction model")
    if law.limit is not None:
        raise Invalid("a force limit together with a law that relaxes is not covered")


class _Line(NamedTuple):
    """Ends of cells; at a surface the end at 0 stands there twice, outside and inside."""

    law: Law
    losses: Losses
    chain: _Chain
    length: Fraction
    places: list[int]
    inside: list[bool]
    value: list[int]

    def goal(self, corners: Sequence[int]) -> dict[int, Any]:
        """The most that is stored where the hand may be a sample later."""
        found: dict[int, Any] = {}
        for then in self.chain.after(corners):
            _raise(found, self.places[then[0]], [self.value[self.chain.place(then)]])
        return found

    def forces(self, corners: Sequence[int]) -> Iterator[Fraction]:
        """F of the oldest reading that acts; where it changes within the interval, that of the next."""
        yield self._force(corners[self.losses.delay :])
        if self.losses.part < 1:
            yield self._force(corners[self.losses.delay - 1 :])

    def _force(self, corners: Sequence[int]) -> Fraction:
        if not self.inside[corners[0]]:
            return Fraction(0)
        return sum((c * self._fed(k) for c, k in zip(self.law.taps, corners, strict=False)), Fraction(0))

    def _fed(self, corner: int) -> Fraction:
        """y + Δ/2, the middle of what is read at y; 0 outside if the law is fed with the penetration."""
        if self.law.surface == "penetration" and not self.inside[corner]:
            return Fraction(0)
        return self.places[corner] * self.length + self.losses.resolution / 2


def _line(told: Read, losses: Losses, law: Law) -> _Line:
    domain = told.domain
    low, high, memory = domain.lowest_cell, domain.highest_cell, law.memory + losses.delay
    length = domain.counts_per_cell * losses.resolution
    if law.points or law.clamped or law.relaxing or law.limit is not None or law.step is not None:
        raise Invalid("cells of any length are for laws that are linear inside")
    if losses.curve:
        raise Invalid("cells of any length are for one friction model")
    if domain.remembered != memory:
        raise Invalid("the law remembers another number of readings")
    surface = law.surface != "none"
    if surface and low > -(memory + 1) * domain.largest_move_cells:
        raise Invalid("the grid must reach so far out that a hand beyond it has been forgotten")
    if not surface and low * length + losses.resolution > -high * length:
        raise Invalid("the grid must reach as far on the one side as on the other")
    outside = [*range(low, 1)] if surface else []
    inside = [*range(0 if surface else low, high + 1)]
    places = outside + inside
    chain = _Chain(0, len(places) - 1, ceil(domain.largest_move_cells) + surface, memory)
    goals = 2 * chain.reach + 1
    _require_few(chain.size, goals if losses.part == 1 else goals**2)
    value = _stored(told.storage, chain.size)
    sides = [False] * len(outside) + [True] * len(inside)
    return _Line(law, losses, chain, length, places, sides, value)


def _closed(table: Read, domain: Read, reach: int) -> tuple[list[int], list[list[int]]]:
    """The count of each state, and what follows it: a state for each reading on the grid, and no other."""
    width, on_grid = 2 * reach + 1, range(domain.lowest_count, domain.highest_count + 1)
    counts = listed(table.counts, table.states)
    flat = listed(table.successors, table.states * width)
    if any(count not in on_grid for count in counts):
        raise Invalid("a state of the table is not on the grid")
    successors = [flat[state * width : (state + 1) * width] for state in range(table.states)]
    for count, following in zip(counts, successors, strict=True):
        for reading, then in enumerate(following, start=count - reach):
            if then not in (range(len(counts)) if reading in on_grid else (-1,)):
                raise Invalid("the table is not closed: a reading on the grid leads nowhere")
            if then >= 0 and counts[then] != reading:
                raise Invalid("a reading leads to a state of another reading")
    return counts, successors


def _stored(text: str, count: int) -> list[int]:
    """V, which is nowhere below 0."""
    value = listed(text, count)
    if min(value) < 0:
        raise Invalid("a storage function must be bounded below by 0")
    return value


def _require_few(nodes: int, each: int) -> None:
    """The moves are counted before any is tried."""
    if nodes * each > MOST_MOVES:
        raise Invalid(f"the grid has {nodes * each} moves: without numpy at most {MOST_MOVES} can be checked")


def _spend(moves: int, numbers: Sequence[Fraction]) -> None:
    """Before so many moves with numbers like these."""
    spend(10 * moves, max(n.numerator.bit_length() + n.denominator.bit_length() for n in numbers))


# Which check of a storage function is made: the fast one, or its slow twin where it cannot be.


Check = Callable[[Read], str]
PLAINLY: dict[str, Check] = {
    "storage": storage_plainly,
    "coarse storage": coarse_storage_plainly,
    "row storage": row_storage_plainly,
}
"""With the standard library alone."""
FAST: dict[str, Check] = {"storage": storage, "coarse storage": coarse_storage, "row storage": storage_of_row}


def checked(told: Read) -> str:
    """Say what was proved."""
    return (FAST if _is_fast() else PLAINLY)[told.kind](told)


def _is_fast() -> bool:
    """True where what the fast checks need can be imported."""
    try:
        import_module("numpy")
    except ImportError:
        return False
    return True
