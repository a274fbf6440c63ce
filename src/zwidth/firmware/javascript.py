"""A program as JavaScript, whose numbers are all double."""

from __future__ import annotations

from dataclasses import dataclass

from zwidth.firmware.c99 import real_text
from zwidth.firmware.printer import Printer
from zwidth.firmware.program import Call, Cells, Constant, Table, Variable

KEYWORDS = frozenset(
    [
        "await",
        "break",
        "case",
        "catch",
        "class",
        "const",
        "continue",
        "debugger",
        "default",
        "delete",
        "do",
        "else",
        "export",
        "extends",
        "false",
        "finally",
        "for",
        "function",
        "if",
        "import",
        "in",
        "instanceof",
        "let",
        "new",
        "null",
        "return",
        "static",
        "super",
        "switch",
        "this",
        "throw",
        "true",
        "try",
        "typeof",
        "var",
        "void",
        "while",
        "with",
        "yield",
        "arguments",
        "eval",
        "undefined",
        "s",
        "counts",
        "table",
        "Math",
        "least",
        "most",
        "rest",
    ]
)

HELPERS = {
    "least": "const least = (a, b) => (b < a ? b : a);",
    "most": "const most = (a, b) => (b > a ? b : a);",
    "rest": "const rest = (a, b) => { const r = a % b; return r < 0 ? r + b : r + 0; };",
}
"""Functions that a text may need; divisors are positive."""

_LIBRARY = {
    "abs": "Math.abs",
    "floor": "Math.floor",
    "ceil": "Math.ceil",
    "sqrt": "Math.sqrt",
}


@dataclass
class JavaScript(Printer):
    """Writes JavaScript."""

    def constant(self, constant: Constant) -> str:
        if constant.kind == "truth":
            return "true" if constant.value else "false"
        return real_text(constant.value, "double") if constant.kind == "real" else str(int(constant.value))

    def operation(self, operator: str, kind: str, read: list[str]) -> str:
        if operator in _LIBRARY:
            return f"{_LIBRARY[operator]}({read[0]})"
        if operator in ("and", "or"):
            return f"{read[0]} {'&&' if operator == 'and' else '||'} {read[1]}"
        if operator == "not":
            return f"!{read[0]}"
        if operator == "select":
            return f"{read[0]} ? {read[1]} : {read[2]}"
        if operator == "real":
            return read[0]
        if operator == "integer":
            return f"Math.trunc({read[0]}) + 0"
        if operator == "//":
            return f"Math.floor(({read[0]}) / ({read[1]}))"
        helper = {"min": "least", "max": "most", "%": "rest"}[operator]
        self.helpers.add(helper)
        return f"{helper}({', '.join(read)})"

    def infix(self, operator: str, kind: str, left: str, right: str) -> str:
        text = f"{left} { {'==': '===', '!=': '!=='}.get(operator, operator) } {right}"
        return f"{text} + 0" if operator == "*" and kind == "integer" else text  # there is no whole −0

    def negated(self, kind: str, text: str) -> str:
        return f"0 - {text}" if kind == "integer" else f"-{text}"

    def declared(self, variable: Variable, name: str) -> str:
        return f"let {name} = {'false' if variable.kind == 'truth' else '0'};"

    def given(self, variable: Variable, name: str, text: str) -> str:
        return f"const {name} = {text};"

    def place(self, source: Cells | Table, name: str, index: str) -> str:
        return f"s.{name}[{index}]" if isinstance(source, Cells) else f"{name}[{index}]"

    def called(self, call: Call, names: list[str], given: list[str]) -> list[str]:
        text = f"{call.name}({', '.join([*(['s'] if call.program.cells else []), *given])});"
        if not any(map(self.is_read, call.results)):
            return [text]
        return [f"const {_one_or_list(names)} = {text}"]

    def whole_function(self) -> list[str]:
        program = self.program
        given = [*(["s"] if program.cells else []), *(self.name(v) for v in program.parameters)]
        body = [*(f"    {line}" for line in self.changing()), *self.block(program.body, 1)]
        results = [self.read(r, alone=True) for r in program.results]
        if results:
            body.append(f"    return {_one_or_list(results)};")
        return [*self.table_lines(), f"function {self.function}({', '.join(given)}) {{", *body, "}"]

    def counter(self) -> str:
        return "let"

    def helper_lines(self) -> list[str]:
        """The functions that the text calls."""
        return [text for name, text in HELPERS.items() if name in self.helpers]

    def table_lines(self) -> list[str]:
        """The tables of the program."""
        return [
            f"const {name} = [{', '.join(real_text(v, 'double') for v in table.values)}];"
            for table, name in self.tables().items()
        ]


def _one_or_list(texts: list[str]) -> str:
    return texts[0] if len(texts) == 1 else f"[{', '.join(texts)}]"
