"""The same real function in fewer operations, for numbers that do not have the bits of double anyway.

    x/c → x (1/c)        (c₁ x) c₂ → x (c₁ c₂)        0 + x → x        x · 0 → 0        −(c x) → x (−c)

The bounds of the errors are found afterwards, of what is left.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field

from zwidth.machine.firmware.program import (
    Branch,
    Constant,
    Load,
    Operand,
    Operation,
    Program,
    Statement,
    Store,
    Variable,
    factor,
    operands,
    with_rule,
)

FOLDED = 2.0**-50
"""Relative: what a number of the law is off by after it was inverted or multiplied by others."""


def simplified(program: Program) -> Program:
    """A program without operations that real numbers do not need.

    Parameters
    ----------
    program
        As it was specialised; it stays as it is.
    """
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
