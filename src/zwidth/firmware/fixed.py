"""A program on whole numbers, and by how much each of its statements rounds; see `units`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import ceil, floor

from zwidth.firmware.bound import Bound
from zwidth.firmware.evaluation import NoBound, Rounded
from zwidth.firmware.program import (
    Branch,
    Cells,
    Constant,
    Kind,
    Load,
    Operand,
    Operation,
    Program,
    Set,
    Statement,
    Store,
    Variable,
)
from zwidth.firmware.units import SAME, Scale, Unit, Units, units_of

_ROOM = 1.01
"""What the error may add to a number, relative; `invariant` tells afterwards whether it did not add more."""


class TooLarge(Exception):
    """A number leaves its word."""


@dataclass(eq=False)
class Fixed:
    """A program in whole numbers: an `evaluation.Arithmetic` of the real one.

    Parameters
    ----------
    program
        The same statements on whole numbers.
    units
        Of what the real one has.
    constants, roundings
        By statement of the real one: how far its known numbers are off, and its result is rounded.
    most
        The size of each result for which it was written.
    narrow
        The whole numbers that 16 bits hold.
    result
        The unit of what it gives back.
    to_zero
        Products that may be rounded to 0.
    """

    program: Program
    units: Units
    constants: dict[Statement, float]
    roundings: dict[Statement, float]
    most: dict[Variable, float]
    narrow: frozenset[Variable]
    result: Unit
    to_zero: frozenset[Statement] = frozenset()

    def constant(self, value: float, statement: Statement | None) -> float:
        """Its rounding to whole units, and that of the double that it comes from."""
        more = self.constants.get(statement, 0.0) if statement is not None else 0.0
        return more + SAME * abs(value)  # what differs by less than that from a unit is taken for it

    def rounding(self, statement: Rounded, of: tuple[Bound, ...], result: Bound) -> float:
        """As it was collected."""
        return self.roundings.get(statement, 0.0)

    def keeps_sign(self, statement: Rounded) -> bool:
        """Of products with whole numbers."""
        is_product = isinstance(statement, Operation) and statement.operator == "*"
        return is_product and statement not in self.to_zero


def lowered(program: Program, scale: Scale, sizes: Mapping[Variable, Bound], cells: list[float]) -> Fixed:
    """A program in whole numbers.

    Parameters
    ----------
    program
        In real numbers.
    scale
        Its units.
    sizes
        Of every result, how large it is.
    cells
        How large what it remembers is.

    Raises
    ------
    NoBound
        If an operation has no fixed-point form here.
    TooLarge
        If a number leaves its word.
    """
    return _Lowering(units_of(program, scale), sizes, cells).whole(program)


@dataclass
class _Lowering:
    units: Units
    sizes: Mapping[Variable, Bound]
    cells: list[float]
    names: dict[Variable, Variable] = field(default_factory=dict)
    constants: dict[Statement, float] = field(default_factory=dict)
    roundings: dict[Statement, float] = field(default_factory=dict)
    most: dict[Variable, float] = field(default_factory=dict)
    count: dict[Variable, int] = field(default_factory=dict)
    to_zero: set[Statement] = field(default_factory=set)

    @property
    def scale(self) -> Scale:
        return self.units.scale

    def whole(self, program: Program) -> Fixed:
        """The whole program."""
        for p in program.parameters:
            self.names[p] = p
        body: list[Statement] = []
        self.block(program.body, body)
        (result,) = program.results
        if isinstance(result, Constant):
            raise NoBound("its force is the same everywhere")
        out = self.read(result, self.unit(result), None, body)
        made = Program(program.parameters, program.cells, body, (out,))
        narrow = frozenset(self.names[v] for v, n in self.count.items() if n <= _NARROW and v in self.names)
        return Fixed(
            made,
            self.units,
            self.constants,
            self.roundings,
            self.most,
            narrow,
            self.unit(result),
            frozenset(self.to_zero),
        )

    def unit(self, operand: Operand) -> Unit:
        """The unit of an operand; of a known number, and where nothing tells, that of a force."""
        return self.units.of(operand) or self.scale.force

    def block(self, todo: list[Statement], out: list[Statement]) -> None:
        for s in todo:
            if isinstance(s, Operation):
                self.operation(s, out)
            elif isinstance(s, Load):
                self.load(s, out)
            elif isinstance(s, Store):
                place = int(s.index.value) if isinstance(s.index, Constant) else 0
                unit = self.units.cells.get(place, self.scale.force)
                self.fits(self.cells[place], unit)
                out.append(Store(s.target, s.index, self.read(s.value, unit, s, out)))
            elif isinstance(s, Set):
                self.set(s, out)
            elif isinstance(s, Branch):
                made = Branch(self.truth(s.test))
                self.block(s.then, made.then)
                self.block(s.other, made.other)
                out.append(made)
            else:
                raise NoBound("it runs through a loop whose passes depend on what is measured")

    # ---- numbers

    def named(self, variable: Variable, kind: Kind = "integer") -> Variable:
        """The whole number that stands for a real one."""
        if variable not in self.names:
            self.names[variable] = Variable(kind, variable.hint, variable.changes)
        return self.names[variable]

    def fits(self, size: float, unit: Unit) -> int:
        """The largest whole number that a real one of a size can be."""
        n = ceil(_ROOM * size / self.scale.size(unit)) + 16
        if n > self.scale.largest:
            raise TooLarge
        return n

    def largest(self, variable: Variable) -> int:
        """The same of a result."""
        size = self.sizes[variable].computed_size if variable in self.sizes else 0.0
        unit = self.unit(variable)
        n = self.fits(size, unit)
        self.most[variable] = n * self.scale.size(unit)
        self.count[variable] = n
        return n

    def known(self, number: float, unit: Unit, statement: Statement | None) -> Constant:
        """A known number in whole units; its error is noted."""
        size = self.scale.size(unit)
        n = round(number / size)
        if abs(n) > self.scale.largest:
            raise TooLarge
        self.off(self.constants, statement, abs(number - n * size))
        return Constant(n, "integer")

    def off(self, held: dict[Statement, float], statement: Statement | None, error: float) -> None:
        if statement is not None and error > 0.0:
            held[statement] = held.get(statement, 0.0) + error

    def read(self, operand: Operand, unit: Unit, s: Statement | None, out: list[Statement]) -> Operand:
        """An operand in a unit."""
        if isinstance(operand, Constant):
            if operand.kind == "truth":
                return operand
            return self.known(float(operand.value), unit, s)
        own, n = self.unit(operand), self.largest(operand)
        value: Operand = self.names[operand]
        if own == unit:
            return value
        if (own.counts, own.steps) == (unit.counts, unit.steps):
            return self.shifted(value, n, own.fraction - unit.fraction, unit, s, out)
        return self.product(value, n, self.scale.size(own), unit, s, out)

    def shifted(
        self, value: Operand, n: int, by: int, unit: Unit, s: Statement | None, out: list[Statement]
    ) -> Operand:
        """To a finer unit, or to the nearest of a coarser one."""
        if by < 0:
            if n << -by > self.scale.largest:
                raise TooLarge
            return self.made("<<", (value, Constant(-by, "integer")), out)
        half = 1 << (by - 1)
        if n + half > self.scale.largest:
            raise TooLarge
        self.off(self.roundings, s, 0.5 * self.scale.size(unit))
        sum_ = self.made("+", (value, Constant(half, "integer")), out)
        return self.made(">>", (sum_, Constant(by, "integer")), out)

    def product(
        self, value: Operand, n: int, factor: float, unit: Unit, s: Statement | None, out: list[Statement]
    ) -> Operand:
        """A whole number times a real one, in a unit: by a whole number, or by a fraction and a shift."""
        size = self.scale.size(unit)
        ratio = factor / size
        m = round(ratio)
        if abs(ratio) >= _PRECISE or abs(ratio - m) <= 1e-12 * abs(ratio):
            if abs(m) * n > self.scale.largest:
                raise TooLarge
            self.off(self.roundings, s, abs(factor - m * size) * n)
            return self.made("product", (value, Constant(m, "integer")), out)
        # the product is kept in 64 bits, with the half that rounds it
        shift = min(self.scale.word - 2, 62 - n.bit_length()) - ceil(abs(ratio)).bit_length()
        shift = next((k for k in _BYTES if k < shift and n <= 2**k), shift)
        m = round(ratio * 2.0**shift)
        if abs(ratio) * n + 1 > self.scale.largest or shift < 1:
            raise TooLarge
        error = abs(factor - m * 2.0**-shift * size) * n + 0.5 * size
        self.off(self.roundings, s, error)
        if s is not None:
            self.to_zero.add(s)
        return self.made("scaled", (value, Constant(m, "integer"), Constant(shift, "integer")), out)

    def made(self, operator: str, operands: tuple[Operand, ...], out: list[Statement]) -> Variable:
        result = Variable("integer")
        out.append(Operation(result, operator, operands))
        return result

    # ---- statements

    def load(self, s: Load, out: list[Statement]) -> None:
        if not isinstance(s.source, Cells):
            raise NoBound("it looks up a table, which is written in floating point only")
        place = int(s.index.value) if isinstance(s.index, Constant) else 0
        unit = self.units.cells.get(place, self.scale.force)
        self.fits(self.cells[place], unit)
        self.largest(s.result)
        out.append(Load(self.named(s.result), s.source, s.index))

    def set(self, s: Set, out: list[Statement]) -> None:
        if s.variable.kind == "truth":
            out.append(Set(self.named(s.variable, "truth"), self.truth(s.value)))
            return
        value = self.read(s.value, self.unit(s.variable), s, out)
        out.append(Set(self.named(s.variable), value))

    def truth(self, operand: Operand) -> Operand:
        return operand if isinstance(operand, Constant) else self.named(operand, "truth")

    def operation(self, s: Operation, out: list[Statement]) -> None:
        if s.result.kind == "truth":
            self.test(s, out)
            return
        self.largest(s.result)
        unit = self.unit(s.result)
        a, b = s.operands[0], s.operands[-1]
        if s.operator in ("*", "/"):
            value = self.times(s, unit, out)
        elif s.operator == "floor":
            value = self.down(a, out)
        else:
            one = self.read(a, unit, s, out)
            if s.operator in ("real", "integer", "copy"):
                value = one
            else:
                of = (one, self.read(b, unit, s, out)) if len(s.operands) == 2 else (one,)
                value = self.made(s.operator, of, out)
        if isinstance(value, Variable) and value.kind == "integer" and value not in self.names.values():
            value.hint = s.result.hint
            self.names[s.result] = value
        else:
            out.append(Operation(self.named(s.result), "copy", (value,)))

    def times(self, s: Operation, unit: Unit, out: list[Statement]) -> Operand:
        """A product with a known number."""
        a, b = s.operands
        x, c = (a, b) if isinstance(b, Constant) else (b, a)
        assert isinstance(c, Constant), "units_of has refused the rest"
        assert isinstance(x, Variable), "what is known twice is computed before"
        by = 1.0 / float(c.value) if s.operator == "/" else float(c.value)
        own, n = self.unit(x), self.largest(x)
        named = self.names[x]
        if by == 0.0:
            return Constant(0, "integer")
        if abs(abs(by) * self.scale.size(own) / self.scale.size(unit) - 1.0) <= SAME:
            return named if by > 0 else self.made("negate", (named,), out)
        return self.product(named, n, by * self.scale.size(own), unit, s, out)

    def down(self, a: Operand, out: list[Statement]) -> Operand:
        """The floor of a number without a unit."""
        unit = self.unit(a)
        if (unit.counts, unit.steps) != (0, 0) or not isinstance(a, Variable):
            raise NoBound("it rounds a number that has a unit")
        self.largest(a)
        if unit.fraction <= 0:
            return self.names[a]
        return self.made(">>", (self.names[a], Constant(unit.fraction, "integer")), out)

    def test(self, s: Operation, out: list[Statement]) -> None:
        """A comparison; with a known number the whole number that decides alike."""
        result = self.named(s.result, "truth")
        if s.operator in ("and", "or", "not", "copy"):
            out.append(Operation(result, s.operator, tuple(self.truth(o) for o in s.operands)))
            return
        a, b = s.operands
        operator = s.operator
        if isinstance(a, Constant):
            a, b, operator = b, a, _MIRRORED[operator]
        if isinstance(b, Constant):
            unit = self.unit(a)
            level = float(b.value) / self.scale.size(unit)
            assert isinstance(a, Variable), "what is known twice is computed before"
            self.largest(a)
            near = round(level)
            if abs(level - near) > 1e-9 * max(abs(level), 1.0):
                if operator in ("==", "!="):
                    raise NoBound("it compares with a number that no reading can be")
                operator, near = ("<=", floor(level)) if operator in ("<", "<=") else (">=", ceil(level))
            else:
                self.off(self.constants, s, abs(level - near) * self.scale.size(unit))
            near = max(min(near, self.scale.largest), -self.scale.largest)
            out.append(Operation(result, operator, (self.names[a], Constant(near, "integer"))))
            return
        unit = self.units.together(a, b) or self.scale.force
        of = (self.read(a, unit, s, out), self.read(b, unit, s, out))
        out.append(Operation(result, operator, of))


_MIRRORED = {"<": ">", ">": "<", "<=": ">=", ">=": "<=", "==": "==", "!=": "!="}
_NARROW = 2**15 - 1
_BYTES = (16, 24, 32)
"""Shifts a small chip does by whole bytes; where n ≤ 2^k the factor's rounding is half a unit or less."""
_PRECISE = 2.0**12
"""A factor from here on is as good as its whole number: off by one part in 8000, or less."""
