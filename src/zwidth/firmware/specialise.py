"""From a step function and what is known of its arguments to a program.

What depends on known numbers alone is computed; calls are written out in place; the rest becomes the program.
So a wall of one stiffness is three operations, not the interpreter of all laws.

The subset of Python: numbers, their operators, `min`, `max`, `abs`, `float`, `int`, functions of `math` that
are correctly rounded, arrays of float64 read and written one number at a time, tuples and named tuples, `if`,
`for … in range(…)`, `while`, `break`, `continue`, `return`, and calls of functions of the same subset.
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

from zwidth.firmware.apart import Apart
from zwidth.firmware.arithmetic import as_operand, converted, is_known, kind_of
from zwidth.firmware.expressions import Expressions
from zwidth.firmware.places import cut_tables
from zwidth.firmware.program import (
    Branch,
    Cells,
    Constant,
    Count,
    Leave,
    Load,
    Program,
    Statement,
    Store,
    Variable,
    While,
    set_to,
    without_unused,
)
from zwidth.firmware.source import Source, source_of
from zwidth.firmware.syntax import EndOfLoop, NextPass, assigned, behind, counters, may_leave, returns
from zwidth.firmware.values import Changing, Unknown, joined, set_all, variables_like

MOST_WRITTEN_OUT = 32
"""Passes of a loop that are written one after the other; a longer one stays a loop."""


def specialised(
    function: Callable[..., Any], arguments: Sequence[Any], apart: Sequence[Callable[..., Any]] = ()
) -> Program:
    """A program of one function.

    Parameters
    ----------
    function
        A step function.
    arguments
        Of each argument: a number, an array or a tuple that is known; `Cells` for an array that is changed;
        a `Variable` for a number that is given at every call.
    apart
        Functions whose calls stay calls: a program that would be too long without them.

    Raises
    ------
    InputError
        If something in it, or in what it calls, is outside the subset; with file and line.
    """
    source = source_of(function)
    body: list[Statement] = []
    names = dict(zip(source.arguments, arguments, strict=True))
    standing = Apart(frozenset(source_of(f) for f in apart))
    value = _Writer(source, names, (source,), standing).whole(body)
    results = value if isinstance(value, tuple) else (() if value is None else (value,))
    parameters = tuple(a for a in _flat(arguments) if isinstance(a, Variable))
    cells = tuple(a for a in arguments if isinstance(a, Cells))
    program = Program(parameters, cells, body, tuple(as_operand(r) for r in _flat(results)))
    return cut_tables(without_unused(program))


def _flat(arguments: Sequence[Any]) -> list[Any]:
    return [x for a in arguments for x in (_flat(a) if isinstance(a, tuple) else [a])]


@dataclass
class _Exits:
    """Loops that stay loops, in one function: how `return` gets out of them."""

    depth: int = 0
    done: Variable | None = None


_FELL, _OVER = False, True
"""Whether a block goes on behind its end; or has returned, or left its loop, on every way."""


@dataclass
class _Writer(Expressions):
    """Writes the statements of one call."""

    apart: Apart = field(default_factory=Apart)
    returned: Any = None
    nested: int = 0
    searching: frozenset[str] = frozenset()
    exits: _Exits = field(default_factory=_Exits)

    def whole(self, block: list[Statement]) -> Any:
        """The call: what it gives back."""
        self.run(self.source.tree.body, block)
        return self.returned

    def written_in_place(self, called: Source, names: dict[str, Any], block: list[Statement]) -> Any:
        """Another call, inside this one or apart."""

        def write(given: dict[str, Any], inner: list[Statement]) -> Any:
            return _Writer(called, given, (*self.calls, called), self.apart).whole(inner)

        if called in self.apart.sources:
            return self.apart.call(called, names, write, block)
        return write(names, block)

    def give_back(self, value: Any, node: ast.AST, block: list[Statement]) -> None:
        """A `return`: at once where it is the only one, else through variables that every way sets."""
        if self.nested == 0:
            self.returned = value
            return
        if self.returned is None:
            self.returned = variables_like(value, self.source.name)
        set_all(self.returned, value, block, lambda what: self.source.refuse(node, what))
        if self.exits.depth:
            assert self.exits.done is not None, "a loop that may return has it"
            block.append(set_to(self.exits.done, Constant(True, "truth")))
            block.append(Leave())

    # ---- statements

    def run(self, todo: Sequence[ast.stmt], block: list[Statement]) -> bool:
        """Write statements; those behind a branch that may end the function go into the branch."""
        todo = list(todo)
        while todo:
            node = todo.pop(0)
            if isinstance(node, EndOfLoop):
                continue
            if isinstance(node, NextPass):
                self.bind(node.target, node.value, block)
            elif isinstance(node, ast.Return):
                value = None if node.value is None else self.settled(node.value, block)
                self.give_back(value, node, block)
                return _OVER
            elif isinstance(node, ast.Break | ast.Continue):
                rest = behind(todo, isinstance(node, ast.Break))
                if rest is None:  # of a loop that stays one
                    if isinstance(node, ast.Break):
                        block.append(Leave())
                    return _OVER
                todo = rest
            elif isinstance(node, ast.If):
                over = self.branch(node, todo, block)
                if over is not None:
                    return over
            elif isinstance(node, ast.For | ast.While):
                if self.loop(node, todo, block):
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
            self.augment(node, block)
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
            self.store(target, *self.remembered(target, block), value, block)
        else:
            raise self.source.refuse(target, f"{ast.unparse(target)} cannot be given a value")

    def augment(self, node: ast.AugAssign, block: list[Statement]) -> None:
        """`a += b`: which place of an array is meant, is asked once."""
        if not isinstance(node.target, ast.Subscript):
            before = self.settled(node.target, block)
            after = self.operate(node, (before, self.settled(node.value, block)), node.op, block)
            self.bind(node.target, after, block)
            return
        cells, index = self.remembered(node.target, block)
        held = Variable("real")
        block.append(Load(held, cells, as_operand(index)))
        after = self.operate(node, (held, self.settled(node.value, block)), node.op, block)
        self.store(node.target, cells, index, after, block)

    def remembered(self, target: ast.Subscript, block: list[Statement]) -> tuple[Cells, Any]:
        """A place of an array that is changed."""
        cells = self.read(target.value, block)
        if not isinstance(cells, Cells):
            raise self.source.refuse(target, "only what is remembered can be changed")
        return cells, self.place(target, cells.size, block)

    def store(
        self, target: ast.Subscript, cells: Cells, index: Any, value: Any, block: list[Statement]
    ) -> None:
        """Give a place of an array its number."""
        if isinstance(value, tuple) or value is None or kind_of(value) == "truth":
            raise self.source.refuse(target, "an array holds numbers")
        block.append(Store(cells, as_operand(index), as_operand(converted(value, "real", block))))

    def change(self, held: Changing, value: Any, node: ast.AST, block: list[Statement]) -> None:
        """Set a variable that a loop changes."""
        what = f"{held.variable.hint} is whole before the loop and real in it, or a condition: write 0.0"
        set_all(held.variable, value, block, lambda _: self.source.refuse(node, what))

    # ---- branches

    def branch(self, node: ast.If, todo: list[ast.stmt], block: list[Statement]) -> bool | None:
        """An `if`; None where what follows is still to be written."""
        test = self.condition(self.read(node.test, block), node, block)
        if is_known(test):
            todo[:0] = node.body if test else node.orelse
            return None
        # what follows goes into the branch where one of its ways leaves
        leaves = may_leave(node.body) or may_leave(node.orelse)
        # so it does in a search that is written out: on each way the place is known
        leaves = leaves or not self.searching.isdisjoint(assigned([node]))
        rest, searching = list(todo) if leaves else [], self.searching

        def way(body: list[ast.stmt]) -> Callable[[list[Statement]], bool]:
            def write(inner: list[Statement]) -> bool:
                self.searching = searching
                return self.run([*body, *rest], inner)

            return write

        over = self.both(test, way(node.body), way(node.orelse), node, block)
        self.searching = searching
        return over if leaves else None

    def both(
        self,
        test: Any,
        then: Callable[[list[Statement]], bool],
        other: Callable[[list[Statement]], bool],
        node: ast.AST,
        block: list[Statement],
    ) -> bool:
        """Write two blocks behind a test and join what they gave the names."""
        made = Branch(as_operand(test))
        before = dict(self.names)
        self.nested += 1
        over = [then(made.then)]
        first, self.names = self.names, dict(before)
        over.append(other(made.other))
        second = self.names
        self.nested -= 1
        block.append(made)
        if any(over):
            self.names = before if all(over) else second if over[0] else first
            return _OVER if all(over) else _FELL
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

    def loop(self, node: ast.For | ast.While, todo: list[ast.stmt], block: list[Statement]) -> bool:
        """A loop; True where it stays one from which the function may have returned."""
        if node.orelse:
            raise self.source.refuse(node.orelse[0], "else of a loop cannot be emitted")
        if isinstance(node, ast.While):
            if self.search(node, todo, block):
                return False
            self.while_loop(node, block)
        else:
            if not isinstance(node.target, ast.Name):
                raise self.source.refuse(node, "a loop has one counter")
            passes = self.passes(node, block)
            if isinstance(passes, list):
                todo[:0] = [
                    *(n for value in passes for n in (NextPass(node.target, value), *node.body)),
                    EndOfLoop(),
                ]
                return False
            self.count(node, node.target.id, passes, block)
        if self.exits.depth and returns(node.body):  # out of the loop around it as well
            assert self.exits.done is not None, "a loop that may return has it"
            block.append(Branch(self.exits.done, [Leave()]))
        return returns(node.body)

    def search(self, node: ast.While, todo: list[ast.stmt], block: list[Statement]) -> bool:
        """A search in a short table, step by step; False of any other loop.

        Its ends are known, and each step takes one of two that are known too.
        """
        changed = assigned(node.body)
        held = [self.names[name] for name in changed if name in self.names]
        ends = [h for h in held if is_known(h) and kind_of(h) == "integer"]
        short = ends and max(ends) - min(ends) <= MOST_WRITTEN_OUT
        if len(ends) != len(held) or not short or self.exits.depth or may_leave(node.body):
            return False
        if any(isinstance(n, ast.Call | ast.Subscript) for n in ast.walk(node.test)):
            return False  # it is read once in each pass, and may change what is remembered
        aside: list[Statement] = []
        test = self.read(node.test, aside)
        if aside or not is_known(test):
            return False
        if test:
            self.searching = frozenset(changed)
            todo[:0] = [*node.body, node]
        else:
            self.searching = frozenset()
        return True

    def passes(self, node: ast.For, block: list[Statement]) -> list[Any] | tuple[Any, Any, int]:
        """What the counter of a short loop is in turn; of any other the start, the stop and the step."""
        if isinstance(node.iter, ast.Tuple):
            return [self.settled(e, block) for e in node.iter.elts]
        bounds = self.bounds(node, block)
        if not all(is_known(b) for b in bounds):
            return bounds
        values = list(range(*bounds))
        stays = len(values) > MOST_WRITTEN_OUT or (may_leave(node.body) and len(values) > 2)
        return bounds if stays else values

    def bounds(self, node: ast.For, block: list[Statement]) -> tuple[Any, Any, int]:
        """Start, stop and step of a range."""
        call = node.iter
        if not (isinstance(call, ast.Call) and isinstance(call.func, ast.Name) and call.func.id == "range"):
            raise self.source.refuse(node, "a loop goes over range(…)")
        given = [self.settled(a, block) for a in call.args]
        if any(isinstance(g, tuple) or kind_of(g) != "integer" for g in given):
            raise self.source.refuse(node, "a range has whole numbers")
        start, stop = (0, given[0]) if len(given) == 1 else given[:2]
        step = given[2] if len(given) == 3 else 1
        if not is_known(step) or step == 0:
            raise self.source.refuse(node, "the step of a range is known and not 0")
        return start, stop, step

    def count(self, node: ast.For, name: str, bounds: tuple[Any, Any, int], block: list[Statement]) -> None:
        """A loop over a range that stays one."""
        start, stop, step = bounds
        held = self.hold(node, node.body, block)
        counter = Variable("integer", name)
        made = Count(counter, as_operand(start), as_operand(stop), int(step))
        self.names[name] = counter
        self.inside(node, made.body, held, block)
        self.names[name] = Unknown()
        block.append(made)

    def while_loop(self, node: ast.While, block: list[Statement]) -> None:
        """A loop that goes on while a condition holds."""
        held = self.hold(node, node.body, block)
        made = While()
        made.test = as_operand(self.condition(self.read(node.test, made.before), node, made.before))
        self.inside(node, made.body, held, block)
        block.append(made)

    def hold(self, node: ast.For | ast.While, body: list[ast.stmt], block: list[Statement]) -> list[str]:
        """What the body changes gets a variable before the loop; their names."""
        held = []
        for name in assigned(body):
            value = self.names.get(name)
            if value is None or isinstance(value, Changing | Unknown):
                continue
            if not isinstance(value, bool | int | float | Variable):
                raise self.source.refuse(node, f"{name} is no number, and the loop changes it")
            variable = Variable(kind_of(value), name, changes=True)
            block.append(set_to(variable, as_operand(value)))
            self.names[name] = Changing(variable)
            held.append(name)
        for name in counters(body):  # each loop inside gives its own anew
            self.names[name] = Unknown()
        return held

    def inside(
        self, node: ast.For | ast.While, body: list[Statement], held: list[str], block: list[Statement]
    ) -> None:
        """The body of a loop."""
        if returns(node.body) and self.exits.done is None:
            self.exits.done = Variable("truth", "done", changes=True)
            block.append(set_to(self.exits.done, Constant(False, "truth")))
        before = dict(self.names)
        self.nested += 1
        self.exits.depth += 1
        self.run(node.body, body)
        self.exits.depth -= 1
        self.nested -= 1
        # what the body gave a name for the first time is not there where it runs no time
        self.names = {name: before.get(name, Unknown()) for name in dict.fromkeys([*before, *self.names])}
        for name in held:  # nothing changes them any more
            self.names[name] = before[name].variable

    def unless_done(self, node: ast.stmt, todo: list[ast.stmt], block: list[Statement]) -> bool:
        """What follows a loop that may have returned."""
        if self.exits.depth:
            return self.run(todo, block)
        done, self.exits.done = self.exits.done, None
        return self.both(done, lambda b: _OVER, lambda b: self.run(todo, b), node, block)
