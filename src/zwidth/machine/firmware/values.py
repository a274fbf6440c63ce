"""What a name may stand for while a function is read, and what operators make of such values.

Known numbers are computed as the compiled functions compute them: in double, a quotient by 0 is infinite.
An operation on others is written down, as is the call of a function that stands apart."""

from __future__ import annotations

import math
import operator
from collections import namedtuple
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cache
from itertools import compress
from typing import Any

import numpy as np

from zwidth.machine.firmware.program import (
    Call,
    Cells,
    Constant,
    Kind,
    Operand,
    Operation,
    Program,
    Statement,
    Variable,
    operands,
    set_to,
    without_unused,
)
from zwidth.native.names import Defined
from zwidth.native.types import fields


@dataclass(eq=False)
class Changing:
    """A name that a loop changes: its variable keeps its place."""

    variable: Variable


@dataclass(eq=False)
class Unknown:
    """A name that only one branch has given: it cannot be read."""


@cache
def record(of: Defined) -> Any:
    """The class of a named tuple."""
    return namedtuple(of.node.name, fields(of).names)


def flat(value: Any) -> list[Any]:
    """The numbers of a tuple, and of those inside it; of one number that alone, of None none."""
    if value is None:
        return []
    return [x for part in value for x in flat(part)] if isinstance(value, tuple) else [value]


def rebuilt(like: Any, parts: list[Any]) -> Any:
    """A tuple, or a record, of the same kind with other parts."""
    return type(like)(*parts) if hasattr(like, "_fields") else tuple(parts)


def each(value: Any, of: Callable[[Any], Any]) -> Any:
    """What is made of a number, or of each of a tuple and of those inside it; of None nothing."""
    if isinstance(value, tuple):
        return rebuilt(value, [each(part, of) for part in value])
    return None if value is None else of(value)


def same(a: Any, b: Any) -> bool:
    """Whether two values are known to be one."""
    if a is b:
        return True
    if isinstance(a, tuple) and isinstance(b, tuple) and len(a) == len(b):
        return all(same(x, y) for x, y in zip(a, b, strict=True))
    plain = (bool, int, float)
    if isinstance(a, plain) and isinstance(b, plain) and type(a) is type(b):
        return a == b and str(a) == str(b)  # -0.0 is another number
    return isinstance(a, Cells) and a == b


def joined(
    a: Any,
    b: Any,
    first: list[Statement],
    second: list[Statement],
    hint: str,
    refuse: Callable[[str], Exception],
) -> Any:
    """What is one thing at the end of one block and another at the end of the other."""
    if same(a, b):
        return a
    if isinstance(a, Unknown) or isinstance(b, Unknown):
        return Unknown()
    if isinstance(a, tuple) and isinstance(b, tuple) and len(a) == len(b):
        parts = [joined(x, y, first, second, hint, refuse) for x, y in zip(a, b, strict=True)]
        return rebuilt(a, parts)
    if not all(isinstance(v, bool | int | float | Variable) for v in (a, b)):
        raise refuse(f"{hint} is a number on one way and something else on the other")
    kinds = {kind_of(a), kind_of(b)}
    kind = kinds.pop() if len(kinds) == 1 else "real"
    if kinds and "truth" in kinds:
        raise refuse(f"{hint} is a truth on one way and a number on the other")
    variable = Variable(kind, hint, changes=True)
    first.append(set_to(variable, as_operand(converted(a, kind, first))))
    second.append(set_to(variable, as_operand(converted(b, kind, second))))
    return variable


def set_all(variables: Any, value: Any, block: list[Statement], refuse: Callable[[str], Exception]) -> None:
    """Set such variables."""
    if isinstance(variables, tuple) and isinstance(value, tuple) and len(variables) == len(value):
        for one, part in zip(variables, value, strict=True):
            set_all(one, part, block, refuse)
    elif isinstance(variables, Variable) and isinstance(value, bool | int | float | Variable):
        value = converted(value, variables.kind, block)
        if kind_of(value) != variables.kind:
            raise refuse("a function returns numbers of one kind: write 0.0 for a real 0")
        block.append(set_to(variables, as_operand(value)))
    elif variables is not None or value is not None:
        raise refuse("a function returns as many numbers on every way")


