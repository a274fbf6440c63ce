"""One operation: computed where its numbers are known, else written down.

Known numbers are computed as the compiled functions compute them: in double, a quotient by 0 is infinite.
"""

from __future__ import annotations

import math
import operator
from collections.abc import Callable
from typing import Any

import numpy as np

from zwidth.machine.firmware.program import Constant, Kind, Operand, Operation, Statement, Variable

Number = float | int | bool
Value = Number | Variable
"""Of a scalar: what is known of it, or the variable that holds it."""

_TESTS = {"<", "<=", "==", "!=", ">", ">=", "and", "or", "not"}


def _over(a: Number, b: Number) -> float:
    with np.errstate(all="ignore"):
        return float(np.float64(a) / np.float64(b))


_KNOWN: dict[str, Callable[..., Any]] = {
    "+": operator.add,
    "-": operator.sub,
    "*": operator.mul,
    "/": _over,
    "//": operator.floordiv,
    "%": operator.mod,
    "<": operator.lt,
    "<=": operator.le,
    "==": operator.eq,
    "!=": operator.ne,
    ">": operator.gt,
    ">=": operator.ge,
    "and": lambda a, b: a and b,
    "or": lambda a, b: a or b,
    "not": operator.not_,
    "negate": operator.neg,
    "abs": abs,
    "floor": lambda a: float(np.floor(a)),
    "ceil": lambda a: float(np.ceil(a)),
    "sqrt": lambda a: math.sqrt(a) if a >= 0 else math.nan,
    "min": lambda a, b: b if b < a else a,
    "max": lambda a, b: b if b > a else a,
    "select": lambda c, a, b: a if c else b,
    "real": float,
    "integer": int,
}


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
