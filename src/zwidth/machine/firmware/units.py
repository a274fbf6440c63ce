"""Fixed point: every number is a whole number of units, and no sum or product leaves its word.

    position    n Δ                 counts, exact
    force       n U 2⁻ᵍ             U the converter's step, or a unit that is chosen; g the same for all
    product     c n Δ  →  n m,      m = round(c Δ/(U 2⁻ᵍ)): exact but for the rounding of m

g is the largest with which nothing leaves its word.  So sums need no shift, and the converter's
nearest step is one shift by g.  What is rounded is collected statement by statement, for `invariant`.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import log2
from typing import Any

from zwidth.machine.firmware.evaluation import NoBound
from zwidth.machine.firmware.program import (
    Constant,
    Load,
    Operand,
    Operation,
    Program,
    Store,
    Table,
    Variable,
    factor,
)

_FINE = 6
"""Parts of a count, as a power of two, in which a place between two counts is kept."""

SAME = 1e-12
"""Relative: two units, or a number and a whole one, that differ by less are the same but for rounding."""


_MEANT = ((0, 0), (1, 0), (0, 1))
"""Powers of a count and of a step that a number of a law has: none, a position, a force."""


@dataclass(frozen=True)
class Unit:
    """Δ^counts U^steps 2^−fraction."""

    counts: int
    steps: int
    fraction: int


@dataclass(frozen=True)
class Scale:
    """What the units of a law are: Δ [m; rad], U [N; N·m], g, and the bits of a number, 32 or 64."""

    count: float
    step: float
    fraction: int
    word: int = 32

    @property
    def force(self) -> Unit:
        """U 2⁻ᵍ."""
        return Unit(0, 1, self.fraction)

    @property
    def largest(self) -> int:
        """The largest whole number of a word."""
        return (1 << (self.word - 1)) - 1

    def size(self, unit: Unit) -> float:
        """A unit in SI."""
        return float(self.count**unit.counts * self.step**unit.steps * 2.0**-unit.fraction)

    def as_unit(self, number: float) -> Unit | None:
        """The unit that a number is, if it is one."""
        for counts in (0, 1, -1):
            for steps in (0, 1, -1):
                power = log2(number / (self.count**counts * self.step**steps))
                if abs(power - round(power)) < SAME and abs(power) < 64:
                    return Unit(counts, steps, -round(power))
        return None


@dataclass
class Units:
    """The unit of every result and place of the memory; what none can be told of is kept as a force."""

    scale: Scale
    values: dict[Variable, Unit] = field(default_factory=dict)
    cells: dict[int, Unit] = field(default_factory=dict)

    def of(self, operand: Operand) -> Unit | None:
        """The unit of an operand; None of a known number, and where it is not found yet."""
        return self.values.get(operand) if isinstance(operand, Variable) else None

    def whole(self, number: float, unit: Unit) -> bool:
        """Whether a number is a whole number of units."""
        n = number / self.scale.size(unit)
        return abs(n - round(n)) <= SAME * max(abs(n), 1.0)

    def fine_enough(self, number: float, unit: Unit) -> Unit:
        """A unit of which a known number is a whole multiple, or nearly."""
        if self.whole(number, unit):
            return unit
        if (unit.counts, unit.steps) == (1, 0):
            return Unit(1, 0, max(unit.fraction, _FINE))
        return self.scale.force

    def common(self, a: Unit, b: Unit) -> Unit:
        """A unit for both."""
        if (a.counts, a.steps) == (b.counts, b.steps):
            return a if a.fraction >= b.fraction else b
        return self.scale.force

    def together(self, a: Operand, b: Operand) -> Unit | None:
        """A unit in which two operands can be added."""
        one, two = self.of(a), self.of(b)
        if one is not None and two is not None:
            return self.common(one, two)
        for unit, other in ((one, b), (two, a)):
            if unit is not None and isinstance(other, Constant):
                return self.fine_enough(float(other.value), unit)
            if unit is not None:
                return unit  # the other is not found yet
        return None

    def scaled(self, unit: Unit, by: float) -> Unit:
        """The unit of a product with a known number."""
        own = self.scale.as_unit(abs(by)) if by else None
        if own is None:
            return self.scale.force
        made = Unit(unit.counts + own.counts, unit.steps + own.steps, unit.fraction + own.fraction)
        # 200 N/m is 2/U where U is 0.01 N, by chance: no position per force is meant
        return made if (made.counts, made.steps) in _MEANT else self.scale.force


def units_of(program: Program, scale: Scale) -> Units:
    """The units of a program."""
    units = Units(scale, {p: Unit(0, 0, 0) for p in program.parameters})
    while True:
        before = (dict(units.values), dict(units.cells))
        for s in program.statements():
            if isinstance(s, Operation) and s.result.kind != "truth":
                _keep(units, units.values, s.result, _operation(s, units))
            elif isinstance(s, Load):
                known = scale.force if isinstance(s.source, Table) else units.cells.get(_index(s.index))
                _keep(units, units.values, s.result, known)
            elif isinstance(s, Store):
                _keep(units, units.cells, _index(s.index), units.of(s.value))
        if before != (units.values, units.cells):
            continue
        unknown = [
            s.result for s in program.statements() if isinstance(s, Load) and s.result not in units.values
        ]
        if not unknown:
            return units
        units.values.update(dict.fromkeys(unknown, scale.force))


def _keep(units: Units, held: dict[Any, Unit], key: Any, unit: Unit | None) -> None:
    if unit is not None:
        held[key] = units.common(held[key], unit) if key in held else unit


def _index(index: Operand) -> int:
    if isinstance(index, Variable):
        raise NoBound("which of the numbers that it remembers it takes depends on what is measured")
    return int(index.value)


def _operation(s: Operation, units: Units) -> Unit | None:
    a, b = s.operands[0], s.operands[-1]
    if s.operator in ("real", "integer", "copy", "negate", "abs"):
        return units.of(a)
    if s.operator in ("+", "-", "min", "max"):
        return units.together(a, b)
    if s.operator in ("*", "/"):
        found = factor(s)
        if found is None:
            both = "it multiplies or divides two numbers that are both measured or remembered"
            what = "it divides by 0" if isinstance(b, Constant) else both
            raise NoBound(f"{what}, which is written in floating point only")
        unit = units.of(found[0])
        return None if unit is None else units.scaled(unit, found[1])
    if s.operator == "floor":
        return Unit(0, 0, 0)
    raise NoBound(f"{s.operator!r} is written in floating point only")
