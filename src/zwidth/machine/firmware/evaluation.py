"""One pass through a program with bounds in the place of numbers.

Where a test is taken on numbers with errors, the computed program may go the other way than the exact one.
Both ways are then followed in the strip in which that can be, and what they differ by is an error too.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Protocol

from zwidth.machine.firmware.bound import (
    Bound,
    absolute,
    added,
    apart,
    divided,
    floored,
    hull,
    least,
    most,
    multiplied,
    plain,
    remembered,
    rooted,
    scaled,
)
from zwidth.machine.firmware.program import (
    Branch,
    Cells,
    Constant,
    Load,
    Operand,
    Operation,
    Program,
    Statement,
    Store,
    Variable,
)
from zwidth.machine.firmware.specialise import LONGEST_SEARCH
from zwidth.native.names import by_kind

Rounded = Operation | Store


UNBOUNDED = (
    "it runs through a loop whose passes depend on what is measured; a search in at most "
    f"{LONGEST_SEARCH + 1} points is written out, and has a bound"
)


class NoBound(Exception):
    """Nothing can be said of a number, and why."""


class Arithmetic(Protocol):
    """How a machine's numbers differ from real ones."""

    def constant(self, value: float, statement: Statement | None) -> float:
        """How far a number of the law, 0 apart, is off as a statement has it."""

    def rounding(self, statement: Rounded, of: tuple[Bound, ...], result: Bound) -> float:
        """How far a result is off its operands' exact result; of a comparison, its two sides together."""

    def keeps_sign(self, statement: Rounded) -> bool:
        """Whether a result that is off still has the exact one's sign, and is 0 only where that is."""


class Exact:
    """Real numbers: no error at all."""

    def constant(self, value: float, statement: Statement | None) -> float:
        return 0.0

    def rounding(self, statement: Rounded, of: tuple[Bound, ...], result: Bound) -> float:
        return 0.0

    def keeps_sign(self, statement: Rounded) -> bool:
        return True


@dataclass(frozen=True)
class Test:
    """A comparison, as far as it narrows what it compares; and by how much that is rounded for it."""

    operator: str
    left: Operand
    right: Operand
    rounding: float = 0.0


@dataclass(frozen=True)
class Truth:
    """Which ways a test can go; `sure` where no error can turn it."""

    true: bool
    false: bool
    sure: bool
    test: Test | None = None


_OPPOSITE = {"<": ">=", ">=": "<", ">": "<=", "<=": ">", "==": "!=", "!=": "=="}


