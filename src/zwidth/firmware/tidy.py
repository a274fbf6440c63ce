"""A program on whole numbers without what changes nothing: copies, and sums with 0.

Only for whole numbers: in floating point 0 + y is not y where y is −0.
"""

from __future__ import annotations

from dataclasses import replace

from zwidth.firmware.program import (
    Branch,
    Constant,
    Load,
    Operand,
    Operation,
    Program,
    Set,
    Statement,
    Store,
    Variable,
    without_unused,
)


def tidied(program: Program) -> Program:
    """The same numbers from fewer statements.

    Parameters
    ----------
    program
        On whole numbers, without loops, as `fixed.lowered` gives it; it stays as it is.
    """
    same: dict[Variable, Operand] = {}
    body = _block(program.body, same)
    results = tuple(_read(r, same) for r in program.results)
    return without_unused(Program(program.parameters, program.cells, body, results))


def _block(block: list[Statement], same: dict[Variable, Operand]) -> list[Statement]:
    out: list[Statement] = []
    for s in block:
        if isinstance(s, Operation):
            of = tuple(_read(o, same) for o in s.operands)
            left = _same_as(s.operator, of)
            if left is None:
                out.append(replace(s, operands=of))
            else:
                same[s.result] = left
        elif isinstance(s, Load):
            out.append(s)
        elif isinstance(s, Store | Set):
            out.append(replace(s, value=_read(s.value, same)))
        else:
            assert isinstance(s, Branch), "fixed point has no loops"
            out.append(Branch(_read(s.test, same), _block(s.then, same), _block(s.other, same)))
    return out


def _read(operand: Operand, same: dict[Variable, Operand]) -> Operand:
    return same.get(operand, operand) if isinstance(operand, Variable) else operand


def _same_as(operator: str, of: tuple[Operand, ...]) -> Operand | None:
    """The operand that the operation gives back; None where it does more, or what it copies may change."""
    left: Operand | None = None
    if operator == "copy" or (operator in ("+", "-") and of[1] == _ZERO):
        left = of[0]
    elif operator == "+" and of[0] == _ZERO:
        left = of[1]
    return None if isinstance(left, Variable) and left.changes else left


_ZERO = Constant(0, "integer")
