"""A program on whole numbers without what changes nothing: copies, and sums with 0.

Only for whole numbers: in floating point 0 + y is not y where y is −0.
"""

from __future__ import annotations

from zwidth.machine.firmware.program import (
    Constant,
    Operand,
    Operation,
    Program,
    Statement,
    Variable,
    with_rule,
)


def tidied(program: Program) -> Program:
    """The same numbers from fewer statements.

    Parameters
    ----------
    program
        On whole numbers, without loops, as `fixed.lowered` gives it; it stays as it is.
    """
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
