"""What an expression of a function is: a number that is known, or the variable that will hold it."""

from __future__ import annotations

import ast
import math
from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from types import ModuleType, SimpleNamespace
from typing import Any

import numpy as np

from zwidth.machine.firmware.program import (
    OPERATORS,
    Branch,
    Cells,
    Load,
    Operation,
    Statement,
    Table,
    Variable,
)
from zwidth.machine.firmware.values import (
    Changing,
    Unknown,
    applied,
    as_operand,
    converted,
    each,
    is_known,
    joined,
    kind_of,
    record,
)
from zwidth.native.names import SPELLED, Attributes, Defined, Reader, floor

_FUNCTIONS: dict[Any, str] = {
    abs: "abs",
    min: "min",
    max: "max",
    math.fabs: "abs",
    math.sqrt: "sqrt",
    floor: "floor",
    math.floor: "floor",
    math.ceil: "ceil",
    float: "real",
    int: "integer",
}
_OF_REALS = {math.fabs, math.sqrt, floor, float}
_MAY_FAIL = {"//", "%", "integer"}
"""What is not computed where Python would not: a divisor may be 0 there, a number too large."""

MOST_BITS = 31
"""Of a whole number's size: it is kept in 32."""


@dataclass
class Expressions(Reader, ABC):
    """Reads the expressions of one call of the function `of`, and writes statements into `block`.

    `names` has what each name stands for now, `calls` the functions that are being written out, this one
    last.
    """

    of: Defined
    names: dict[str, Any]
    block: list[Statement]
    calls: tuple[Defined, ...] = ()

    @abstractmethod
    def written_in_place(self, called: Defined, names: dict[str, Any]) -> Any:
        """What a call gives back, written out."""

    def inside(self, block: list[Statement], write: Callable[[], Any]) -> Any:
        """What is found while it is written into another block."""
        before, self.block = self.block, block
        found = write()
        self.block = before
        return found

    def settled(self, node: ast.expr) -> Any:
        """A value that stays as it is when a loop goes on: what that is changing is read now."""
        held = {id(h.variable) for h in self.names.values() if isinstance(h, Changing)}

        def copied(value: Any) -> Any:
            if id(value) not in held:
                return value
            result = Variable(value.kind)
            self.block.append(Operation(result, "copy", (value,)))
            return result

        return each(self.read(node), copied)

    def read(self, node: ast.expr) -> Any:
        """What an expression is."""
        return self.method(node)(node)

    def _constant(self, node: ast.Constant) -> Any:
        if isinstance(node.value, bool | int | float | None):
            return node.value
        raise self.outside(node, f"{ast.unparse(node)} is no number")

    def _name(self, node: ast.Name) -> Any:
        """What a name stands for: in the function, in its module, in Python."""
        if node.id in self.names:
            value = self.names[node.id]
            if isinstance(value, Unknown):
                raise self.outside(node, f"{node.id} has no value on some way here")
            return value.variable if isinstance(value, Changing) else value
        found = self.module.told(node.id)
        if found is None:
            raise self.outside(node, f"{node.id} is not known here")
        return found

    def _attribute(self, node: ast.Attribute) -> Any:
        """A field of a record, or a name of a module."""
        held = self.read(node.value)
        is_one = hasattr(held, "_fields") or isinstance(held, Attributes | ModuleType | SimpleNamespace)
        if not is_one or not hasattr(held, node.attr):
            raise self.outside(node, f"{ast.unparse(node)} is not known here")
        return getattr(held, node.attr)

    def _tuple(self, node: ast.Tuple) -> Any:
        return tuple(self.settled(e) for e in node.elts)

    def place(self, node: ast.Subscript, size: int) -> Any:
        """The index of an array or a tuple of this size."""
        index = self.read(node.slice) if not isinstance(node.slice, ast.Slice) else None
        if not isinstance(index, int | Variable) or kind_of(index) != "integer":
            raise self.outside(node, f"{ast.unparse(node)}: an index is a whole number")
        if not isinstance(index, Variable) and not 0 <= index < size:
            raise self.outside(node, f"{ast.unparse(node)}: there is no number at {index} of {size}")
        return index

    def _subscript(self, node: ast.Subscript) -> Any:
        """A number of an array or a tuple."""
        held = self.read(node.value)
        if isinstance(held, Cells):
            return self.loaded(held, self.place(node, held.size))
        if not isinstance(held, tuple | np.ndarray):
            raise self.outside(node, f"{ast.unparse(node.value)} is no array and no tuple")
        index = self.place(node, len(held))
        if is_known(index):
            return held[index].item() if isinstance(held, np.ndarray) else held[index]
        if not all(is_known(v) and kind_of(v) == "real" for v in held):
            raise self.outside(node, "an index that is not known goes into real numbers that are known")
        return self.loaded(Table("", tuple(float(v) for v in held)), index)

    def loaded(self, held: Cells | Table, index: Any) -> Variable:
        """A number that is read when the program runs."""
        result = Variable("real")
        self.block.append(Load(result, held, as_operand(index)))
        return result

    def apply(self, node: ast.AST, name: str, *values: Any) -> Any:
        """The result of an operator."""
        for value in values:
            if not (is_known(value) or isinstance(value, Variable)):
                raise self.outside(node, "here stands what is no number")
            if is_known(value) and kind_of(value) == "integer" and int(value).bit_length() > MOST_BITS:
                raise self.outside(node, f"{value} is no whole number of 32 bits")
        try:
            return applied(name, values, self.block)
        except (ArithmeticError, ValueError):
            text = ", ".join(str(v) for v in values)
            raise self.outside(node, f"{name} of {text} has no value") from None

    def condition(self, node: ast.expr) -> Any:
        """True or false; a number holds where it is not 0."""
        value = self.read(node)
        if isinstance(value, tuple) or kind_of(value) == "truth":
            return value
        return self.apply(node, "!=", value, 0.0 if kind_of(value) == "real" else 0)

    def _binop(self, node: ast.BinOp) -> Any:
        return self.operate(node, self.read(node.left), node.op, self.read(node.right))

    def operate(self, node: ast.AST, left: Any, operator: ast.operator, right: Any) -> Any:
        """A binary operator."""
        name = SPELLED.get(type(operator))
        if name not in OPERATORS:
            raise self.outside(node, f"the operator {type(operator).__name__} cannot be emitted")
        if any(isinstance(v, tuple) or kind_of(v) == "truth" for v in (left, right)):
            raise self.outside(node, "arithmetic is for numbers")
        if name == "//" and "real" in (kind_of(left), kind_of(right)):
            if not is_known(right) or right != 1.0:
                raise self.outside(node, "of real numbers // is emitted by 1.0 only, as the floor")
            return self.apply(node, "floor", converted(left, "real", self.block))
        if name in ("//", "%") and is_known(right) and right <= 0:
            raise self.outside(node, "divisors of // and % are positive")
        return self.apply(node, name, left, right)

    def _unaryop(self, node: ast.UnaryOp) -> Any:
        """A sign, or `not`."""
        if isinstance(node.op, ast.Not):
            return self.apply(node, "not", self.condition(node.operand))
        value = self.read(node.operand)
        if isinstance(node.op, ast.USub) and not isinstance(value, tuple) and kind_of(value) != "truth":
            return self.apply(node, "negate", value)
        raise self.outside(node, f"{ast.unparse(node)} cannot be emitted")

    def _compare(self, node: ast.Compare) -> Any:
        """One comparison, or several in a row: the later ones only where the first hold."""

        def chain(k: int, left: Any) -> Any:
            right = self.settled(node.comparators[k])
            one = self.comparison(node, left, node.ops[k], right)
            if k + 1 == len(node.ops):
                return one
            return self.joined_tests(one, False, lambda: chain(k + 1, right), node)

        return chain(0, self.settled(node.left))

    def comparison(self, node: ast.AST, left: Any, operator: ast.cmpop, right: Any) -> Any:
        """One comparison of two numbers, or with None."""
        if isinstance(operator, ast.Is | ast.IsNot):
            return (left is right) == isinstance(operator, ast.Is)
        name = SPELLED.get(type(operator))
        if name is None or isinstance(left, tuple) or isinstance(right, tuple):
            raise self.outside(node, "this comparison cannot be emitted")
        if (kind_of(left) == "truth") != (kind_of(right) == "truth"):
            raise self.outside(node, "a condition is compared with a condition, a number with a number")
        return self.apply(node, name, left, right)

    def _boolop(self, node: ast.BoolOp) -> Any:
        """`and`, `or`."""
        decides = isinstance(node.op, ast.Or)
        result = self.condition(node.values[0])
        for further in node.values[1:]:
            result = self.joined_tests(result, decides, partial(self.condition, further), node)
        return result

    def joined_tests(self, first: Any, decides: bool, second: Callable[[], Any], node: ast.AST) -> Any:
        """Two conditions; the second is not computed where the first decides, if that can be noticed."""
        if is_known(first):
            return first if bool(first) == decides else second()
        inner: list[Statement] = []
        further = self.inside(inner, second)
        if all(_is_harmless(s) for s in inner):
            self.block += inner
            return self.apply(node, "or" if decides else "and", first, further)
        made = Branch(as_operand(first))
        arms = (made.other, made.then) if decides else (made.then, made.other)
        arms[0].extend(inner)
        result = joined(further, decides, *arms, "", partial(self.outside, node))
        self.block.append(made)
        return result

    def _ifexp(self, node: ast.IfExp) -> Any:
        """`a if c else b`."""
        test = self.condition(node.test)
        if is_known(test):
            return self.read(node.body if test else node.orelse)
        made = Branch(as_operand(test))
        a = self.inside(made.then, lambda: self.settled(node.body))
        b = self.inside(made.other, lambda: self.settled(node.orelse))
        result = joined(a, b, made.then, made.other, "", partial(self.outside, node))
        self.block.append(made)
        return result

    def _call(self, node: ast.Call) -> Any:
        """A function: an operator, a record, or one that is written out in place."""
        function = self.read(node.func)
        name = _FUNCTIONS.get(function) if callable(function) else None
        if not name and not isinstance(function, Defined):
            raise self.outside(node, f"{ast.unparse(node.func)} cannot be emitted")
        if any(isinstance(a, ast.Starred) for a in node.args) or any(k.arg is None for k in node.keywords):
            raise self.outside(node, "arguments are given one by one")
        values = [self.settled(a) for a in node.args]
        if name:
            return self.operator_call(node, function, name, values)
        named = {k.arg: self.settled(k.value) for k in node.keywords if k.arg}
        if isinstance(function.node, ast.ClassDef):
            return record(function)(*values, **named)
        if function in self.calls:
            raise self.outside(node, f"{function.node.name} calls itself")
        takes = [a.arg for a in function.takes()]
        given = dict(zip(takes, values, strict=False)) | named
        if len(values) > len(takes) or set(given) != set(takes):
            raise self.outside(node, f"{function.node.name} takes {', '.join(takes)}: give each")
        return self.written_in_place(function, given)

    def operator_call(self, node: ast.Call, function: Any, name: str, values: list[Any]) -> Any:
        """A call that is an operator."""
        if any(isinstance(v, tuple) or v is None or kind_of(v) == "truth" for v in values) or not values:
            raise self.outside(node, f"{ast.unparse(node.func)} is for numbers")
        value = values[0]
        if name in ("min", "max"):
            for further in values[1:]:
                value = self.apply(node, name, value, further)
            return value
        if len(values) > 1:
            raise self.outside(node, f"{ast.unparse(node.func)} is for one number")
        if function in (int, math.floor, math.ceil) and kind_of(value) == "integer":
            return value
        if function in _OF_REALS:
            value = converted(value, "real", self.block)
        if function is float:
            return value
        found = self.apply(node, name, value)
        return self.apply(node, "integer", found) if function in (math.floor, math.ceil) else found


def _is_harmless(statement: Statement) -> bool:
    """Whether it may be computed also where its result is not asked for."""
    if isinstance(statement, Load):
        return not isinstance(statement.index, Variable)
    if not isinstance(statement, Operation) or statement.result.changes:
        return False
    return statement.operator not in _MAY_FAIL
