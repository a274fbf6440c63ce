"""A program on whole numbers as C99."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

from zwidth.machine.firmware.c99 import C99
from zwidth.machine.firmware.program import Constant, Load, Operand, Operation, Variable

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
    """Writes whole numbers of 32 or 64 bits.

    Parameters
    ----------
    word
        Bits of a number.
    narrow
        Variables that 16 bits hold.
    """

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
