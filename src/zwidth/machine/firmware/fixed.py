"""A program on whole numbers, and by how much each of its statements rounds; see `units`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import ceil, floor

from zwidth.machine.firmware.bound import Bound
from zwidth.machine.firmware.evaluation import UNBOUNDED, NoBound, Rounded
from zwidth.machine.firmware.program import (
    Branch,
    Cells,
    Constant,
    Kind,
    Load,
    Operand,
    Operation,
    Program,
    Statement,
    Store,
    Variable,
    factor,
    rewritten,
)
from zwidth.machine.firmware.units import SAME, Scale, Unit, Units, units_of
from zwidth.native.names import by_kind

_ROOM = 1.01
"""What the error may add to a number, relative; `invariant` tells afterwards whether it did not add more."""


class TooLarge(Exception):
    """A number leaves its word."""


@dataclass(eq=False)
class Fixed:
    """A program in whole numbers: an `evaluation.Arithmetic` of the real one.

    By statement of the real one `constants` tells how far its known numbers are off, and `roundings` how far
    its result is rounded; `most` is the size of each result for which it was written.  16 bits hold what is
    `narrow`; products `to_zero` may be rounded to 0; `result` is the unit of what it gives back.
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
    """A program of real numbers in whole ones, for results and remembered numbers of these sizes."""
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
    now: Statement | None = None
    """The real statement that is written in whole numbers, and what it has become so far."""
    out: list[Statement] = field(default_factory=list)

    @property
    def scale(self) -> Scale:
        return self.units.scale

    def whole(self, program: Program) -> Fixed:
        """The whole program."""
        for p in program.parameters:
            self.names[p] = p
        body = rewritten(program.body, self.rule)
        (result,) = program.results
        if isinstance(result, Constant):
            raise NoBound("its force is the same everywhere")
        if self.largest(result) > _FORCE:
            raise TooLarge
        self.now, self.out = None, []
        unit = self.unit(result)
        given = self.read(result, unit)
        made = Program(program.parameters, program.cells, [*body, *self.out], (given,))
        narrow = frozenset(self.names[v] for v, n in self.count.items() if n <= _NARROW and v in self.names)
        zero = frozenset(self.to_zero)
        return Fixed(made, self.units, self.constants, self.roundings, self.most, narrow, unit, zero)

    def rule(self, s: Statement) -> list[Statement]:
        """A statement in whole numbers."""
        lower = by_kind(self, s)
        if lower is None:
            raise NoBound(UNBOUNDED)
        self.now, self.out = s, []
        lower(s)
        return self.out

    # ---- numbers

    def unit(self, operand: Operand) -> Unit:
        """The unit of an operand; of a known number, and where nothing tells, that of a force."""
        return self.units.of(operand) or self.scale.force

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

    def off(self, held: dict[Statement, float], error: float) -> None:
        """Note an error of the statement that is written."""
        if self.now is not None and error > 0.0:
            held[self.now] = held.get(self.now, 0.0) + error

    def read(self, operand: Operand, unit: Unit) -> Operand:
        """An operand in a unit."""
        if isinstance(operand, Constant):
            return operand if operand.kind == "truth" else self.known(float(operand.value), unit)
        own, n = self.unit(operand), self.largest(operand)
        value: Operand = self.names[operand]
        if own == unit:
            return value
        if (own.counts, own.steps) == (unit.counts, unit.steps):
            return self.shifted(value, n, own.fraction - unit.fraction, unit)
        return self.product(value, n, self.scale.size(own), unit)

    def known(self, number: float, unit: Unit) -> Constant:
        """A known number in whole units."""
        size = self.scale.size(unit)
        n = round(number / size)
        if abs(n) > self.scale.largest:
            raise TooLarge
        self.off(self.constants, abs(number - n * size))
        return Constant(n, "integer")

    def shifted(self, value: Operand, n: int, by: int, unit: Unit) -> Operand:
        """To a finer unit, or to the nearest of a coarser one."""
        if by < 0:
            if n << -by > self.scale.largest:
                raise TooLarge
            return self.made("<<", value, -by)
        half = 1 << (by - 1)
        if n + half > self.scale.largest:
            raise TooLarge
        self.off(self.roundings, 0.5 * self.scale.size(unit))
        return self.made(">>", self.made("+", value, half), by)

    def product(self, value: Operand, n: int, factor: float, unit: Unit) -> Operand:
        """A whole number times a real one, in a unit: by a whole number, or by a fraction and a shift."""
        size = self.scale.size(unit)
        ratio = factor / size
        m = round(ratio)
        if abs(ratio) >= _PRECISE or abs(ratio - m) <= 1e-12 * abs(ratio):
            if abs(m) * n > self.scale.largest:
                raise TooLarge
            self.off(self.roundings, abs(factor - m * size) * n)
            return self.made("product", value, m)
        # the product is kept in 64 bits, with the half that rounds it
        shift = min(self.scale.word - 2, 62 - n.bit_length()) - ceil(abs(ratio)).bit_length()
        shift = next((k for k in _BYTES if k < shift and n <= 2**k), shift)
        m = round(ratio * 2.0**shift)
        if abs(ratio) * n + 1 > self.scale.largest or shift < 1:
            raise TooLarge
        self.off(self.roundings, abs(factor - m * 2.0**-shift * size) * n + 0.5 * size)
        if self.now is not None:
            self.to_zero.add(self.now)
        return self.made("scaled", value, m, shift)

    def made(self, operator: str, *operands: Operand | int) -> Variable:
        """The result of an operation; whole numbers are written out."""
        result = Variable("integer")
        of = tuple(Constant(o, "integer") if isinstance(o, int) else o for o in operands)
        self.out.append(Operation(result, operator, of))
        return result

    # ---- statements

    def cell(self, index: Operand) -> Unit:
        """The unit of a place of the memory, which must hold what is remembered there."""
        place = int(index.value) if isinstance(index, Constant) else 0
        unit = self.units.cells.get(place, self.scale.force)
        self.fits(self.cells[place], unit)
        return unit

    def _load(self, s: Load) -> None:
        if not isinstance(s.source, Cells):
            raise NoBound("it looks up a table, which is written in floating point only")
        self.cell(s.index)
        self.largest(s.result)
        self.out.append(Load(self.named(s.result), s.source, s.index))

    def _store(self, s: Store) -> None:
        value = self.read(s.value, self.cell(s.index))
        self.out.append(Store(s.target, s.index, value))

    def _branch(self, s: Branch) -> None:
        self.out.append(Branch(self.truth(s.test), s.then, s.other))

    def truth(self, operand: Operand) -> Operand:
        return operand if isinstance(operand, Constant) else self.named(operand, "truth")

    def _operation(self, s: Operation) -> None:
        if s.result.kind == "truth":
            self.test(s)
            return
        self.largest(s.result)
        unit = self.unit(s.result)
        if s.operator in ("*", "/"):
            value = self.times(s, unit)
        elif s.operator == "floor":
            value = self.down(s.operands[0])
        else:
            of = [self.read(o, unit) for o in s.operands]
            value = of[0] if s.operator in ("real", "integer", "copy") else self.made(s.operator, *of)
        new = isinstance(value, Variable) and value.kind == "integer" and value not in self.names.values()
        if isinstance(value, Variable) and new and not s.result.changes:
            value.hint = s.result.hint
            self.names[s.result] = value
        else:
            self.out.append(Operation(self.named(s.result), "copy", (value,)))

    def times(self, s: Operation, unit: Unit) -> Operand:
        """A product with a known number."""
        found = factor(s)
        assert found is not None, "units_of has refused the rest"
        x, by = found
        assert isinstance(x, Variable), "what is known twice is computed before"
        own, n = self.unit(x), self.largest(x)
        named = self.names[x]
        if by == 0.0:
            return Constant(0, "integer")
        if abs(abs(by) * self.scale.size(own) / self.scale.size(unit) - 1.0) <= SAME:
            return named if by > 0 else self.made("negate", named)
        return self.product(named, n, by * self.scale.size(own), unit)

    def down(self, a: Operand) -> Operand:
        """The floor of a number without a unit."""
        unit = self.unit(a)
        if (unit.counts, unit.steps) != (0, 0) or not isinstance(a, Variable):
            raise NoBound("it rounds a number that has a unit")
        self.largest(a)
        return self.names[a] if unit.fraction <= 0 else self.made(">>", self.names[a], unit.fraction)

    def test(self, s: Operation) -> None:
        """A comparison; with a known number the whole number that decides alike."""
        result = self.named(s.result, "truth")
        if s.operator in ("and", "or", "not", "copy"):
            self.out.append(Operation(result, s.operator, tuple(self.truth(o) for o in s.operands)))
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
                self.off(self.constants, abs(level - near) * self.scale.size(unit))
            near = max(min(near, self.scale.largest), -self.scale.largest)
            self.out.append(Operation(result, operator, (self.names[a], Constant(near, "integer"))))
            return
        unit = self.units.together(a, b) or self.scale.force
        self.out.append(Operation(result, operator, (self.read(a, unit), self.read(b, unit))))


_MIRRORED = {"<": ">", ">": "<", "<=": ">=", ">=": "<=", "==": "==", "!=": "!="}
_NARROW = 2**15 - 1
_FORCE = 2**31 - 1
"""The force is given in 32 bits, whatever the word is."""
_BYTES = (16, 24, 32)
"""Shifts a small chip does by whole bytes; where n ≤ 2^k the factor's rounding is half a unit or less."""
_PRECISE = 2.0**12
"""A factor from here on is as good as its whole number: off by one part in 8000, or less."""
