"""A program as C99: in double or float, or on whole numbers of 32 or 64 bits."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar, Literal

import numpy as np

from zwidth.machine.firmware.law import LawProgram
from zwidth.machine.firmware.printer import AS_IN_C, Printer
from zwidth.machine.firmware.program import Call, Cells, Constant, Load, Operand, Operation, Table, Variable

Real = Literal["double", "float"]

_OF_CPP = (
    "alignas alignof and and_eq asm bitand bitor catch char16_t char32_t class compl concept const_cast "
    "constexpr decltype delete dynamic_cast explicit export friend mutable namespace new noexcept not not_eq "
    "nullptr operator or or_eq private protected public reinterpret_cast requires static_assert static_cast "
    "template this thread_local throw try typeid typename using virtual wchar_t xor xor_eq"
)
"""Words that C++ keeps for itself: a header is included there, too."""

_OWN = (
    "auto break case char const continue default do double else enum extern float for goto if inline int "
    "long register restrict return short signed sizeof static struct switch typedef union unsigned void "
    "volatile while abs fabs fabsf ceilf floorf fmod fmodf sqrtf floor ceil sqrt s counts table true false "
    "bool"
)

KEYWORDS = frozenset(f"{_OF_CPP} {_OWN}".split())


@dataclass
class C99(Printer):
    """Writes C99; `real` is the type of its real numbers."""

    real: Real = "double"
    prefix: str = "law"

    SAID: ClassVar[Mapping[str, str]] = {
        **AS_IN_C,
        "copy": "{}",
        "abs": "fabs{suffix}({})",
        "abs integer": "{prefix}_size({})",
        "floor": "floor{suffix}({})",
        "ceil": "ceil{suffix}({})",
        "sqrt": "sqrt{suffix}({})",
        "real": "({real})({})",
        "integer": "(int32_t)({})",
        "min": "{prefix}_least({}, {})",
        "min integer": "({1}) < ({0}) ? ({1}) : ({0})",
        "max": "{prefix}_most({}, {})",
        "max integer": "({1}) > ({0}) ? ({1}) : ({0})",
        "//": "{prefix}_whole({}, {})",
        "%": "{prefix}_rest({}, {})",
        "% real": "{prefix}_remainder({}, {})",
        "0.0 -": "{prefix}_opposite({})",
    }
    HELPERS: ClassVar[Mapping[str, str]] = {
        "0.0 -": "static inline {real} {prefix}_opposite({real} a) {{ return a == 0 ? 0 : -a; }}",
        "abs integer": "static inline int32_t {prefix}_size(int32_t a) {{ return a < 0 ? -a : a; }}",
        "min": "static inline {real} {prefix}_least({real} a, {real} b) {{ return b < a ? b : a; }}",
        "max": "static inline {real} {prefix}_most({real} a, {real} b) {{ return b > a ? b : a; }}",
        "%": "static inline int32_t {prefix}_rest(int32_t a, int32_t b) "
        "{{ int32_t r = a % b; return r < 0 ? r + b : r; }}",
        "//": "static inline int32_t {prefix}_whole(int32_t a, int32_t b) "
        "{{ return (a - {prefix}_rest(a, b)) / b; }}",
        "% real": "static inline {real} {prefix}_remainder({real} a, {real} b) "
        "{{ {real} r = fmod{suffix}(a, b); return r < 0 ? r + b : r + 0; }}",
    }

    def words(self) -> dict[str, str]:
        return {"real": self.real, "prefix": self.prefix, "suffix": "f" if self.real == "float" else ""}

    def constant(self, constant: Constant) -> str:
        return real_text(constant.value, self.real) if constant.kind == "real" else str(int(constant.value))

    def operation(self, operator: str, kind: str, read: list[str]) -> str:
        if operator == "-" and kind == "real" and read[0] in ("0.0", "0.0f"):
            # gcc makes −x of 0.0 − x where it knows that x is not −0.0, and so −0.0 of 0.0 − 0.0
            operator, read = "0.0 -", read[1:]
        if operator == "//":
            self.helpers.add("%")
        return super().operation(operator, kind, read)

    def declared(self, variable: Variable, name: str) -> str:
        return f"{self.type_of(variable)} {name} = 0;"

    def given(self, variable: Variable, name: str, text: str) -> str:
        return f"const {self.type_of(variable)} {name} = {text};"

    def place(self, source: Cells | Table, name: str, index: str) -> str:
        return f"s->{name}[{index}]" if isinstance(source, Cells) else f"{self.prefix}_{name}[{index}]"

    def called(self, call: Call, names: list[str], given: list[str]) -> list[str]:
        cells = ["s"] if call.program.cells else []
        text = f"{self.prefix}_{call.name}({', '.join([*cells, *given])})"
        if not any(map(self.is_read, call.results)):
            return [f"{text};"]
        if len(names) == 1:
            return [self.given(call.results[0], names[0], text)]
        several = self.name(Variable("real", f"of_{call.name}"))
        parts = [
            self.given(result, name, f"{several}.r{k}")
            for k, (result, name) in enumerate(zip(call.results, names, strict=True))
            if self.is_read(result)
        ]
        return [f"const {self.prefix}_{call.name}_results {several} = {text};", *parts]

    def whole_function(self) -> list[str]:
        program, name = self.program, f"{self.prefix}_{self.function}"
        cells = [f"{self.prefix}_state *s"] if program.cells else []
        given = ", ".join([*cells, *(f"{self.type_of(v)} {self.name(v)}" for v in program.parameters)])
        body = self.lines()
        results = [self.read(r, alone=True) for r in program.results]
        lines, kind = [*self.table_lines()], "void"
        if len(results) == 1:
            kind = self.type_of(Variable(program.results[0].kind))
            body.append(f"    return {results[0]};")
        elif results:
            kind = f"{name}_results"
            parts = " ".join(f"{self.type_of(Variable(r.kind))} r{k};" for k, r in enumerate(program.results))
            lines.append(f"typedef struct {{ {parts} }} {kind};")
            body += [f"    const {kind} results = {{ {', '.join(results)} }};", "    return results;"]
        return [*lines, f"static {kind} {name}({given or 'void'})", "{", *body, "}"]

    def counter(self) -> str:
        return "int32_t"

    def type_of(self, variable: Variable) -> str:
        """The type of a variable."""
        return {"real": self.real, "integer": "int32_t", "truth": "int"}[variable.kind]

    def table_lines(self) -> list[str]:
        """The tables of the program."""
        lines = []
        for table, name in self.tables().items():
            numbers = ", ".join(real_text(v, self.real) for v in table.values)
            head = f"static const {self.real} {self.prefix}_{name}[{len(table.values)}]"
            lines.append(f"{head} = {{ {numbers} }};")
        return lines


def real_text(value: float, real: Real) -> str:
    """A real number that C reads back to the last bit."""
    if real == "float":
        with np.errstate(over="ignore"):  # no limit is 1e300
            number = np.float32(value)
        return f"{_pointed(str(number))}f" if np.isfinite(number) else _endless(float(number), "f")
    return _pointed(repr(float(value))) if np.isfinite(value) else _endless(value, "")


def rest_lines(law: LawProgram, real: Real, seen: str, counts: str, memory: str) -> list[str]:
    """What a law remembers at rest, place by place, in C and in JavaScript; `counts` as a real number."""
    x = f"({counts} * {real_text(law.resolution, real)})" if law.resolution > 0 else seen

    def line(place: int, inside: bool) -> str:
        at, per = law.line(place, inside)
        return real_text(at, real) + (f" + {real_text(per, real)} * {x}" if per != 0.0 else "")

    return [f"    {memory}[{k}] = {value};" for k, value in enumerate(law.rest_texts(seen, line))]


def _pointed(text: str) -> str:
    """With a point or an exponent: 3 would be whole."""
    return text if "." in text or "e" in text else f"{text}.0"


def _endless(value: float, suffix: str) -> str:
    if value != value:
        return f"(0.0{suffix}/0.0{suffix})"
    one, zero = f"1.0{suffix}", f"0.0{suffix}"
    return f"(-{one}/{zero})" if value < 0 else f"({one}/{zero})"


NARROW = 2**15 - 1
"""The largest number of 16 bits."""

HELPERS = {
    "min integer": "static inline {word} {prefix}_least({word} a, {word} b) {{ return b < a ? b : a; }}",
    "max integer": "static inline {word} {prefix}_most({word} a, {word} b) {{ return b > a ? b : a; }}",
    "abs integer": "static inline {word} {prefix}_size({word} a) {{ return a < 0 ? -a : a; }}",
    "scaled_narrow": """\