Number = float | int | bool
Value = Number | Variable
"""Of a scalar: what is known of it, or the variable that holds it."""

_TESTS = {"<", "<=", "==", "!=", ">", ">=", "and", "or", "not"}


def _over(a: Number, b: Number) -> float:
    with np.errstate(all="ignore"):
        return float(np.float64(a) / np.float64(b))


_KNOWN: dict[str, Callable[..., Any]] = {
    "+": operator.add, "-": operator.sub, "*": operator.mul, "/": _over, "//": operator.floordiv,
    "%": operator.mod, "<": operator.lt, "<=": operator.le, "==": operator.eq, "!=": operator.ne,
    ">": operator.gt, ">=": operator.ge, "and": lambda a, b: a and b, "or": lambda a, b: a or b,
    "not": operator.not_, "negate": operator.neg, "abs": abs, "real": float, "integer": int,
    "floor": lambda a: float(np.floor(a)), "ceil": lambda a: float(np.ceil(a)),
    "sqrt": lambda a: math.sqrt(a) if a >= 0 else math.nan,
    "min": lambda a, b: b if b < a else a, "max": lambda a, b: b if b > a else a,
    "select": lambda c, a, b: a if c else b,
}  # fmt: skip


def is_known(value: Any) -> bool:
    """True of a number whose value is known."""
    return isinstance(value, bool | int | float | np.floating | np.integer)


def kind_of(value: Value) -> Kind:
    """Real, integer or truth."""
    if isinstance(value, Variable):
        return value.kind
    if isinstance(value, bool | np.bool_):
        return "truth"
    return "integer" if isinstance(value, int | np.integer) else "real"


def as_operand(value: Value) -> Operand:
    """As a program holds it."""
    if isinstance(value, Variable):
        return value
    kind = kind_of(value)
    return Constant({"truth": bool, "integer": int, "real": float}[kind](value), kind)


def converted(value: Value, kind: Kind, block: list[Statement]) -> Value:
    """An integer where a real number is wanted."""
    if kind == "real" and kind_of(value) == "integer":
        return applied("real", (value,), block)
    return value


def applied(name: str, values: tuple[Value, ...], block: list[Statement]) -> Value:
    """The result of an operator of `program.OPERATORS`; written into the block where not all is known."""
    if name == "/" or (name not in ("real", "integer", "select") and _mixed(values)):
        values = tuple(converted(v, "real", block) for v in values)
    if all(is_known(v) for v in values):
        return _KNOWN[name](*values)  # type: ignore[no-any-return]
    short = _without(name, values)
    if short is not None:
        return short
    result = Variable(_kind(name, values))
    block.append(Operation(result, name, tuple(as_operand(v) for v in values)))
    return result


def _mixed(values: tuple[Value, ...]) -> bool:
    return {"real", "integer"} <= {kind_of(v) for v in values}


def _without(name: str, values: tuple[Value, ...]) -> Value | None:
    """What needs no operation, to the last bit: conditions half known, n + 0, x · 1 and x/1."""
    known = [v for v in values if is_known(v)]
    if name in ("and", "or") and known:
        decides = name == "or"
        rest = next(v for v in values if not is_known(v))
        return decides if bool(known[0]) == decides else rest
    if name == "select" and is_known(values[0]):
        return values[1] if values[0] else values[2]
    if len(values) == 2 and kind_of(values[0]) == "integer" and name in "+-" and values[1] == 0:
        return values[0]
    if name == "+" and kind_of(values[1]) == "integer" and is_known(values[0]) and values[0] == 0:
        return values[1]
    if name in ("*", "/") and is_known(values[1]) and values[1] == 1:
        return values[0]
    if name == "*" and is_known(values[0]) and values[0] == 1:
        return values[1]
    return None


def _kind(name: str, values: tuple[Value, ...]) -> Kind:
    if name in _TESTS:
        return "truth"
    if name in ("real", "integer"):
        return "real" if name == "real" else "integer"
    return kind_of(values[-1])


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
