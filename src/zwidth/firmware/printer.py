"""A program as text: what C99 and JavaScript have in common.

A result that is read once is written where it is read, in parentheses; the order of the operations stays.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections import Counter
from dataclasses import dataclass, field

from zwidth.firmware.program import (
    Branch,
    Cells,
    Constant,
    Count,
    Leave,
    Load,
    Operand,
    Operation,
    Program,
    Set,
    Statement,
    Store,
    Table,
    Variable,
    While,
    blocks,
    operands,
)

_INFIX = {"+", "-", "*", "/", "<", "<=", "==", "!=", ">", ">="}


@dataclass
class Printer(ABC):
    """Writes one program; a language fills in how it says things.

    Parameters
    ----------
    program
        What is written.
    reserved
        Names that are taken.
    """

    program: Program
    reserved: frozenset[str] = frozenset()
    helpers: set[str] = field(default_factory=set)
    """Functions that the text calls besides those of the language."""

    def __post_init__(self) -> None:
        self._names: dict[Variable, str] = {}
        self._taken = set(self.reserved)
        for given in self.program.parameters:  # these keep their names
            self._names[given] = given.hint
            self._taken.add(given.hint)
        self._inside: dict[Variable, Statement] = {}
        reads = [o for s in self.program.statements() for o in operands(s)]
        self._reads = Counter(o for o in [*reads, *self.program.results] if isinstance(o, Variable))
        self._tables = {t: f"table_{k}" if k else "table" for k, t in enumerate(self.program.tables())}
        _find_inside(self.program.body, self._reads, self._inside)

    # ---- how a language says things

    @abstractmethod
    def constant(self, constant: Constant) -> str:
        """A number."""

    @abstractmethod
    def operation(self, operator: str, kind: str, read: list[str]) -> str:
        """What is no infix operator: "abs", "min", "%" …; `kind` of the first operand."""

    @abstractmethod
    def declared(self, variable: Variable, name: str) -> str:
        """The declaration of a variable that changes."""

    @abstractmethod
    def given(self, variable: Variable, name: str, text: str) -> str:
        """A result that never changes."""

    @abstractmethod
    def place(self, source: Cells | Table, name: str, index: str) -> str:
        """One number of an array."""

    # ---- the same in all

    def name(self, variable: Variable) -> str:
        """The name of a variable, given when it is first met."""
        if variable not in self._names:
            wish, k = variable.hint or "t", 1
            name = variable.hint or "t1"
            while name in self._taken:
                k += 1
                name = f"{wish}{k}"
            self._taken.add(name)
            self._names[variable] = name
        return self._names[variable]

    def tables(self) -> dict[Table, str]:
        """The tables and their names."""
        return self._tables

    def changing(self) -> list[str]:
        """The declarations of the variables that change."""
        found = [s.variable for s in self.program.statements() if isinstance(s, Set)]
        return [self.declared(v, self.name(v)) for v in dict.fromkeys(found)]

    def read(self, operand: Operand, alone: bool = False) -> str:
        """An operand, in parentheses where it is more than a name and does not stand alone."""
        if isinstance(operand, Constant):
            text = self.constant(operand)
            return f"({text})" if text.startswith("-") and not alone else text
        made = self._inside.get(operand)
        if made is None:
            return self.name(operand)
        text = self.made(made)
        bare = alone or isinstance(made, Load) or (text.endswith(")") and _is_call(text))
        return text if bare else f"({text})"

    def made(self, statement: Statement) -> str:
        """The expression of an operation or a load."""
        if isinstance(statement, Load):
            return self.load(statement.source, statement.index)
        assert isinstance(statement, Operation), "results come from operations and loads"
        o, of = statement.operator, statement.operands
        if o in _INFIX:
            return f"{self.read(of[0])} {self.infix(o)} {self.read(of[1])}"
        if o == "copy":
            return self.read(of[0], alone=True)
        if o == "negate":
            return f"-{self.read(of[0])}"
        kind = of[0].kind
        return self.operation(
            o, kind, [self.read(x, alone=o not in ("and", "or", "not", "select")) for x in of]
        )

    def infix(self, operator: str) -> str:
        """How the language writes an infix operator."""
        return operator

    def load(self, source: Cells | Table, index: Operand) -> str:
        name = self._tables[source] if isinstance(source, Table) else source.name
        return self.place(source, name, self.read(index, alone=True))

    def block(self, body: list[Statement], depth: int) -> list[str]:
        """The lines of a block."""
        pad = "    " * depth
        lines: list[str] = []
        for s in body:
            if isinstance(s, Operation | Load):
                if s.result not in self._inside:
                    text = self.made(s)
                    lines.append(pad + self.given(s.result, self.name(s.result), text))
            elif isinstance(s, Store):
                place = self.place(s.target, s.target.name, self.read(s.index, alone=True))
                lines.append(f"{pad}{place} = {self.read(s.value, alone=True)};")
            elif isinstance(s, Set):
                lines.append(f"{pad}{self.name(s.variable)} = {self.read(s.value, alone=True)};")
            elif isinstance(s, Leave):
                lines.append(f"{pad}break;")
            elif isinstance(s, Branch):
                lines += self.branch(s, depth)
            else:
                lines += self.loop(s, depth)
        return lines

    def branch(self, s: Branch, depth: int) -> list[str]:
        pad = "    " * depth
        then, other = self.block(s.then, depth + 1), self.block(s.other, depth + 1)
        if not then and other:
            return [f"{pad}if (!({self.read(s.test, alone=True)})) {{", *other, f"{pad}}}"]
        lines = [f"{pad}if ({self.read(s.test, alone=True)}) {{", *then]
        return [*lines, f"{pad}}} else {{", *other, f"{pad}}}"] if other else [*lines, f"{pad}}}"]

    def loop(self, s: Count | While, depth: int) -> list[str]:
        pad = "    " * depth
        if isinstance(s, While):
            before = self.block(s.before, depth + 1)
            test = self.read(s.test)
            return [
                f"{pad}for (;;) {{", *before, f"{pad}    if (!{test}) {{ break; }}", *self.block(s.body, depth + 1), f"{pad}}}",
            ]  # fmt: skip
        stop = self.read(s.stop)
        n = self.name(s.counter)
        start, compare = self.read(s.start, alone=True), "<" if s.step > 0 else ">"
        step = f"{n} += {s.step}" if s.step > 0 else f"{n} -= {-s.step}"
        head = f"for ({self.counter()} {n} = {start}; {n} {compare} {stop}; {step}) {{"
        return [pad + head, *self.block(s.body, depth + 1), f"{pad}}}"]

    @abstractmethod
    def counter(self) -> str:
        """How the counter of a loop is declared."""


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


def _find_inside(block: list[Statement], reads: Counter[Variable], inside: dict[Variable, Statement]) -> None:
    """Results that are read once, further on in the same block, by what may be written around them."""
    open_loads: dict[Variable, Statement] = {}
    pure: dict[Variable, Statement] = {}
    for s in block:
        for o in _read_here(s):
            if isinstance(o, Variable) and reads[o] == 1:
                made = pure.pop(o, None) or open_loads.pop(o, None)
                if made is not None:
                    inside[o] = made
        for inner in blocks(s):
            _find_inside(inner, reads, inside)
        if not isinstance(s, Operation | Load):
            open_loads.clear()  # what was read before may be changed behind
            continue
        changing = any(
            isinstance(o, Variable) and (o.changes or _is_open(o, inside, open_loads)) for o in operands(s)
        )
        if (isinstance(s, Load) and isinstance(s.source, Cells)) or changing:
            open_loads[s.result] = s
        else:
            pure[s.result] = s


def _is_open(
    operand: Variable, inside: dict[Variable, Statement], open_loads: dict[Variable, Statement]
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


def _read_here(statement: Statement) -> tuple[Operand, ...]:
    """What a statement reads before anything inside it runs, once."""
    return () if isinstance(statement, While) else operands(statement)
