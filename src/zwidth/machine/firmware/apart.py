"""Functions that stand apart in a program, because they would be written out at many places."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from itertools import compress
from typing import Any

from zwidth.machine.firmware.arithmetic import as_operand, is_known, kind_of
from zwidth.machine.firmware.program import (
    Call,
    Cells,
    Operand,
    Program,
    Statement,
    Variable,
    operands,
    without_unused,
)
from zwidth.machine.firmware.values import each, flat, rebuilt
from zwidth.native.names import Defined

Write = Callable[[dict[str, Any], list[Statement]], Any]
"""Writes a function, given what its arguments stand for, into a block: what it gives back."""


@dataclass
class Apart:
    """Which functions stand apart, and those that have been written.

    Of their arguments numbers become parameters; what is known inside of a record stays known.
    """

    sources: frozenset[Defined] = frozenset()
    written: dict[Any, tuple[str, Program, tuple[bool, ...], Any]] = field(default_factory=dict)
    """By what is known of the arguments: name, program, which parameters it reads, what it gives back."""

    def call(self, source: Defined, names: dict[str, Any], write: Write, block: list[Statement]) -> Any:
        """Call one, written now if it has not been."""
        inner: dict[str, Any] = {}
        parameters: list[Variable] = []
        arguments: list[Operand] = []
        keys: list[Any] = [source]
        for name, value in names.items():
            inner[name] = _taken(value, name, True, parameters, arguments, keys)
        key = tuple(keys)
        if key not in self.written:
            body: list[Statement] = []
            value = write(inner, body)
            cells = tuple(c for c in inner.values() if isinstance(c, Cells))
            whole = Program(tuple(parameters), cells, body, tuple(as_operand(v) for v in flat(value)))
            program = without_unused(whole)
            read = {o for s in program.statements() for o in operands(s)} | set(program.results)
            asked = tuple(p in read for p in parameters)
            program.parameters = tuple(compress(parameters, asked))
            again = sum(1 for k in self.written if k[0] == source)
            name = source.node.name.strip("_") + (f"_{again + 1}" if again else "")
            self.written[key] = name, program, asked, value
        name, program, asked, value = self.written[key]
        results = each(value, lambda v: Variable(kind_of(v)))
        block.append(Call(tuple(flat(results)), name, program, tuple(compress(arguments, asked))))
        return results


def _taken(
    value: Any, name: str, whole: bool, parameters: list[Variable], arguments: list[Operand], keys: list[Any]
) -> Any:
    """What an argument is inside; `whole` for one that is no part of a record."""
    if isinstance(value, tuple):
        keys.append((type(value), len(value)))
        fields = getattr(value, "_fields", range(len(value)))
        named = zip(fields, value, strict=True)
        parts = [_taken(v, f"{name}_{of}", False, parameters, arguments, keys) for of, v in named]
        return rebuilt(value, parts)
    number = isinstance(value, Variable) or (is_known(value) and whole)
    if not number:
        keys.append((type(value), repr(value)) if is_known(value) or isinstance(value, Cells) else id(value))
        return value
    keys.append(kind_of(value))
    parameter = Variable(kind_of(value), name)
    parameters.append(parameter)
    arguments.append(as_operand(value))
    return parameter