/* n (high 2^16 + low) / 2^16, to the nearest, without numbers of 64 bits: they are slow on small chips */
static inline {word} {prefix}_scaled_narrow(int16_t n, int16_t high, int16_t low)
{{
    return (int32_t)n * high + (((int32_t)n * low + 32768L) >> 16);
}}""",
    "scaled": """\
/* n m / 2^k, to the nearest */
static inline {word} {prefix}_scaled({word} n, {word} m, int k)
{{
    return ({word})(((int64_t)n * m + ((int64_t)1 << (k - 1))) >> k);
}}""",
}

SHIFTS = """\
#if (-1 >> 1) != -1
#error "a shift to the right of a negative number does not round down here: emit the law in double or float"
#endif"""


@dataclass
class FixedC99(C99):
    """Writes whole numbers of `word` bits, 32 or 64; 16 bits hold the variables that are `narrow`."""

    word: int = 32
    narrow: frozenset[Variable] = frozenset()
    short: str = ""
    """Of what is given the name that has 16 bits; none where it has more."""

    SAID: ClassVar[Mapping[str, str]] = {
        **C99.SAID,
        "min integer": C99.SAID["min"],
        "max integer": C99.SAID["max"],
        "scaled": "{prefix}_scaled({}, {}, {})",
        "scaled_narrow": "{prefix}_scaled_narrow({}, {}, {})",
    }
    HELPERS: ClassVar[Mapping[str, str]] = HELPERS

    def words(self) -> dict[str, str]:
        return {**super().words(), "word": self.integer}

    @property
    def integer(self) -> str:
        """The type of a number."""
        return f"int{self.word}_t"

    def type_of(self, variable: Variable) -> str:
        return "int" if variable.kind == "truth" else self.integer

    def constant(self, constant: Constant) -> str:
        return self.constant_text(int(constant.value))

    def constant_text(self, value: int) -> str:
        """A whole number of its word."""
        return str(value) if abs(value) <= NARROW else f"{value}L" if self.word == 32 else f"{value}LL"

    def made(self, statement: Operation | Load) -> str:
        if isinstance(statement, Operation) and statement.operator in ("<<", ">>", "product", "scaled"):
            a, b = statement.operands[:2]
            if statement.operator == "product":
                return f"{self.factor(a)} * {self.factor(b, second=True)}"
            if statement.operator == "scaled":
                narrow = self.scaled_narrow(*statement.operands)
                if narrow is not None:
                    return narrow
                return self.operation("scaled", "", [self.read(o, alone=True) for o in statement.operands])
            if statement.operator == "<<":  # of a negative number it is not defined
                return f"{self.read(a)} * ({self.integer}){self.constant_text(1 << self._value(b))}"
            return f"{self.read(a)} >> {self.read(b)}"
        return super().made(statement)

    def scaled_narrow(self, n: Operand, by: Operand, shift: Operand) -> str | None:
        """The same where the number has 16 bits; None where it has more."""
        m = self._value(by)
        if not self.is_narrow(n) or self._value(shift) != 16 or abs(m) >= NARROW << 16:
            return None
        high = (m + NARROW + 1) >> 16  # so that both parts have 16 bits and a sign
        return self.operation("scaled_narrow", "", [self.shortened(n), str(high), str(m - (high << 16))])

    def _value(self, operand: Operand) -> int:
        assert isinstance(operand, Constant), "shifts are by known numbers"
        return int(operand.value)

    def is_narrow(self, operand: Operand) -> bool:
        """Whether 16 bits hold it."""
        if isinstance(operand, Constant):
            return abs(self._value(operand)) <= NARROW
        return operand in self.narrow or bool(self.short and operand in self.program.parameters)

    def shortened(self, operand: Operand) -> str:
        """It in 16 bits."""
        given = self.short and operand in self.program.parameters
        return self.short if given else f"(int16_t){self.read(operand)}"

    def factor(self, operand: Operand, second: bool = False) -> str:
        """A factor in 16 bits where that holds it: two such are multiplied by one instruction or few."""
        text = self.shortened(operand) if self.is_narrow(operand) else self.read(operand)
        return text if second else f"({self.integer}){text}"
