"""What an expression of a function is: a number that is known, or the variable that will hold it."""

from __future__ import annotations

import ast
import inspect
import math
from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from zwidth.firmware.arithmetic import applied, as_operand, converted, is_known, kind_of
from zwidth.firmware.program import Branch, Cells, Load, Operation, Statement, Table, Variable
from zwidth.firmware.source import Source, source_of
from zwidth.firmware.values import Changing, Unknown, joined, rebuilt

_BINARY: dict[type, str] = {
    ast.Add: "+",
    ast.Sub: "-",
    ast.Mult: "*",
    ast.Div: "/",
    ast.FloorDiv: "//",
    ast.Mod: "%",
    ast.Lt: "<",
    ast.LtE: "<=",
    ast.Eq: "==",
    ast.NotEq: "!=",
    ast.Gt: ">",
    ast.GtE: ">=",
}
_FUNCTIONS: dict[Any, str] = {
    abs: "abs",
    math.fabs: "abs",
    math.sqrt: "sqrt",
    np.sqrt: "sqrt",
    np.floor: "floor",
    float: "real",
    int: "integer",
}
_OF_REALS = {math.fabs, math.sqrt, np.sqrt, np.floor}
_BUILTIN = {"abs": abs, "min": min, "max": max, "float": float, "int": int, "range": range}
_MAY_FAIL = {"//", "%", "integer"}
"""What is not computed where Python would not: a divisor may be 0 there, a number too large."""

MOST_BITS = 31
"""Of a whole number's size: it is kept in 32."""


