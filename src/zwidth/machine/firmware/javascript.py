"""A program as JavaScript, whose numbers are all double; a law as one ES module: `init`, `step`, `reset`."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar

from zwidth.machine.firmware.c99 import real_text, rest_lines
from zwidth.machine.firmware.law import LawProgram
from zwidth.machine.firmware.printer import AS_IN_C, Printer, comment
from zwidth.machine.firmware.program import Call, Cells, Constant, Table, Variable

_OWN = (
    "await break case catch class const continue debugger default delete do else export extends false "
    "finally for function if import in instanceof let new null return static super switch this throw true "
    "try typeof var void while with yield arguments eval undefined s counts table Math least most rest"
)

KEYWORDS = frozenset(_OWN.split())


@dataclass
class JavaScript(Printer):
    """Writes JavaScript."""

    SAID: ClassVar[Mapping[str, str]] = {
        **AS_IN_C,
        "copy": "{}",
        "==": "{} === {}",
        "!=": "{} !== {}",
        "* integer": "{} * {} + 0",  # there is no whole −0
        "negate integer": "0 - {}",
        "abs": "Math.abs({})",
        "floor": "Math.floor({})",
        "ceil": "Math.ceil({})",
        "sqrt": "Math.sqrt({})",
        "real": "{}",
        "integer": "Math.trunc({}) + 0",
        "//": "Math.floor(({}) / ({}))",
        "min": "least({}, {})",
        "max": "most({}, {})",
        "%": "rest({}, {})",
    }
    HELPERS: ClassVar[Mapping[str, str]] = {
        "min": "const least = (a, b) => (b < a ? b : a);",
        "max": "const most = (a, b) => (b > a ? b : a);",
        "%": "const rest = (a, b) => {{ const r = a % b; return r < 0 ? r + b : r + 0; }};",
    }

    def constant(self, constant: Constant) -> str:
        if constant.kind == "truth":
            return "true" if constant.value else "false"
        return real_text(constant.value, "double") if constant.kind == "real" else str(int(constant.value))

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
        body = self.lines()
        results = [self.read(r, alone=True) for r in program.results]
        if results:
            body.append(f"    return {_one_or_list(results)};")
        return [*self.table_lines(), f"function {self.function}({', '.join(given)}) {{", *body, "}"]

    def counter(self) -> str:
        return "let"

    def table_lines(self) -> list[str]:
        """The tables of the program."""
        return [
            f"const {name} = [{', '.join(real_text(v, 'double') for v in table.values)}];"
            for table, name in self.tables().items()
        ]


def _one_or_list(texts: list[str]) -> str:
    return texts[0] if len(texts) == 1 else f"[{', '.join(texts)}]"


_NEAREST = "    {seen} = Math.min(Math.max({seen}, {upper}_MIN), {upper}_MAX);"


def module(
    law: LawProgram,
    *,
    about: Sequence[str],
    numbers: Iterable[tuple[str, str, str]],
    cuts_readings: bool = False,
) -> str:
    """The text of the module: `about` at its head, `numbers` with name, value and meaning of what it exports.

    `cuts_readings` where a reading beyond those that `numbers` names is taken as the nearest of them.
    """
    js = JavaScript(law.program, KEYWORDS)
    seen = "counts" if law.resolution > 0 else "position"
    near = [_NEAREST.format(seen=seen, upper=seen.upper())] if cuts_readings else []
    body = js.lines()
    result = js.read(law.program.results[0], alone=True)
    lines = [
        *comment(about),
        *(f"export const {key} = {value}; // {meaning}" for key, value, meaning in numbers),
        "",
        *js.table_lines(),
        *js.helper_lines(),
        "",
        f"/* What the law remembers, at rest at this {seen}, as if it had been there for ever. */",
        f"export function init({seen}) {{",
        f"    const s = {{ memory: new Float64Array({max(law.remembers, 1)}), {seen} }};",
        f"    reset(s, {seen});",
        "    return s;",
        "}",
        "",
        "/* One sample: the force to be given from now on [N; N*m], out of a wall is positive. */",
        f"export function step(s, {seen}) {{",
        *near,
        f"    s.{seen} = {seen};",
        *body,
        f"    return {result};",
        "}",
        "",
        "/* Forget what was, at rest where the handle was seen last. */",
        f"export function reset(s, {seen} = s.{seen}) {{",
        *near,
        *rest_lines(law, "double", seen, seen, "s.memory"),
        f"    s.{seen} = {seen};",
        "}",
    ]
    return "\n".join(lines) + "\n"
