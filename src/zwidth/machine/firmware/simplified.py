"""The same program in fewer operations and smaller tables.

    x/c → x (1/c)        (c₁ x) c₂ → x (c₁ c₂)        0 + x → x        x · 0 → 0        −(c x) → x (−c)

of real numbers that do not have the bits of double anyway: the bounds of the errors are found afterwards.  Of
whole numbers copies and sums with 0 go; in floating point 0 + y is not y where y is −0."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field
from math import floor, inf

from zwidth.machine.firmware.program import (
    Branch,
    Call,
    Constant,
    Count,
    Load,
    Operand,
    Operation,
    Program,
    Statement,
    Store,
    Table,
    Variable,
    factor,
    operands,
    with_rule,
)

FOLDED = 2.0**-50
"""Relative: what a number of the law is off by after it was inverted or multiplied by others."""


def simplified(program: Program) -> Program:
    """A program without operations that real numbers do not need; it stays as it is."""
    if not all(isinstance(s, Operation | Load | Store | Branch) for s in program.statements()):
        return program  # with loops, whose numbers change, it is left as it is
    reads = Counter(o for s in program.statements() for o in operands(s) if isinstance(o, Variable))
    rules = _Rules(reads)
    return with_rule(program, rules.simpler, rules.same)


@dataclass
class _Rules:
    reads: Counter[Variable]
    same: dict[Variable, Operand] = field(default_factory=dict)
    factors: dict[Variable, tuple[Operand, float]] = field(default_factory=dict)
    """Of a result: a number that it is, times a known one."""

    def simpler(self, s: Statement) -> list[Statement]:
        if not isinstance(s, Operation) or s.result.kind != "real":
            return [s]
        a, b = s.operands[0], s.operands[-1]
        if s.operator == "+" and _is(a, 0.0) and not _changes(b):
            self.same[s.result] = b
        elif s.operator in ("+", "-") and _is(b, 0.0) and not _changes(a):
            self.same[s.result] = a
        elif s.operator == "*" and (_is(a, 0.0) or _is(b, 0.0)):
            self.same[s.result] = Constant(0.0, "real")
        elif s.operator == "negate" or (s.operator == "-" and _is(a, 0.0)):
            return [self.scaled(s, b, -1.0)]
        else:
            found = factor(s)
            return [self.scaled(s, *found) if found else s]
        return []

    def scaled(self, s: Operation, x: Operand, by: float) -> Operation:
        """A product with a known number, with those before it; what nobody then reads is swept out."""
        if isinstance(x, Variable) and x in self.factors:
            x, before = self.factors[x]
            by *= before
        if (
            not _changes(x) and self.reads[s.result] == 1
        ):  # what is read further on may be known better by then
            self.factors[s.result] = (x, by)
        return Operation(s.result, "*", (Constant(by, "real"), x))


def _changes(operand: Operand) -> bool:
    """Whether it may be another number further on."""
    return isinstance(operand, Variable) and operand.changes


def _is(operand: Operand, value: float) -> bool:
    return isinstance(operand, Constant) and operand.kind == "real" and float(operand.value) == value


def tidied(program: Program) -> Program:
    """The same whole numbers, without loops, from fewer statements; the program stays as it is."""
    same: dict[Variable, Operand] = {}

    def rule(s: Statement) -> list[Statement]:
        left = _same_as(s) if isinstance(s, Operation) and not s.result.changes else None
        if isinstance(s, Operation) and left is not None:
            same[s.result] = left
            return []
        return [s]

    return with_rule(program, rule, same)


def _same_as(s: Operation) -> Operand | None:
    """The operand that it gives back; None where it does more, or what it copies may change."""
    left: Operand | None = None
    if s.operator == "copy" or (s.operator in ("+", "-") and s.operands[1] == _ZERO):
        left = s.operands[0]
    elif s.operator == "+" and s.operands[0] == _ZERO:
        left = s.operands[1]
    return None if isinstance(left, Variable) and left.changes else left


_ZERO = Constant(0, "integer")


# Where in a table of known numbers a program can read: the rest of it is left out.  Every whole number v
# lies in [lo, hi], the hull of the bounds of all that is ever given to it, found by going through the
# program until nothing grows; what still grows then has no bound.  That a test comes before is not taken
# into account.


Bounds = tuple[float, float]

_ANY: Bounds = (-inf, inf)
_ROUNDS = 16
"""After which a bound that still grows is given up."""


def bounds_of(program: Program) -> dict[Variable, Bounds]:
    """Between which numbers each whole number of a program lies."""
    called = (v for s in program.statements() if isinstance(s, Call) for v in s.results)
    found: dict[Variable, Bounds] = {v: _ANY for v in (*program.parameters, *called) if v.kind == "integer"}
    grows, rounds = True, 0
    while grows:
        grows, rounds = False, rounds + 1
        for statement in program.statements():
            variable, new = _given(statement, found)
            if variable is None or variable.kind != "integer" or new is None:
                continue
            old = found.get(variable)
            hull = new if old is None else (min(old[0], new[0]), max(old[1], new[1]))
            if old is not None and rounds > _ROUNDS:
                hull = (old[0] if hull[0] == old[0] else -inf, old[1] if hull[1] == old[1] else inf)
            if hull != old:
                found[variable], grows = hull, True
    return found


def cut_tables(program: Program) -> Program:
    """The same with tables of what is read from them alone."""
    found = bounds_of(program)
    made = {s.result: s for s in program.statements() if isinstance(s, Operation)}

    def rule(s: Statement) -> list[Statement]:
        if not (isinstance(s, Load) and isinstance(s.source, Table)):
            return [s]
        low, high = _of(s.index, found) or _ANY
        last = len(s.source.values) - 1
        first = int(max(low, 0.0))
        kept = Table(s.source.name, s.source.values[first : int(min(high, last)) + 1])
        before: list[Statement] = []
        index = _less(s.index, first, made, before)
        return [*before, Load(s.result, kept, index)]

    return with_rule(program, rule, {})


def _less(index: Operand, first: int, made: dict[Variable, Operation], block: list[Statement]) -> Operand:
    """The index counted from the first number that is kept."""
    if first == 0:
        return index
    if isinstance(index, Constant):
        return Constant(int(index.value) - first, "integer")
    base, more = _split(index, made)
    if more == first:
        return base
    result = Variable("integer")
    sign = "+" if more > first else "-"
    block.append(Operation(result, sign, (base, Constant(abs(more - first), "integer"))))
    return result


def _split(index: Variable, made: dict[Variable, Operation]) -> tuple[Operand, int]:
    """A whole number as another one that never changes and a known distance."""
    operation = made.get(index)
    if operation is not None and operation.operator == "+":
        for one, other in (operation.operands, operation.operands[::-1]):
            if isinstance(one, Constant) and isinstance(other, Variable) and not other.changes:
                base, more = _split(other, made)
                return base, more + int(one.value)
    return index, 0


def _given(statement: Statement, found: dict[Variable, Bounds]) -> tuple[Variable | None, Bounds | None]:
    """What a statement gives to which variable; None for bounds where something in it has none yet."""
    if isinstance(statement, Count):
        start, stop = _of(statement.start, found), _of(statement.stop, found)
        if start is None or stop is None:
            return statement.counter, None
        between = (start[0], stop[1] - 1) if statement.step > 0 else (stop[0] + 1, start[1])
        return statement.counter, between if between[0] <= between[1] else None
    if isinstance(statement, Operation):
        if statement.result.kind != "integer":
            return None, None
        if statement.operator == "integer":
            return statement.result, _ANY
        operands = statement.operands[1:] if statement.operator == "select" else statement.operands
        parts = [_of(o, found) for o in operands]
        if any(p is None for p in parts):
            return statement.result, None
        return statement.result, _RULES.get(statement.operator, _unknown)(*parts)
    return None, None


def _of(operand: Operand, found: dict[Variable, Bounds]) -> Bounds | None:
    if isinstance(operand, Constant):
        return float(operand.value), float(operand.value)
    return found.get(operand)


def _times(a: Bounds, b: Bounds) -> Bounds:
    if inf in map(abs, (*a, *b)):
        return _ANY
    corners = [x * y for x in a for y in b]
    return min(corners), max(corners)


def _over(a: Bounds, b: Bounds) -> Bounds:
    if b[0] != b[1] or b[0] <= 0 or inf in map(abs, a):
        return _ANY
    return float(floor(a[0] / b[0])), float(floor(a[1] / b[0]))


def _rest(a: Bounds, b: Bounds) -> Bounds:
    if b[0] <= 0:
        return _ANY
    return a if a[0] >= 0 and a[1] < b[0] else (0.0, b[1] - 1)


def _unknown(*operands: Bounds | None) -> Bounds:
    return _ANY


def _size(a: Bounds) -> Bounds:
    low = 0.0 if a[0] <= 0 <= a[1] else min(abs(a[0]), abs(a[1]))
    return low, max(abs(a[0]), abs(a[1]))


_RULES: dict[str, Callable[..., Bounds]] = {
    "+": lambda a, b: (a[0] + b[0], a[1] + b[1]),
    "-": lambda a, b: (a[0] - b[1], a[1] - b[0]),
    "*": _times,
    "//": _over,
    "%": _rest,
    "min": lambda a, b: (min(a[0], b[0]), min(a[1], b[1])),
    "max": lambda a, b: (max(a[0], b[0]), max(a[1], b[1])),
    "select": lambda a, b: (min(a[0], b[0]), max(a[1], b[1])),
    "negate": lambda a: (-a[1], -a[0]),
    "abs": _size,
    "copy": lambda a: a,
}
