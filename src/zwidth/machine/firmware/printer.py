"""A program as text: what C99 and JavaScript have in common.

A result that is read once is written where it is read, in parentheses; the order of the operations stays.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import ClassVar

from zwidth.machine.firmware.program import (
    Branch,
    Call,
    Cells,
    Constant,
    Count,
    Leave,
    Load,
    Operand,
    Operation,
    Program,
    Statement,
    Store,
    Table,
    Variable,
    While,
    blocks,
    everything,
    operands,
)
from zwidth.native.names import by_kind

AS_IN_C = {
    **{o: f"{{}} {o} {{}}" for o in ("+", "-", "*", "/", "<", "<=", "==", "!=", ">", ">=")},
    "negate": "-{}",
    "and": "{} && {}",
    "or": "{} || {}",
    "not": "!{}",
    "select": "{} ? {} : {}",
}
"""Operations that C and JavaScript write alike, with operands in parentheses."""

LONGEST_LINE = 110
"""Beyond which a choice between two numbers is written as two blocks."""


@dataclass
class Printer(ABC):
    """Writes one program; a language fills in how it says things.  `reserved` names are taken."""

    program: Program
    reserved: frozenset[str] = frozenset()
    function: str = ""
    """The name of the function, where it stands apart."""
    helpers: set[str] = field(default_factory=set)
    """What was said of `SAID`."""

    SAID: ClassVar[Mapping[str, str]]
    """How a language says an operation, or one of a kind of numbers, as "abs integer"."""
    HELPERS: ClassVar[Mapping[str, str]]
    """The function that it then calls, where that is none of its own; divisors are positive."""

    def __post_init__(self) -> None:
        self._names: dict[Variable, str] = {}
        self._taken = set(self.reserved)
        for given in self.program.parameters:  # these keep their names
            self._names[given] = given.hint
            self._taken.add(given.hint)
        self._inside: dict[Variable, Operation | Load] = {}
        reads = [o for s in self.program.statements() for o in operands(s)]
        self._reads = Counter(o for o in [*reads, *self.program.results] if isinstance(o, Variable))
        table = f"{self.function}_table" if self.function else "table"
        self._tables = {t: f"{table}_{k}" if k else table for k, t in enumerate(self.program.tables())}
        self._taken |= {*self._tables.values(), *self.program.functions()}
        _find_inside(self.program.body, self._reads, self._inside, ())
        self._chosen = _chosen(self.program.body, self._reads, self._inside)

    # ---- how a language says things

    @abstractmethod
    def constant(self, constant: Constant) -> str:
        """A number."""

    def operation(self, operator: str, kind: str, read: list[str]) -> str:
        """An expression of operands that are written; `kind` of the first."""
        key = f"{operator} {kind}" if f"{operator} {kind}" in self.SAID else operator
        self.helpers.add(key)
        return self.SAID[key].format(*read, **self.words())

    def words(self) -> dict[str, str]:
        """What the texts of this language have in braces."""
        return {}

    def helper_lines(self) -> list[str]:
        """The functions that the text calls, in the order in which they may stand."""
        return [text.format(**self.words()) for key, text in self.HELPERS.items() if key in self.helpers]

    @abstractmethod
    def declared(self, variable: Variable, name: str) -> str:
        """The declaration of a variable that changes."""

    @abstractmethod
    def given(self, variable: Variable, name: str, text: str) -> str:
        """A result that never changes."""

    @abstractmethod
    def called(self, call: Call, names: list[str], given: list[str]) -> list[str]:
        """The lines that give the results of a function that stands apart their names."""

    @abstractmethod
    def whole_function(self) -> list[str]:
        """The program as a function that stands apart, with its tables."""

    def function_lines(self) -> list[str]:
        """The functions that stand apart, in the order in which they may stand."""
        lines: list[str] = []
        for name, program in self.program.functions().items():
            one = replace(self, program=program, function=name, helpers=set())
            lines += [*one.whole_function(), ""]
            self.helpers |= one.helpers
        return lines

    @abstractmethod
    def place(self, source: Cells | Table, name: str, index: str) -> str:
        """One number of an array."""

    # ---- the same in all

    def name(self, variable: Variable) -> str:
        """The name of a variable, given when it is first met."""
        if variable not in self._names:
            hint = variable.hint.strip("_") if variable.hint.isascii() else ""
            wish, k = hint or "t", 1
            name = hint or "t1"
            while name in self._taken:
                k += 1
                name = f"{wish}{k}"
            self._taken.add(name)
            self._names[variable] = name
        return self._names[variable]

    def is_read(self, variable: Variable) -> bool:
        """Whether anything reads it."""
        return self._reads[variable] > 0

    def tables(self) -> dict[Table, str]:
        """The tables and their names."""
        return self._tables

    def lines(self) -> list[str]:
        """The program, in the body of a function: the variables that change, and the statements."""
        chosen = {v for v, once in self._chosen.values() if once}
        found = [v for v in map(_set, self.program.statements()) if v and v not in chosen]
        declared = [self.declared(v, self.name(v)) for v in dict.fromkeys(found)]
        return [*(f"    {line}" for line in declared), *self.block(self.program.body, 1)]

    def read(self, operand: Operand, alone: bool = False) -> str:
        """An operand, in parentheses where it is more than a name and does not stand alone."""
        if isinstance(operand, Constant):
            text = self.constant(operand)
            return f"({text})" if text.startswith("-") and not alone else text
        made = self._inside.get(operand)
        if made is None:
            return self.name(operand)
        text = self.made(made)
        bare = (
            alone or isinstance(made, Load) or text.isidentifier() or (text.endswith(")") and _is_call(text))
        )
        return text if bare else f"({text})"

    def made(self, statement: Operation | Load) -> str:
        """The expression of an operation or a load."""
        if isinstance(statement, Load):
            return self.load(statement.source, statement.index)
        o, of = statement.operator, statement.operands
        return self.operation(o, of[0].kind, [self.read(x, alone=o not in AS_IN_C) for x in of])

    def load(self, source: Cells | Table, index: Operand) -> str:
        name = self._tables[source] if isinstance(source, Table) else source.name
        return self.place(source, name, self.read(index, alone=True))

    def block(self, body: list[Statement], depth: int) -> list[str]:
        """The lines of a block."""
        return [line for s in body for line in by_kind(self, s)(s, depth, "    " * depth)]

    def _operation(self, s: Operation | Load, depth: int, pad: str) -> list[str]:
        if s.result in self._inside:
            return []
        name, text = self.name(s.result), self.made(s)
        return [pad + (f"{name} = {text};" if s.result.changes else self.given(s.result, name, text))]

    _load = _operation

    def _store(self, s: Store, depth: int, pad: str) -> list[str]:
        place = self.place(s.target, s.target.name, self.read(s.index, alone=True))
        return [f"{pad}{place} = {self.read(s.value, alone=True)};"]

    def _call(self, s: Call, depth: int, pad: str) -> list[str]:
        given = [self.read(a, alone=True) for a in s.arguments]
        return [pad + line for line in self.called(s, [self.name(r) for r in s.results], given)]

    def _leave(self, s: Leave, depth: int, pad: str) -> list[str]:
        return [f"{pad}break;"]

    def _branch(self, s: Branch, depth: int, pad: str) -> list[str]:
        before: list[str] = []
        if s in self._chosen:
            line = pad + self.choice(s, *self._chosen[s])
            if len(line) <= LONGEST_LINE:
                return [line]
            variable, once = self._chosen[s]
            if once:
                before = [pad + self.declared(variable, self.name(variable))]
        then, other = self.block(s.then, depth + 1), self.block(s.other, depth + 1)
        if not then and other:
            return [*before, f"{pad}if (!({self.read(s.test, alone=True)})) {{", *other, f"{pad}}}"]
        lines = [*before, f"{pad}if ({self.read(s.test, alone=True)}) {{", *then]
        return [*lines, f"{pad}}} else {{", *other, f"{pad}}}"] if other else [*lines, f"{pad}}}"]

    def choice(self, s: Branch, variable: Variable, once: bool) -> str:
        """A branch that sets one variable, on one line."""
        parts = [next(operands(x)[0] for x in arm if _set(x)) for arm in (s.then, s.other)]
        text = self.chosen(s.test, *parts)
        name = self.name(variable)
        return self.given(variable, name, text) if once else f"{name} = {text};"

    def chosen(self, test: Operand, a: Operand, b: Operand) -> str:
        """One of two values, the other is not computed."""
        if isinstance(b, Constant) and b.kind == "truth" and not b.value:
            return self.operation("and", "truth", [self.read(test), self.read(a)])
        if isinstance(a, Constant) and a.kind == "truth" and a.value:
            return self.operation("or", "truth", [self.read(test), self.read(b)])
        return self.operation("select", "truth", [self.read(test), self.read(a), self.read(b)])

    def _while(self, s: While, depth: int, pad: str) -> list[str]:
        before = self.block(s.before, depth + 1)
        body = self.block(s.body, depth + 1)
        if not before:
            return [f"{pad}while ({self.read(s.test, alone=True)}) {{", *body, f"{pad}}}"]
        leave = f"{pad}    if (!{self.read(s.test)}) {{ break; }}"
        return [f"{pad}for (;;) {{", *before, leave, *body, f"{pad}}}"]

    def _count(self, s: Count, depth: int, pad: str) -> list[str]:
        stop = self.read(s.stop)
        n = self.name(s.counter)
        start, compare = self.read(s.start, alone=True), "<" if s.step > 0 else ">"
        step = f"{n} += {s.step}" if s.step > 0 else f"{n} -= {-s.step}"
        head = f"for ({self.counter()} {n} = {start}; {n} {compare} {stop}; {step}) {{"
        return [pad + head, *self.block(s.body, depth + 1), f"{pad}}}"]

    @abstractmethod
    def counter(self) -> str:
        """How the counter of a loop is declared."""


def comment(lines: Sequence[str]) -> list[str]:
    """Lines as a comment of C and of JavaScript."""
    return ["/*", *(f" * {line}".rstrip() for line in lines), " */"]


def _is_call(text: str) -> bool:
    """Whether a text is one call, `f(…)`, and not `f(…) + g(…)`."""
    head, depth = text.find("("), 0
    if head <= 0 or not text[:head].replace("_", "").replace(".", "").isalnum():
        return False
    for k in range(head, len(text)):
        depth += {"(": 1, ")": -1}.get(text[k], 0)
        if depth == 0:
            return k == len(text) - 1
    return False


def _find_inside(
    block: list[Statement],
    reads: Counter[Variable],
    inside: dict[Variable, Operation | Load],
    last: tuple[Operand, ...],
) -> None:
    """Results that are read once, in the same block or by `last`, by what may be written around them."""
    open_loads: dict[Variable, Operation | Load] = {}
    pure: dict[Variable, Operation | Load] = {}

    def take(operands: tuple[Operand, ...], also_open: bool = True) -> None:
        for o in operands:
            if isinstance(o, Variable) and reads[o] == 1:
                made = pure.pop(o, None) or (open_loads.pop(o, None) if also_open else None)
                if made is not None:
                    inside[o] = made

    for s in block:
        if isinstance(s, Count):
            take((s.start,))
            take((s.stop,), also_open=False)  # it is computed in every pass
        elif not isinstance(s, While):
            take(operands(s))
        for inner in blocks(s):
            test = isinstance(s, While) and inner is s.before
            _find_inside(inner, reads, inside, operands(s) if test else ())
        if isinstance(s, Call) and not s.program.cells:
            continue
        if _set(s) or not isinstance(s, Operation | Load):
            open_loads.clear()  # what was read before may be changed behind
            continue
        changing = any(
            isinstance(o, Variable) and (o.changes or _is_open(o, inside, open_loads)) for o in operands(s)
        )
        if (isinstance(s, Load) and isinstance(s.source, Cells)) or changing:
            open_loads[s.result] = s
        else:
            pure[s.result] = s
    take(last)


def _chosen(
    block: list[Statement], reads: Counter[Variable], inside: dict[Variable, Operation | Load]
) -> dict[Branch, tuple[Variable, bool]]:
    """Branches that only set one variable; whether nothing else sets it, and it is read behind it alone."""
    found: dict[Branch, tuple[Variable, bool]] = {}
    sets = Counter(map(_set, everything(block)))

    def go(block: list[Statement]) -> None:
        for k, s in enumerate(block):
            for inner in blocks(s):
                go(inner)
            if not isinstance(s, Branch):
                continue
            ways = [_only_set(s.then, inside), _only_set(s.other, inside)]
            if ways[0] is None or ways[0] is not ways[1]:
                continue
            behind = [o for x in everything(block[k + 1 :]) for o in operands(x)]
            alone = sets[ways[0]] == 2 and (block is whole or behind.count(ways[0]) == reads[ways[0]])
            found[s] = ways[0], alone

    whole = block
    go(block)
    return found


def _only_set(block: list[Statement], inside: dict[Variable, Operation | Load]) -> Variable | None:
    """The variable that a block sets, if it does nothing else."""
    shown = [s for s in block if not (isinstance(s, Operation | Load) and s.result in inside)]
    return _set(shown[0]) if len(shown) == 1 else None


def _set(s: Statement) -> Variable | None:
    """The variable that changes and that a statement sets."""
    return s.result if isinstance(s, Operation) and s.result.changes else None


def _is_open(
    operand: Variable, inside: dict[Variable, Operation | Load], open_loads: dict[Variable, Operation | Load]
) -> bool:
    """Whether what is written in this place is itself read from what may change."""
    made = inside.get(operand)
    if made is None:
        return False
    if isinstance(made, Load) and isinstance(made.source, Cells):
        return True
    return any(
        isinstance(o, Variable) and (o.changes or _is_open(o, inside, open_loads)) for o in operands(made)
    )
