"""A law as a machine runs it: operations on numbers, one after the other.

    operation    v = a ∘ b            every result is given once and never changes
                 w = v                but for the few that branches and loops change
    load, store  v = s[i],  s[i] = v  what is remembered from sample to sample
    branch, loop, leave, call         as in any language

No operation hides another, so the order of rounding is the order of the text, in whatever language it
is printed.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Literal

Kind = Literal["real", "integer", "truth"]


@dataclass(frozen=True)
class Constant:
    """A number that is known."""

    value: float | int | bool
    kind: Kind


@dataclass(eq=False)
class Variable:
    """A number that is not known; `hint` is its name in the source."""

    kind: Kind
    hint: str = ""
    changes: bool = False
    """True where branches or loops set it."""


Operand = Constant | Variable

OPERATORS = (
    "+", "-", "*", "/", "//", "%", "<", "<=", "==", "!=", ">", ">=", "and", "or", "not",
    "negate", "abs", "floor", "ceil", "sqrt", "min", "max", "select", "real", "integer", "copy",
)  # fmt: skip
"""
`min(a, b)` is b where b < a, else a; `max` likewise; `//` and `%` round towards −∞; `select(c, a, b)`;
`real` and `integer` convert, the latter towards 0.
"""


@dataclass(eq=False)
class Operation:
    """v = operator(operands)."""

    result: Variable
    operator: str
    operands: tuple[Operand, ...]


@dataclass(frozen=True)
class Cells:
    """Numbers that are remembered, or given by the caller, by their place."""

    name: str
    size: int


@dataclass(frozen=True)
class Table:
    """Numbers that are known, by their place."""

    name: str
    values: tuple[float, ...]


@dataclass(eq=False)
class Load:
    """v = cells[index]."""

    result: Variable
    source: Cells | Table
    index: Operand


@dataclass(eq=False)
class Store:
    """cells[index] = value."""

    target: Cells
    index: Operand
    value: Operand


@dataclass(eq=False)
class Branch:
    """If the test holds, one block, else the other."""

    test: Operand
    then: list[Statement] = field(default_factory=list)
    other: list[Statement] = field(default_factory=list)


@dataclass(eq=False)
class Count:
    """The body for counter = start, start + step … before stop; step is known and not 0."""

    counter: Variable
    start: Operand
    stop: Operand
    step: int
    body: list[Statement] = field(default_factory=list)


@dataclass(eq=False)
class While:
    """What comes before the test, the test, the body; again, while the test holds."""

    before: list[Statement] = field(default_factory=list)
    test: Operand = Constant(True, "truth")
    body: list[Statement] = field(default_factory=list)


@dataclass(eq=False)
class Leave:
    """Out of the innermost loop."""


@dataclass(eq=False)
class Call:
    """results = a function that stands apart, because it is called at several places; of no law."""

    results: tuple[Variable, ...]
    name: str
    program: Program
    arguments: tuple[Operand, ...]


Statement = Operation | Load | Store | Branch | Count | While | Leave | Call


@dataclass(eq=False)
class Program:
    """What a machine does at one call.

    It is given parameters, in order, and cells, which it remembers or changes; it gives back results.
    """

    parameters: tuple[Variable, ...]
    cells: tuple[Cells, ...]
    body: list[Statement]
    results: tuple[Operand, ...]

    def statements(self) -> Iterator[Statement]:
        """Every statement, in the order of the text, with those inside others."""
        return everything(self.body)

    def tables(self) -> tuple[Table, ...]:
        """The tables that are read, each once."""
        read = (s.source for s in self.statements() if isinstance(s, Load))
        return tuple(dict.fromkeys(t for t in read if isinstance(t, Table)))

    def functions(self) -> dict[str, Program]:
        """The functions that stand apart, by name; what one calls comes before it."""
        found: dict[str, Program] = {}
        for call in (s for s in self.statements() if isinstance(s, Call)):
            found |= call.program.functions() | {call.name: call.program}
        return found


_READS: dict[type, tuple[str, ...]] = {
    Operation: ("operands",), Load: ("index",), Store: ("index", "value"), Branch: ("test",),
    Count: ("start", "stop"), While: ("test",), Leave: (), Call: ("arguments",),
}  # fmt: skip
_HOLDS: dict[type, tuple[str, ...]] = {Branch: ("then", "other"), Count: ("body",), While: ("before", "body")}
"""Where a kind of statement has what it reads, and other statements."""


def set_to(variable: Variable, value: Operand) -> Operation:
    """A variable that changes takes a value."""
    return Operation(variable, "copy", (value,))


def factor(s: Operation) -> tuple[Operand, float] | None:
    """(x, c) of a product x c or c x, or of x/(1/c), with a known number; None of another operation."""
    a, b = s.operands[0], s.operands[-1]
    if s.operator == "*" and isinstance(a, Constant):
        return b, float(a.value)
    if s.operator == "*" and isinstance(b, Constant):
        return a, float(b.value)
    if s.operator == "/" and isinstance(b, Constant) and b.value:
        return a, 1.0 / float(b.value)
    return None


def blocks(statement: Statement) -> tuple[list[Statement], ...]:
    """The blocks inside a statement."""
    held = _HOLDS.get(type(statement))
    return tuple(getattr(statement, key) for key in held) if held else ()


def everything(block: list[Statement]) -> Iterator[Statement]:
    """Every statement of a block, with those inside others."""
    for statement in block:
        yield statement
        for inner in blocks(statement):
            yield from everything(inner)


def operands(statement: Statement) -> tuple[Operand, ...]:
    """What a statement reads, but for the statements inside it."""
    found = (getattr(statement, key) for key in _READS[type(statement)])
    return tuple(o for one in found for o in (one if isinstance(one, tuple) else (one,)))


def rewritten(
    block: list[Statement],
    rule: Callable[[Statement], list[Statement]],
    now: Callable[[Operand], Operand] | None = None,
) -> list[Statement]:
    """What a rule puts in the place of each statement, from the inner ones to the outer ones.

    The rule is given a statement whose blocks are rewritten; `now` says what is read for an operand.
    """
    out: list[Statement] = []
    for s in block:
        new: dict[str, Any] = {key: rewritten(getattr(s, key), rule, now) for key in _HOLDS.get(type(s), ())}
        if now is not None:
            for key in _READS[type(s)]:
                read = getattr(s, key)
                new[key] = tuple(map(now, read)) if isinstance(read, tuple) else now(read)
        out += rule(replace(s, **new) if new else s)
    return out


def with_rule(
    program: Program, rule: Callable[[Statement], list[Statement]], same: Mapping[Variable, Operand]
) -> Program:
    """A program rewritten, without what nobody then reads; `same`, which grows, is what is read for what."""

    def now(operand: Operand) -> Operand:
        return same.get(operand, operand) if isinstance(operand, Variable) else operand

    body = rewritten(program.body, rule, now)
    return without_unused(replace(program, body=body, results=tuple(map(now, program.results))))


def without_unused(program: Program) -> Program:
    """The same without what nobody reads."""
    while True:
        read = {o for s in program.statements() for o in operands(s) if isinstance(o, Variable)}
        read |= {o for o in program.results if isinstance(o, Variable)}
        before = sum(1 for _ in program.statements())
        _sweep(program.body, read)
        if sum(1 for _ in program.statements()) == before:
            return program


def _sweep(block: list[Statement], read: set[Variable]) -> None:
    for statement in block:
        for inner in blocks(statement):
            _sweep(inner, read)
    block[:] = [s for s in block if not _is_unused(s, read)]


def _is_unused(statement: Statement, read: set[Variable]) -> bool:
    if isinstance(statement, Call):
        return not (statement.program.cells or read & set(statement.results))
    if isinstance(statement, Branch | Count):
        return not any(blocks(statement))
    return isinstance(statement, Operation | Load) and statement.result not in read