@dataclass
class Evaluation:
    """Bounds of everything in a program; `seen` has of every result the hull of what it was.

    `converter` is the floor that takes the converter's nearest step: the exact law has none, so it is an
    error too.
    """

    arithmetic: Arithmetic
    converter: Operation | None = None
    seen: dict[Variable, Bound] = field(default_factory=dict)

    def run(
        self, program: Program, given: Mapping[Variable, Bound], memory: list[tuple[float, float, float]]
    ) -> tuple[list[Bound], tuple[Bound, ...]]:
        """What is remembered after one call, and the results.

        The cells of the program are one array; of the memory low, high and error of every place before the
        call.
        """
        way = _Way(dict(given), [remembered(k, *m) for k, m in enumerate(memory)], {})
        self.block(program.body, way, keep=True)
        return way.cells, tuple(self.value(r, way) for r in program.results)

    def block(self, body: list[Statement], way: _Way, keep: bool) -> None:
        """Follow a block; `keep` the bounds of its results."""
        for s in body:
            follow = by_kind(self, s)
            if follow is None:
                raise NoBound(UNBOUNDED)
            follow(s, way, keep)

    def _store(self, s: Store, way: _Way, keep: bool) -> None:
        value = self.value(s.value, way, s)
        way.cells[_place(s.index)] = self.rounded(s, (value,), value)

    def keep(self, variable: Variable, value: Bound, keep: bool) -> None:
        """Note what a result can be."""
        if keep:
            self.seen[variable] = hull(self.seen[variable], value) if variable in self.seen else value

    def value(self, operand: Operand, way: _Way, statement: Statement | None = None) -> Bound:
        """The bound of an operand of a statement."""
        if isinstance(operand, Variable):
            if operand not in way.values:
                raise NoBound("it reads a number that no way has given")
            return way.values[operand]
        number = float(operand.value)
        error = self.arithmetic.constant(number, statement) if operand.kind == "real" and number else 0.0
        return plain(number, number, error, signed=True)

    def _load(self, s: Load, way: _Way, keep: bool) -> None:
        if isinstance(s.source, Cells):
            value = way.cells[_place(s.index)]
        else:
            index = self.value(s.index, way)
            reach = s.source.values[int(max(index.low, 0)) : int(index.high) + 1]
            if not reach or index.error:
                raise NoBound("it looks up a table at a place that is not sure")
            error = max(self.arithmetic.constant(v, s) for v in reach)
            value = plain(min(reach), max(reach), error)
        way.values[s.result] = value
        self.keep(s.result, value, keep)

    def _operation(self, s: Operation, way: _Way, keep: bool) -> None:
        if s.result.kind == "truth":
            truth = self.tested(s, way)
            way.truths[s.result] = replace(truth, test=None) if s.result.changes else truth
            return
        of = tuple(self.value(o, way, s) for o in s.operands)
        value = _result(s, of) if s is not self.converter else _to_the_nearest(of[0])
        value = self.rounded(s, of, value)
        way.values[s.result] = value
        self.keep(s.result, value, keep)

    def rounded(self, s: Rounded, of: tuple[Bound, ...], exact: Bound) -> Bound:
        """A result as the machine has it."""
        error = self.arithmetic.rounding(s, of, exact)
        signed = exact.signed and (error == 0.0 or self.arithmetic.keeps_sign(s))
        return replace(exact.with_error(error), signed=signed)

    # ---- tests and branches

    def truth(self, operand: Operand, way: _Way) -> Truth:
        """Which ways a test can go."""
        if isinstance(operand, Constant):
            return Truth(bool(operand.value), not operand.value, True)
        return way.truths[operand]

    def tested(self, s: Operation, way: _Way) -> Truth:
        """The truth of a comparison, or of several."""
        if s.operator == "not":
            one = self.truth(s.operands[0], way)
            return Truth(one.false, one.true, one.sure, _not(one.test))
        if s.operator in ("and", "or"):
            p, q = (self.truth(o, way) for o in s.operands)
            if s.operator == "and":
                return Truth(p.true and q.true, p.false or q.false, p.sure and q.sure)
            return Truth(p.true or q.true, p.false and q.false, p.sure and q.sure)
        if s.operator == "copy":
            return self.truth(s.operands[0], way)
        a, b = (self.value(o, way, s) for o in s.operands)
        true, false = _can(s.operator, a, b), _can(_OPPOSITE[s.operator], a, b)
        rounding = self.arithmetic.rounding(s, (a, b), added(a, b, -1.0))
        doubt = a.error + b.error + rounding
        exact = doubt == 0.0 or (b.low == b.high == b.error == rounding == 0.0 and a.signed)
        away = a.low - b.high > doubt or b.low - a.high > doubt
        return Truth(true, false, exact or away, Test(s.operator, s.operands[0], s.operands[1], rounding))

    def _branch(self, s: Branch, way: _Way, keep: bool) -> None:
        """Both ways of a branch, as far as they can be taken, joined."""
        truth = self.truth(s.test, way)
        ways = []
        for can, body, test in ((truth.true, s.then, truth.test), (truth.false, s.other, _not(truth.test))):
            if can:
                ways.append(self.narrowed(way, test, 0.0))
                self.block(body, ways[-1], keep)
        joined = ways[0] if len(ways) == 1 else _joined(ways[0], ways[1], None)
        if not truth.sure:
            then, other = self.strip(way, truth.test), self.strip(way, truth.test)
            self.block(s.then, then, keep)
            self.block(s.other, other, keep)
            joined = _joined(joined, _joined(then, other, way), None)
        way.values, way.cells, way.truths = joined.values, joined.cells, joined.truths

    def narrowed(self, way: _Way, test: Test | None, doubt: float) -> _Way:
        """A way on which a test holds, to within a doubt."""
        new = _Way(dict(way.values), list(way.cells), dict(way.truths))
        if test is None:
            return new
        a, b = self.value(test.left, way), self.value(test.right, way)
        if test.operator in ("<", "<=", "=="):
            new.narrow(test.left, -_INFINITE, b.high + doubt)
            new.narrow(test.right, a.low - doubt, _INFINITE)
        if test.operator in (">", ">=", "=="):
            new.narrow(test.left, b.low - doubt, _INFINITE)
            new.narrow(test.right, -_INFINITE, a.high + doubt)
        return new

    def strip(self, way: _Way, test: Test | None) -> _Way:
        """Where the computed program may decide otherwise than the exact one."""
        if test is None:
            return self.narrowed(way, None, 0.0)
        sides = self.value(test.left, way), self.value(test.right, way)
        doubt = sides[0].error + sides[1].error + test.rounding
        return self.narrowed(way, replace(test, operator="=="), doubt)


