"""The same real function in fewer operations, for numbers that do not have the bits of double anyway.

    x/c → x (1/c)        (c₁ x) c₂ → x (c₁ c₂)        0 + x → x        x · 0 → 0        −(c x) → x (−c)

The bounds of the errors are found afterwards, of what is left.
"""

from __future__ import annotations

from collections import Counter
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
    blocks,
    operands,
    without_unused,
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
    kinds = (Operation, Load, Store, Set, Branch)
    if not all(isinstance(s, kinds) for s in program.statements()):
        return program  # with loops, whose numbers change, it is left as it is
    found: dict[Variable, Operand] = {}
    reads = Counter(o for s in program.statements() for o in operands(s) if isinstance(o, Variable))
    body = _block(program.body, found, {}, reads)
    results = tuple(_now(o, found) for o in program.results)
    return without_unused(replace(program, body=body, results=results))


def _now(operand: Operand, found: dict[Variable, Operand]) -> Operand:
    return found.get(operand, operand) if isinstance(operand, Variable) else operand


def _block(
    block: list[Statement],
    found: dict[Variable, Operand],
    factors: dict[Variable, tuple[Operand, float]],
    reads: Counter[Variable],
) -> list[Statement]:
    out: list[Statement] = []
    for s in block:
        if isinstance(s, Operation):
            _operation(s, found, factors, reads, out)
        elif isinstance(s, Store):
            out.append(Store(s.target, _now(s.index, found), _now(s.value, found)))
        elif isinstance(s, Set):
            out.append(Set(s.variable, _now(s.value, found)))
        elif isinstance(s, Branch):
            then, other = (_block(b, found, factors, reads) for b in blocks(s))
            out.append(Branch(_now(s.test, found), then, other))
        elif isinstance(s, Load):
            out.append(Load(s.result, s.source, _now(s.index, found)))
    return out


def _operation(
    s: Operation,
    found: dict[Variable, Operand],
    factors: dict[Variable, tuple[Operand, float]],
    reads: Counter[Variable],
    out: list[Statement],
) -> None:
    of = tuple(_now(o, found) for o in s.operands)
    if s.result.kind != "real" or s.operator not in ("+", "-", "*", "/", "negate"):
        out.append(Operation(s.result, s.operator, of))
        return
    a, b = of[0], of[-1]
    once = reads[s.result] == 1  # what is read further on may be known better by then
    if s.operator == "+" and _is(a, 0.0) and not _changes(b):
        found[s.result] = b
    elif s.operator in ("+", "-") and _is(b, 0.0) and not _changes(a):
        found[s.result] = a
    elif s.operator == "*" and (_is(a, 0.0) or _is(b, 0.0)):
        found[s.result] = Constant(0.0, "real")
    elif s.operator == "negate" or (s.operator == "-" and _is(a, 0.0)):
        _scale(s, b, -1.0, factors, out, once)
    elif s.operator == "*" and isinstance(a, Constant):
        _scale(s, b, float(a.value), factors, out, once)
    elif s.operator == "*" and isinstance(b, Constant):
        _scale(s, a, float(b.value), factors, out, once)
    elif s.operator == "/" and isinstance(b, Constant) and b.value:
        _scale(s, a, 1.0 / float(b.value), factors, out, once)
    else:
        out.append(Operation(s.result, s.operator, of))


def _scale(
    s: Operation,
    x: Operand,
    by: float,
    factors: dict[Variable, tuple[Operand, float]],
    out: list[Statement],
    once: bool,
) -> None:
    """A product with a known number, with those before it; what is then not read any more is swept out."""
    if isinstance(x, Variable) and x in factors:
        inner, before = factors[x]
        x, by = inner, by * before
    if not _changes(x) and once:
        factors[s.result] = (x, by)
    out.append(Operation(s.result, "*", (Constant(by, "real"), x)))


def _changes(operand: Operand) -> bool:
    """Whether it may be another number further on."""
    return isinstance(operand, Variable) and operand.changes


def _is(operand: Operand, value: float) -> bool:
    return isinstance(operand, Constant) and operand.kind == "real" and float(operand.value) == value
