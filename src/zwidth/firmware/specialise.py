"""From a step function and what is known of its arguments to a program.

What depends on known numbers alone is computed; calls are written out in place; the rest becomes the program.
So a wall of one stiffness is three operations, not the interpreter of all laws.

The subset of Python: numbers, their operators, `min`, `max`, `abs`, `float`, `int`, functions of `math` that are
correctly rounded, arrays of float64 read and written one number at a time, tuples and named tuples, `if`,
`for … in range(…)`, `while`, `break`, `continue`, `return`, and calls of functions of the same subset.
"""

from __future__ import annotations

import ast
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from zwidth.firmware.arithmetic import applied, as_operand, converted, is_known, kind_of
from zwidth.firmware.program import (
    Branch,
    Cells,
    Constant,
    Count,
    Leave,
    Load,
    Operation,
    Program,
    Set,
    Statement,
    Store,
    Table,
    Variable,
    While,
    without_unused,
)
from zwidth.firmware.source import Source, source_of
from zwidth.firmware.values import Changing, Unknown, joined, rebuilt

MOST_WRITTEN_OUT = 32
"""Passes of a loop that are written one after the other; a longer one stays a loop."""

_BINARY = {
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


def specialised(function: Callable[..., Any], arguments: Sequence[Any]) -> Program:
    """A program of one function.

    Parameters
    ----------
    function
        A step function.
    arguments
        Of each argument: a number, an array or a tuple that is known; `Cells` for an array that is changed;
        a `Variable` for a number that is given at every call.

    Raises
    ------
    InputError
        If something in it, or in what it calls, is outside the subset; with file and line.
    """
    source = source_of(function)
    body: list[Statement] = []
    writer = _Writer(source, dict(zip(_names(source), arguments, strict=True)))
    writer.run(source.tree.body, body)
    value = writer.value(body)
    results = value if isinstance(value, tuple) else (() if value is None else (value,))
    parameters = tuple(a for a in _flat(arguments) if isinstance(a, Variable))
    cells = tuple(a for a in arguments if isinstance(a, Cells))
    return without_unused(Program(parameters, cells, body, tuple(as_operand(r) for r in results)))


def _flat(arguments: Sequence[Any]) -> list[Any]:
    return [x for a in arguments for x in (_flat(a) if isinstance(a, tuple) else [a])]


def _names(source: Source) -> list[str]:
    return [a.arg for a in source.tree.args.args]


@dataclass
class _EndOfLoop(ast.stmt):
    """Where `break` of a loop that is written out goes on."""


@dataclass
class _NextPass(ast.stmt):
    """Where `continue` of it goes on; and what the counter then is."""

    target: ast.Name
    value: Any


@dataclass
class _Exits:
    """Loops that stay loops, in one function: how `return` gets out of them."""

    depth: int = 0
    done: Variable | None = None


_FELL, _OVER = False, True
"""Whether a block goes on behind its end; or has returned, or left its loop, on every way."""


@dataclass
class _Writer:
    """One call of a function."""

    source: Source
    names: dict[str, Any]
    results: list[Any] = field(default_factory=list)
    returned: Any = None
    nested: int = 0
    exits: _Exits = field(default_factory=_Exits)

    # ---- what a call gives back

    def value(self, block: list[Statement]) -> Any:
        """What the function has returned."""
        return self.returned

    def give_back(self, value: Any, node: ast.AST, block: list[Statement]) -> None:
        """A `return`: at once where it is the only one, else through variables that every way sets."""
        if self.nested == 0:
            self.returned = value
            return
        if self.returned is None:
            self.returned = _variables_like(value, self.source.name)
        _set_all(self.returned, value, block, lambda what: self.source.refuse(node, what))
        if self.exits.depth:
            assert self.exits.done is not None
            block.append(Set(self.exits.done, Constant(True, "truth")))
            block.append(Leave())

    # ---- statements

    def run(self, todo: Sequence[ast.stmt], block: list[Statement]) -> bool:
        """Write statements; those behind a branch that may end the function go into the branch."""
        todo = list(todo)
        while todo:
            node = todo.pop(0)
            if isinstance(node, _EndOfLoop):
                continue
            if isinstance(node, _NextPass):
                self.bind(node.target, node.value, block)
            elif isinstance(node, ast.Return):
                value = None if node.value is None else self.settled(node.value, block)
                self.give_back(value, node, block)
                return _OVER
            elif isinstance(node, ast.Break | ast.Continue):
                rest = _behind(todo, isinstance(node, ast.Break))
                if rest is None:  # of a loop that stays one
                    if isinstance(node, ast.Break):
                        block.append(Leave())
                    return _OVER
                todo = rest
            elif isinstance(node, ast.If):
                over = self.branch(node, todo, block)
                if over is not None:
                    return over
            elif isinstance(node, ast.For):
                written = self.written_out(node, block)
                if written is not None:
                    todo = written + todo
                elif self.count(node, block) and self.exits.done is not None:
                    return self.unless_done(node, todo, block)
            elif isinstance(node, ast.While):
                if self.while_loop(node, block) and self.exits.done is not None:
                    return self.unless_done(node, todo, block)
            else:
                self.simple(node, block)
        return _FELL

    def simple(self, node: ast.stmt, block: list[Statement]) -> None:
        """A statement without others inside."""
        if isinstance(node, ast.Assign):
            value = self.settled(node.value, block)
            for target in node.targets:
                self.bind(target, value, block)
        elif isinstance(node, ast.AnnAssign) and node.value is not None:
            self.bind(node.target, self.settled(node.value, block), block)
        elif isinstance(node, ast.AugAssign):
            before = self.read(node.target, block)
            after = self.operate(node, (before, self.read(node.value, block)), node.op, block)
            self.bind(node.target, after, block)
        elif isinstance(node, ast.Expr):
            if not isinstance(node.value, ast.Constant):
                self.read(node.value, block)
        elif not isinstance(node, ast.Pass):
            raise self.source.refuse(node, f"{type(node).__name__.lower()} cannot be emitted")

    def bind(self, target: ast.expr, value: Any, block: list[Statement]) -> None:
        """Give a name, a place of an array, or several of them their value."""
        if isinstance(target, ast.Tuple):
            if not isinstance(value, tuple) or len(value) != len(target.elts):
                raise self.source.refuse(target, "the two sides are of different length")
            for one, part in zip(target.elts, value, strict=True):
                self.bind(one, part, block)
        elif isinstance(target, ast.Name):
            held = self.names.get(target.id)
            if isinstance(held, Changing):
                self.change(held, value, target, block)
                return
            if isinstance(value, Variable) and not value.hint:
                value.hint = target.id
            self.names[target.id] = value
        elif isinstance(target, ast.Subscript):
            cells, index = self.read(target.value, block), self.read(target.slice, block)
            if not isinstance(cells, Cells):
                raise self.source.refuse(target, "only what is remembered can be changed")
            block.append(Store(cells, as_operand(index), as_operand(converted(value, "real", block))))
        else:
            raise self.source.refuse(target, "this cannot be given a value")

    def change(self, held: Changing, value: Any, node: ast.AST, block: list[Statement]) -> None:
        """Set a variable that a loop changes."""
        value = converted(value, held.variable.kind, block)
        if kind_of(value) != held.variable.kind:
            raise self.source.refuse(
                node, f"{held.variable.hint} is whole first and then a real number: write 0.0"
            )
        block.append(Set(held.variable, as_operand(value)))

    # ---- branches

    def branch(self, node: ast.If, todo: list[ast.stmt], block: list[Statement]) -> bool | None:
        """An `if`; None where what follows is still to be written."""
        test = self.read(node.test, block)
        if is_known(test):
            todo[:0] = node.body if test else node.orelse
            return None
        if not (_may_leave(node.body) or _may_leave(node.orelse)):
            self.both(test, lambda w, b: w.run(node.body, b), lambda w, b: w.run(node.orelse, b), node, block)
            return None
        rest = list(todo)
        return self.both(
            test,
            lambda w, b: w.run([*node.body, *rest], b),
            lambda w, b: w.run([*node.orelse, *rest], b),
            node,
            block,
        )

    def both(
        self,
        test: Any,
        then: Callable[[_Writer, list[Statement]], bool],
        other: Callable[[_Writer, list[Statement]], bool],
        node: ast.AST,
        block: list[Statement],
    ) -> bool:
        """Write two blocks behind a test and join what they gave the names."""
        made = Branch(as_operand(test))
        before = dict(self.names)
        self.nested += 1
        over = [then(self, made.then)]
        first, self.names = self.names, dict(before)
        over.append(other(self, made.other))
        second = self.names
        self.nested -= 1
        block.append(made)
        if all(over):
            self.names = before
            return _OVER
        if any(over):
            self.names = second if over[0] else first
            return _FELL
        self.names = {
            name: joined(
                first.get(name, Unknown()),
                second.get(name, Unknown()),
                made.then,
                made.other,
                name,
                lambda what: self.source.refuse(node, what),
            )
            for name in dict.fromkeys([*first, *second])
        }
        return _FELL

    # ---- loops

    def written_out(self, node: ast.For, block: list[Statement]) -> list[ast.stmt] | None:
        """The passes of a short loop with a known count, one after the other; None of any other."""
        values = self.passes(node, block)
        if values is None or not isinstance(node.target, ast.Name):
            return None
        over_numbers = isinstance(node.iter, ast.Tuple)
        if not over_numbers and (
            len(values) > MOST_WRITTEN_OUT or (_may_leave(node.body) and len(values) > 2)
        ):
            return None
        out: list[ast.stmt] = []
        for value in values:
            out += [_NextPass(node.target, value), *node.body]
        return [*out, _EndOfLoop()]

    def passes(self, node: ast.For, block: list[Statement]) -> list[Any] | None:
        """What the counter will be, where that is known."""
        if isinstance(node.iter, ast.Tuple):
            return [self.settled(e, block) for e in node.iter.elts]
        bounds = self.bounds(node, block)
        return list(range(*bounds)) if all(is_known(b) for b in bounds) else None

    def bounds(self, node: ast.For, block: list[Statement]) -> tuple[Any, Any, Any]:
        """Start, stop and step of a range."""
        call = node.iter
        if not (isinstance(call, ast.Call) and isinstance(call.func, ast.Name) and call.func.id == "range"):
            raise self.source.refuse(node, "a loop goes over range(…)")
        given = [self.read(a, block) for a in call.args]
        start, stop = (0, given[0]) if len(given) == 1 else given[:2]
        return start, stop, given[2] if len(given) == 3 else 1

    def count(self, node: ast.For, block: list[Statement]) -> bool:
        """A loop that stays one; True where it may return from the function."""
        start, stop, step = self.bounds(node, block)
        if not is_known(step) or not isinstance(node.target, ast.Name):
            raise self.source.refuse(node, "the step of a range is known")
        self.hold(node.body, block)
        counter = Variable("integer", node.target.id, changes=True)
        made = Count(counter, as_operand(start), as_operand(stop), int(step))
        self.inside(node, made.body, {node.target.id: counter}, block)
        block.append(made)
        self.leave_further(block)
        return _returns(node.body)

    def while_loop(self, node: ast.While, block: list[Statement]) -> bool:
        """A loop that stays one; True where it may return from the function."""
        self.hold(node.body, block)
        made = While()
        made.test = as_operand(self.read(node.test, made.before))
        self.inside(node, made.body, {}, block)
        block.append(made)
        self.leave_further(block)
        return _returns(node.body)

    def hold(self, body: list[ast.stmt], block: list[Statement]) -> None:
        """What the body changes gets a variable before the loop."""
        for name in _assigned(body):
            value = self.names.get(name)
            if value is None or isinstance(value, Changing | Unknown):
                continue
            if not isinstance(value, bool | int | float | Variable):
                raise self.source.refuse(body[0], f"{name} is no number, and a loop changes it")
            variable = Variable(kind_of(value), name, changes=True)
            block.append(Set(variable, as_operand(value)))
            self.names[name] = Changing(variable)

    def inside(
        self, node: ast.For | ast.While, body: list[Statement], more: dict[str, Any], block: list[Statement]
    ) -> None:
        """The body of a loop."""
        if _returns(node.body) and self.exits.done is None:
            self.exits.done = Variable("truth", "done", changes=True)
            block.append(Set(self.exits.done, Constant(False, "truth")))
        before = dict(self.names)
        self.names |= more
        self.nested += 1
        self.exits.depth += 1
        self.run(node.body, body)
        self.exits.depth -= 1
        self.nested -= 1
        # what the body gave a name for the first time is not there where it runs no time
        self.names = {name: before.get(name, Unknown()) for name in dict.fromkeys([*before, *self.names])}

    def leave_further(self, block: list[Statement]) -> None:
        """Behind a loop inside another: out of that too, where the function has returned."""
        if self.exits.depth and self.exits.done is not None:
            block.append(Branch(self.exits.done, [Leave()]))

    def unless_done(self, node: ast.stmt, todo: list[ast.stmt], block: list[Statement]) -> bool:
        """What follows a loop that may have returned."""
        if self.exits.depth:
            return self.run(todo, block)
        done, self.exits.done = self.exits.done, None
        return self.both(done, lambda w, b: _OVER, lambda w, b: w.run(todo, b), node, block)

    # ---- expressions

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
            return getattr(self.read(node.value, block), node.attr)
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
            return self.truth(node, block)
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
        builtin = {"abs": abs, "min": min, "max": max, "float": float, "int": int, "bool": bool}
        if node.id in builtin:
            return builtin[node.id]
        raise self.source.refuse(node, f"{node.id} is not known here")

    def element(self, node: ast.Subscript, block: list[Statement]) -> Any:
        """A number of an array or a tuple."""
        held, index = self.read(node.value, block), self.read(node.slice, block)
        if isinstance(held, Cells):
            result = Variable("real")
            block.append(Load(result, held, as_operand(index)))
            return result
        if is_known(index):
            part = held[index]
            return float(part) if isinstance(held, np.ndarray) else part
        if not all(is_known(v) for v in held):
            raise self.source.refuse(node, "which of these numbers it is, is not known")
        result = Variable("real")
        table = Table("", tuple(float(v) for v in held))
        block.append(Load(result, table, as_operand(index)))
        return result

    def operate(
        self, node: ast.AST, values: tuple[Any, Any], operator: ast.operator, block: list[Statement]
    ) -> Any:
        """A binary operator."""
        name = _BINARY.get(type(operator))
        if name is None:
            raise self.source.refuse(node, "this operator cannot be emitted")
        if name == "//" and "real" in (kind_of(values[0]), kind_of(values[1])):
            if values[1] != 1.0:
                raise self.source.refuse(node, "of real numbers // is emitted by 1.0 only, as the floor")
            return applied("floor", (values[0],), block)
        return applied(name, values, block)

    def unary(self, node: ast.UnaryOp, block: list[Statement]) -> Any:
        value = self.read(node.operand, block)
        if isinstance(node.op, ast.USub):
            return applied("negate", (value,), block)
        if isinstance(node.op, ast.Not):
            return applied("not", (value,), block)
        raise self.source.refuse(node, "this operator cannot be emitted")

    def compare(self, node: ast.Compare, block: list[Statement]) -> Any:
        """One comparison, or several in a row."""
        result: Any = True
        left = self.read(node.left, block)
        for operator, right_node in zip(node.ops, node.comparators, strict=True):
            right = self.read(right_node, block)
            if isinstance(operator, ast.Is | ast.IsNot):
                one = (left is right) == isinstance(operator, ast.Is)
            else:
                name = _BINARY.get(type(operator))
                if name is None:
                    raise self.source.refuse(node, "this comparison cannot be emitted")
                one = applied(name, (left, right), block)
            result = applied("and", (result, one), block)
            left = right
        return result

    def truth(self, node: ast.BoolOp, block: list[Statement]) -> Any:
        """`and`, `or`: both sides are computed, neither changes anything."""
        name = "and" if isinstance(node.op, ast.And) else "or"
        result = self.read(node.values[0], block)
        for further in node.values[1:]:
            if is_known(result) and bool(result) == (name == "or"):
                return result
            result = applied(name, (result, self.read(further, block)), block)
        return result

    def either(self, node: ast.IfExp, block: list[Statement]) -> Any:
        """`a if c else b`."""
        test = self.read(node.test, block)
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
        values = [self.settled(a, block) for a in node.args]
        named = {k.arg: self.settled(k.value, block) for k in node.keywords if k.arg}
        if function in (min, max):
            return self.extreme("min" if function is min else "max", values, block)
        if function in (math.floor, math.ceil):
            whole = applied("floor" if function is math.floor else "ceil", (values[0],), block)
            return applied("integer", (whole,), block)
        if function in _FUNCTIONS:
            return applied(_FUNCTIONS[function], tuple(values), block)
        if hasattr(function, "_fields"):
            return function(*values, **named)
        if not callable(function) or getattr(function, "__module__", "").split(".")[0] != "zwidth":
            raise self.source.refuse(node, f"{ast.unparse(node.func)} cannot be emitted")
        called = source_of(function)
        names = dict(zip(_names(called), values, strict=False)) | named
        inner = _Writer(called, names, nested=0)
        inner.run(called.tree.body, block)
        return inner.value(block)

    def extreme(self, name: str, values: list[Any], block: list[Statement]) -> Any:
        result = values[0]
        for further in values[1:]:
            result = applied(name, (result, further), block)
        return result


def _copied(value: Any, held: set[int], block: list[Statement]) -> Any:
    """A value, with those of the variables that a loop is changing read now."""
    if isinstance(value, tuple):
        return rebuilt(value, [_copied(v, held, block) for v in value])
    if id(value) in held:
        result = Variable(value.kind)
        block.append(Operation(result, "copy", (value,)))
        return result
    return value


def _variables_like(value: Any, hint: str) -> Any:
    if isinstance(value, tuple):
        return rebuilt(value, [_variables_like(v, hint) for v in value])
    return None if value is None else Variable(kind_of(value), hint, changes=True)


def _set_all(variables: Any, value: Any, block: list[Statement], refuse: Callable[[str], Exception]) -> None:
    if isinstance(variables, tuple):
        for one, part in zip(variables, value, strict=True):
            _set_all(one, part, block, refuse)
    elif variables is not None:
        value = converted(value, variables.kind, block)
        if kind_of(value) != variables.kind:
            raise refuse("a function returns numbers of one kind: write 0.0 for a real 0")
        block.append(Set(variables, as_operand(value)))


def _behind(todo: list[ast.stmt], whole_loop: bool) -> list[ast.stmt] | None:
    """What follows a `break`, or a `continue`, of a loop that is written out; None of one that is not."""
    depth_end = next((k for k, n in enumerate(todo) if isinstance(n, _EndOfLoop)), None)
    if depth_end is None:
        return None
    following = next((k for k, n in enumerate(todo[:depth_end]) if isinstance(n, _NextPass)), depth_end)
    return todo[depth_end + 1 :] if whole_loop else todo[following:]


def _may_leave(body: Sequence[ast.stmt]) -> bool:
    """Whether a block may return, or leave the loop it is in."""
    return any(_leaves(s) for s in body)


def _leaves(node: ast.stmt) -> bool:
    if isinstance(node, ast.Return | ast.Break | ast.Continue):
        return True
    if isinstance(node, ast.If):
        return _may_leave([*node.body, *node.orelse])
    return isinstance(node, ast.For | ast.While) and _returns(node.body)


def _returns(body: Sequence[ast.stmt]) -> bool:
    return any(isinstance(n, ast.Return) for s in body for n in ast.walk(s))


def _assigned(body: Sequence[ast.stmt]) -> list[str]:
    """The names that a block gives values, in their order."""
    stored = (
        n for s in body for n in ast.walk(s) if isinstance(n, ast.Name) and isinstance(n.ctx, ast.Store)
    )
    return list(dict.fromkeys(n.id for n in stored))