_INFINITE = float("inf")


@dataclass
class _Way:
    """What is known on one way through the program."""

    values: dict[Variable, Bound]
    cells: list[Bound]
    truths: dict[Variable, Truth]

    def narrow(self, operand: Operand, low: float, high: float) -> None:
        """An operand is known to lie in [low, high]."""
        if isinstance(operand, Variable):
            self.values[operand] = self.values[operand].within(low, high)


def _joined(a: _Way, b: _Way, differing_from: _Way | None) -> _Way:
    """One way or the other; with `differing_from`, the computed program on one and the exact on the other."""

    def one(x: Bound, y: Bound, before: Bound | None) -> Bound:
        both = hull(x, y)
        if differing_from is None or (x is before and y is before):
            return both
        error = max(both.error, apart(x, y), apart(y, x))
        return plain(both.low, both.high, error)

    old = _Way({}, [], {}) if differing_from is None else differing_from
    values = {
        v: one(a.values[v], b.values[v], old.values.get(v)) if v in a.values and v in b.values
        else a.values.get(v) or b.values[v]
        for v in {**a.values, **b.values}
    }  # fmt: skip
    cells = [
        one(x, y, old.cells[k] if old.cells else None)
        for k, (x, y) in enumerate(zip(a.cells, b.cells, strict=True))
    ]
    truths = {v: _either(a.truths.get(v), b.truths.get(v), old) for v in {**a.truths, **b.truths}}
    return _Way(values, cells, truths)


def _either(a: Truth | None, b: Truth | None, old: _Way) -> Truth:
    if a is None or b is None or a == b:
        found = a or b
        assert found is not None
        return found
    sure = a.sure and b.sure and not old.cells
    return Truth(a.true or b.true, a.false or b.false, sure)


def _not(test: Test | None) -> Test | None:
    return test and replace(test, operator=_OPPOSITE[test.operator])


def _can(operator: str, a: Bound, b: Bound) -> bool:
    """Whether a comparison can hold."""
    if operator == "!=":
        return not (a.low == a.high == b.low == b.high)
    if operator == "==":
        return a.low <= b.high and b.low <= a.high
    if operator in ("<", "<="):
        return a.low < b.high or (operator == "<=" and a.low == b.high)
    return b.low < a.high or (operator == ">=" and b.low == a.high)


def _place(index: Operand) -> int:
    if isinstance(index, Variable):
        raise NoBound("which of the numbers that it remembers it takes depends on what is measured")
    return int(index.value)


def _to_the_nearest(a: Bound) -> Bound:
    """⌊v + ½⌋ beside v."""
    return added(a, plain(-0.5, -0.5), 1.0).with_error(0.5)


def _result(s: Operation, of: tuple[Bound, ...]) -> Bound:
    """The exact operation on bounds."""
    a, b = of[0], of[-1]
    if s.operator in ("+", "-"):
        return added(a, b, 1.0 if s.operator == "+" else -1.0)
    if s.operator == "*":
        for c, x, given in ((a, b, s.operands[0]), (b, a, s.operands[1])):
            if isinstance(given, Constant):  # its own error is one of the law's
                return scaled(x, c.low).with_error(c.error * x.computed_size)
        return multiplied(a, b)
    if s.operator == "/":
        if isinstance(s.operands[1], Constant) and b.low != 0.0:
            off = b.error / (abs(b.low) - b.error) / abs(b.low)
            return scaled(a, 1.0 / b.low).with_error(off * a.computed_size)
        return divided(a, b)
    if s.operator in ("min", "max"):
        return least(a, b) if s.operator == "min" else most(a, b)
    simple = {"abs": absolute, "floor": floored, "sqrt": rooted}
    if s.operator in simple:
        return simple[s.operator](a)
    if s.operator == "negate":
        return scaled(a, -1.0)
    if s.operator in ("copy", "real"):
        return a
    raise NoBound(f"nothing is known of its operation {s.operator!r} on what is not known")