@dataclass
class Expressions(ABC):
    """Reads the expressions of one call.

    Parameters
    ----------
    source
        The function.
    names
        What each of its names stands for now.
    calls
        The functions that are being written out, this one last.
    """

    source: Source
    names: dict[str, Any]
    calls: tuple[Source, ...] = ()

    @abstractmethod
    def written_in_place(self, called: Source, names: dict[str, Any], block: list[Statement]) -> Any:
        """What a call gives back; its statements are written into the block."""

    def settled(self, node: ast.expr, block: list[Statement]) -> Any:
        """A value that stays as it is when a loop goes on."""
        held = {id(h.variable) for h in self.names.values() if isinstance(h, Changing)}
        return _copied(self.read(node, block), held, block)

    def read(self, node: ast.expr, block: list[Statement]) -> Any:
        """What an expression is."""
        if isinstance(node, ast.Constant) and isinstance(node.value, bool | int | float | None):
            return node.value
        if isinstance(node, ast.Name):
            return self.name(node)
        if isinstance(node, ast.Attribute):
            return self.attribute(node, block)
        if isinstance(node, ast.Tuple):
            return tuple(self.settled(e, block) for e in node.elts)
        if isinstance(node, ast.Subscript):
            return self.element(node, block)
        if isinstance(node, ast.BinOp):
            pair = self.read(node.left, block), self.read(node.right, block)
            return self.operate(node, pair, node.op, block)
        if isinstance(node, ast.UnaryOp):
            return self.unary(node, block)
        if isinstance(node, ast.Compare):
            return self.compare(node, block)
        if isinstance(node, ast.BoolOp):
            return self.conditions(node, block)
        if isinstance(node, ast.IfExp):
            return self.either(node, block)
        if isinstance(node, ast.Call):
            return self.call(node, block)
        raise self.source.refuse(node, f"{ast.unparse(node)} cannot be emitted")

    def name(self, node: ast.Name) -> Any:
        """What a name stands for: in the function, in its module, in Python."""
        if node.id in self.names:
            value = self.names[node.id]
            if isinstance(value, Unknown):
                raise self.source.refuse(node, f"{node.id} has no value on some way here")
            return value.variable if isinstance(value, Changing) else value
        if node.id in self.source.known:
            return self.source.known[node.id]
        if node.id in _BUILTIN:
            return _BUILTIN[node.id]
        raise self.source.refuse(node, f"{node.id} is not known here")

    def attribute(self, node: ast.Attribute, block: list[Statement]) -> Any:
        """A field of a record, or a name of a module."""
        held = self.read(node.value, block)
        if not (hasattr(held, "_fields") or inspect.ismodule(held)) or not hasattr(held, node.attr):
            raise self.source.refuse(node, f"{ast.unparse(node)} is in no record and no module")
        return getattr(held, node.attr)

    def place(self, node: ast.Subscript, size: int, block: list[Statement]) -> Any:
        """The index of an array or a tuple of this size."""
        index = self.read(node.slice, block) if not isinstance(node.slice, ast.Slice) else None
        if not isinstance(index, int | Variable) or kind_of(index) != "integer":
            raise self.source.refuse(node, f"{ast.unparse(node)}: an index is a whole number")
        if not isinstance(index, Variable) and not 0 <= index < size:
            raise self.source.refuse(node, f"{ast.unparse(node)}: there is no number at {index} of {size}")
        return index

    def element(self, node: ast.Subscript, block: list[Statement]) -> Any:
        """A number of an array or a tuple."""
        held = self.read(node.value, block)
        if isinstance(held, Cells):
            result = Variable("real")
            block.append(Load(result, held, as_operand(self.place(node, held.size, block))))
            return result
        if not isinstance(held, tuple | np.ndarray):
            raise self.source.refuse(node, f"{ast.unparse(node.value)} is no array and no tuple")
        index = self.place(node, len(held), block)
        if is_known(index):
            return held[index].item() if isinstance(held, np.ndarray) else held[index]
        if not all(is_known(v) and kind_of(v) == "real" for v in held):
            raise self.source.refuse(node, "an index that is not known goes into real numbers that are known")
        result = Variable("real")
        block.append(Load(result, Table("", tuple(float(v) for v in held)), as_operand(index)))
        return result

    def apply(self, node: ast.AST, name: str, values: tuple[Any, ...], block: list[Statement]) -> Any:
        """The result of an operator."""
        for value in values:
            if not (is_known(value) or isinstance(value, Variable)):
                raise self.source.refuse(node, "here stands what is no number")
            if is_known(value) and kind_of(value) == "integer" and int(value).bit_length() > MOST_BITS:
                raise self.source.refuse(node, f"{value} is no whole number of 32 bits")
        try:
            return applied(name, values, block)
        except (ArithmeticError, ValueError):
            text = ", ".join(str(v) for v in values)
            raise self.source.refuse(node, f"{name} of {text} has no value") from None

    def condition(self, value: Any, node: ast.AST, block: list[Statement]) -> Any:
        """True or false; a number holds where it is not 0."""
        if isinstance(value, tuple) or kind_of(value) == "truth":
            return value
        return self.apply(node, "!=", (value, 0.0 if kind_of(value) == "real" else 0), block)

    def operate(
        self, node: ast.AST, values: tuple[Any, Any], operator: ast.operator, block: list[Statement]
    ) -> Any:
        """A binary operator."""
        name = _BINARY.get(type(operator))
        if name is None:
            raise self.source.refuse(node, f"the operator {type(operator).__name__} cannot be emitted")
        if any(isinstance(v, tuple) or kind_of(v) == "truth" for v in values):
            raise self.source.refuse(node, "arithmetic is for numbers")
        if name == "//" and "real" in (kind_of(values[0]), kind_of(values[1])):
            if not is_known(values[1]) or values[1] != 1.0:
                raise self.source.refuse(node, "of real numbers // is emitted by 1.0 only, as the floor")
            return self.apply(node, "floor", (converted(values[0], "real", block),), block)
        if name in ("//", "%") and is_known(values[1]) and values[1] <= 0:
            raise self.source.refuse(node, "divisors of // and % are positive")
        return self.apply(node, name, values, block)

    def unary(self, node: ast.UnaryOp, block: list[Statement]) -> Any:
        """A sign, or `not`."""
        value = self.read(node.operand, block)
        if isinstance(node.op, ast.Not):
            return self.apply(node, "not", (self.condition(value, node, block),), block)
        if isinstance(node.op, ast.USub) and not isinstance(value, tuple) and kind_of(value) != "truth":
            return self.apply(node, "negate", (value,), block)
        raise self.source.refuse(node, f"{ast.unparse(node)} cannot be emitted")

    def compare(self, node: ast.Compare, block: list[Statement]) -> Any:
        """One comparison, or several in a row: the later ones only where the first hold."""

        def chain(k: int, left: Any, inner: list[Statement]) -> Any:
            right = self.settled(node.comparators[k], inner)
            one = self.comparison(node, left, node.ops[k], right, inner)
            if k + 1 == len(node.ops):
                return one
            return self.joined_tests(one, False, lambda b: chain(k + 1, right, b), node, inner)

        return chain(0, self.settled(node.left, block), block)

    def comparison(
        self, node: ast.AST, left: Any, operator: ast.cmpop, right: Any, block: list[Statement]
    ) -> Any:
        """One comparison of two numbers, or with None."""
        if isinstance(operator, ast.Is | ast.IsNot):
            return (left is right) == isinstance(operator, ast.Is)
        name = _BINARY.get(type(operator))
        if name is None or isinstance(left, tuple) or isinstance(right, tuple):
            raise self.source.refuse(node, "this comparison cannot be emitted")
        if (kind_of(left) == "truth") != (kind_of(right) == "truth"):
            raise self.source.refuse(node, "a condition is compared with a condition, a number with a number")
        return self.apply(node, name, (left, right), block)

    def conditions(self, node: ast.BoolOp, block: list[Statement]) -> Any:
        """`and`, `or`."""
        decides = isinstance(node.op, ast.Or)
        result = self.condition(self.read(node.values[0], block), node, block)
        for further in node.values[1:]:

            def one(b: list[Statement], further: ast.expr = further) -> Any:
                return self.condition(self.read(further, b), further, b)

            result = self.joined_tests(result, decides, one, node, block)
        return result

    def joined_tests(
        self,
        first: Any,
        decides: bool,
        second: Callable[[list[Statement]], Any],
        node: ast.AST,
        block: list[Statement],
    ) -> Any:
        """Two conditions; the second is not computed where the first decides, if that can be noticed."""
        if is_known(first):
            return first if bool(first) == decides else second(block)
        inner: list[Statement] = []
        further = second(inner)
        if all(_is_harmless(s) for s in inner):
            block += inner
            return self.apply(node, "or" if decides else "and", (first, further), block)
        made = Branch(as_operand(first))
        arms = (made.other, made.then) if decides else (made.then, made.other)
        arms[0].extend(inner)
        result = joined(further, decides, *arms, "", lambda what: self.source.refuse(node, what))
        block.append(made)
        return result

    def either(self, node: ast.IfExp, block: list[Statement]) -> Any:
        """`a if c else b`."""
        test = self.condition(self.read(node.test, block), node, block)
        if is_known(test):
            return self.read(node.body if test else node.orelse, block)
        made = Branch(as_operand(test))
        a, b = self.settled(node.body, made.then), self.settled(node.orelse, made.other)
        result = joined(a, b, made.then, made.other, "", lambda what: self.source.refuse(node, what))
        block.append(made)
        return result

    def call(self, node: ast.Call, block: list[Statement]) -> Any:
        """A function: an operator, a record, or one that is written out in place."""
        function = self.read(node.func, block)
        if any(isinstance(a, ast.Starred) for a in node.args) or any(k.arg is None for k in node.keywords):
            raise self.source.refuse(node, "arguments are given one by one")
        values = [self.settled(a, block) for a in node.args]
        named = {k.arg: self.settled(k.value, block) for k in node.keywords if k.arg}
        if hasattr(function, "_fields"):
            return function(*values, **named)
        if function in (min, max) or function in (math.floor, math.ceil) or function in _FUNCTIONS:
            return self.operator_call(node, function, values, block)
        if not inspect.isfunction(getattr(function, "py_func", function)):
            raise self.source.refuse(node, f"{ast.unparse(node.func)} cannot be emitted")
        called = source_of(function)
        if called in self.calls:
            raise self.source.refuse(node, f"{called.name} calls itself")
        given = dict(zip(called.arguments, values, strict=False)) | named
        if len(values) > len(called.arguments) or set(given) != set(called.arguments):
            raise self.source.refuse(node, f"{called.name} takes {', '.join(called.arguments)}: give each")
        return self.written_in_place(called, given, block)

    def operator_call(self, node: ast.Call, function: Any, values: list[Any], block: list[Statement]) -> Any:
        """A call that is an operator."""
        if any(isinstance(v, tuple) or v is None or kind_of(v) == "truth" for v in values) or not values:
            raise self.source.refuse(node, f"{ast.unparse(node.func)} is for numbers")
        if function in (min, max):
            result = values[0]
            for further in values[1:]:
                result = self.apply(node, function.__name__, (result, further), block)
            return result
        if len(values) > 1:
            raise self.source.refuse(node, f"{ast.unparse(node.func)} is for one number")
        value = values[0]
        if function in (math.floor, math.ceil):
            if kind_of(value) == "integer":
                return value
            whole = self.apply(node, "floor" if function is math.floor else "ceil", (value,), block)
            return self.apply(node, "integer", (whole,), block)
        if function in _OF_REALS or function is float:
            value = converted(value, "real", block)
        if function is float or (function is int and kind_of(value) == "integer"):
            return value
        return self.apply(node, _FUNCTIONS[function], (value,), block)


def _is_harmless(statement: Statement) -> bool:
    """Whether it may be computed also where its result is not asked for."""
    if isinstance(statement, Load):
        return not isinstance(statement.index, Variable)
    if not isinstance(statement, Operation) or statement.result.changes:
        return False
    return statement.operator not in _MAY_FAIL


def _copied(value: Any, held: set[int], block: list[Statement]) -> Any:
    """A value, with those of the variables that a loop is changing read now."""
    if isinstance(value, tuple):
        return rebuilt(value, [_copied(v, held, block) for v in value])
    if id(value) in held:
        result = Variable(value.kind)
        block.append(Operation(result, "copy", (value,)))
        return result
    return value
