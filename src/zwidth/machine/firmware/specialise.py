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
from functools import partial
from typing import Any

from zwidth.errors import InputError
from zwidth.machine.firmware.expressions import Expressions
from zwidth.machine.firmware.program import (
    Branch,
    Cells,
    Constant,
    Count,
    Leave,
    Program,
    Statement,
    Store,
    Variable,
    While,
    set_to,
    without_unused,
)
from zwidth.machine.firmware.simplified import cut_tables
from zwidth.machine.firmware.source import (
    EndOfLoop,
    NextPass,
    assigned,
    behind,
    counters,
    may_leave,
    returns,
    source_of,
)
from zwidth.machine.firmware.values import (
    Apart,
    Changing,
    Unknown,
    as_operand,
    converted,
    each,
    flat,
    is_known,
    joined,
    kind_of,
    set_all,
)
from zwidth.native.names import Defined, OutsideError, counted

MOST_WRITTEN_OUT = 32
"""Passes of a loop that are written one after the other; a longer one stays a loop."""

LONGEST_SEARCH = 128
"""Steps between the ends of a table: a search in a longer one stays a loop, whose rounding nothing bounds."""


def specialised(
    function: Callable[..., Any], arguments: Sequence[Any], apart: Sequence[Callable[..., Any]] = ()
) -> Program:
    """A program of one step function.

    An argument is a number, an array or a tuple that is known; `Cells` for an array that is changed; a
    `Variable` for a number that is given at every call.  Calls of functions `apart` stay calls: else the
    program would be too long.
    """
    source = source_of(function)
    body: list[Statement] = []
    standing = Apart(frozenset(source_of(f) for f in apart))
    try:
        names = dict(zip((a.arg for a in source.takes()), arguments, strict=True))
        value = _Writer(source, names, body, (source,), standing).whole()
    except OutsideError as fault:
        what = "numbers, arrays of them, conditions, loops and functions of the same"
        raise InputError(f"{fault}; what is emitted are {what}") from None
    parameters = tuple(a for a in flat(tuple(arguments)) if isinstance(a, Variable))
    cells = tuple(a for a in arguments if isinstance(a, Cells))
    program = Program(parameters, cells, body, tuple(as_operand(r) for r in flat(value)))
    return cut_tables(without_unused(program))


_FELL, _OVER = False, True
"""Whether a block goes on behind its end; or has returned, or left its loop, on every way."""


@dataclass
class _Writer(Expressions):
    """Writes the statements of one call."""

    apart: Apart = field(default_factory=Apart)
    returned: Any = None
    todo: list[ast.stmt] = field(default_factory=list)
    """What follows in the block that is written."""
    nested: int = 0
    searching: frozenset[str] = frozenset()
    depth: int = 0
    done: Variable | None = None
    """How deep it is in loops that stay loops, and how `return` gets out of them."""

    def whole(self) -> Any:
        """The call: what it gives back."""
        assert isinstance(self.of.node, ast.FunctionDef)
        self.run(self.of.node.body)
        return self.returned

    def written_in_place(self, called: Defined, names: dict[str, Any]) -> Any:
        """Another call, inside this one or apart."""

        def write(given: dict[str, Any], inner: list[Statement]) -> Any:
            return _Writer(called, given, inner, (*self.calls, called), self.apart).whole()

        if called in self.apart.sources:
            return self.apart.call(called, names, write, self.block)
        return write(names, self.block)

    # ---- statements

    def run(self, body: Sequence[ast.stmt]) -> bool:
        """Write statements; those behind a branch that may end the function go into the branch."""
        outer, self.todo = self.todo, list(body)
        over: bool | None = None
        while self.todo and over is None:
            node = self.todo.pop(0)
            over = self.method(node)(node)
        self.todo = outer
        return bool(over)

    _endofloop = Expressions._pass

    def _nextpass(self, node: NextPass) -> None:
        self.bind(node.target, node.value)

    def _return(self, node: ast.Return) -> bool:
        """At once where it is the only one, else through variables that every way sets."""
        value = None if node.value is None else self.settled(node.value)
        if self.nested == 0:
            self.returned = value
            return _OVER
        if self.returned is None:
            name = self.of.node.name
            self.returned = each(value, lambda v: Variable(kind_of(v), name, changes=True))
        set_all(self.returned, value, self.block, partial(self.outside, node))
        if self.depth:
            assert self.done is not None, "a loop that may return has it"
            self.block += [set_to(self.done, Constant(True, "truth")), Leave()]
        return _OVER

    def _break(self, node: ast.Break | ast.Continue) -> bool | None:
        rest = behind(self.todo, isinstance(node, ast.Break))
        if rest is not None:
            self.todo = rest
            return None
        if isinstance(node, ast.Break):  # of a loop that stays one
            self.block.append(Leave())
        return _OVER

    _continue = _break

    def _assign(self, node: ast.Assign) -> None:
        value = self.settled(node.value)
        for target in node.targets:
            self.bind(target, value)

    def _annassign(self, node: ast.AnnAssign) -> None:
        if node.value is not None:
            self.bind(node.target, self.settled(node.value))

    def _expr(self, node: ast.Expr) -> None:
        if not isinstance(node.value, ast.Constant):
            self.read(node.value)

    def bind(self, target: ast.expr, value: Any) -> None:
        """Give a name, a place of an array, or several of them their value."""
        if isinstance(target, ast.Tuple):
            if not isinstance(value, tuple) or len(value) != len(target.elts):
                raise self.outside(target, "the two sides are of different length")
            for one, part in zip(target.elts, value, strict=True):
                self.bind(one, part)
        elif isinstance(target, ast.Name):
            held = self.names.get(target.id)
            if isinstance(held, Changing):
                self.change(held, value, target)
                return
            if isinstance(value, Variable) and not value.hint:
                value.hint = target.id
            self.names[target.id] = value
        elif isinstance(target, ast.Subscript):
            self.store(target, *self.remembered(target), value)
        else:
            raise self.outside(target, f"{ast.unparse(target)} cannot be given a value")

    def _augassign(self, node: ast.AugAssign) -> None:
        """`a += b`: which place of an array is meant, is asked once."""
        if not isinstance(node.target, ast.Subscript):
            before = self.settled(node.target)
            self.bind(node.target, self.operate(node, before, node.op, self.settled(node.value)))
            return
        cells, index = self.remembered(node.target)
        held = self.loaded(cells, index)
        after = self.operate(node, held, node.op, self.settled(node.value))
        self.store(node.target, cells, index, after)

    def remembered(self, target: ast.Subscript) -> tuple[Cells, Any]:
        """A place of an array that is changed."""
        cells = self.read(target.value)
        if not isinstance(cells, Cells):
            raise self.outside(target, "only what is remembered can be changed")
        return cells, self.place(target, cells.size)

    def store(self, target: ast.Subscript, cells: Cells, index: Any, value: Any) -> None:
        """Give a place of an array its number."""
        if isinstance(value, tuple) or value is None or kind_of(value) == "truth":
            raise self.outside(target, "an array holds numbers")
        real = as_operand(converted(value, "real", self.block))
        self.block.append(Store(cells, as_operand(index), real))

    def change(self, held: Changing, value: Any, node: ast.AST) -> None:
        """Set a variable that a loop changes."""
        what = f"{held.variable.hint} is whole before the loop and real in it, or a condition: write 0.0"
        set_all(held.variable, value, self.block, lambda _: self.outside(node, what))

    # ---- branches

    def _if(self, node: ast.If) -> bool | None:
        """None where what follows is still to be written."""
        test = self.condition(node.test)
        if is_known(test):
            self.todo[:0] = node.body if test else node.orelse
            return None
        # what follows goes into the branch where one of its ways leaves
        leaves = may_leave(node.body) or may_leave(node.orelse)
        # so it does in a search that is written out: on each way the place is known
        leaves = leaves or not self.searching.isdisjoint(assigned([node]))
        rest, searching = list(self.todo) if leaves else [], self.searching

        def way(body: list[ast.stmt]) -> bool:
            self.searching = searching
            return self.run([*body, *rest])

        over = self.both(test, partial(way, node.body), partial(way, node.orelse), node)
        self.searching = searching
        return over if leaves else None

    def both(self, test: Any, then: Callable[[], bool], other: Callable[[], bool], node: ast.AST) -> bool:
        """Write two blocks behind a test and join what they gave the names."""
        made = Branch(as_operand(test))
        before = dict(self.names)
        self.nested += 1
        over = [self.inside(made.then, then)]
        first, self.names = self.names, dict(before)
        over.append(self.inside(made.other, other))
        second = self.names
        self.nested -= 1
        self.block.append(made)
        if any(over):
            self.names = before if all(over) else second if over[0] else first
            return all(over)
        refuse, none = partial(self.outside, node), Unknown()
        self.names = {
            name: joined(first.get(name, none), second.get(name, none), made.then, made.other, name, refuse)
            for name in dict.fromkeys([*first, *second])
        }
        return _FELL

    # ---- loops

    def _while(self, node: ast.While) -> bool | None:
        self.check_loop(node)
        if self.search(node):
            return None
        held = self.hold(node)
        made = While()
        made.test = as_operand(self.inside(made.before, lambda: self.condition(node.test)))
        self.body_of(node, made.body, held)
        self.block.append(made)
        return self.behind_loop(node)

    def _for(self, node: ast.For) -> bool | None:
        self.check_loop(node)
        if not isinstance(node.target, ast.Name):
            raise self.outside(node, "a loop has one counter")
        passes = self.passes(node)
        if isinstance(passes, list):
            written = (n for value in passes for n in (NextPass(node.target, value), *node.body))
            self.todo[:0] = [*written, EndOfLoop()]
            return None
        start, stop, step = passes
        held, name = self.hold(node), node.target.id
        counter = Variable("integer", name)
        made = Count(counter, as_operand(start), as_operand(stop), int(step))
        self.names[name] = counter
        self.body_of(node, made.body, held)
        self.names[name] = Unknown()
        self.block.append(made)
        return self.behind_loop(node)

    def check_loop(self, node: ast.For | ast.While) -> None:
        """Refuse what no loop that is emitted has."""
        if node.orelse:
            raise self.outside(node.orelse[0], "else of a loop cannot be emitted")

    def search(self, node: ast.While) -> bool:
        """A search in a short table, step by step; False of any other loop.

        Its ends are known, and each step takes one of two that are known too.
        """
        changed = assigned(node.body)
        held = [self.names[name] for name in changed if name in self.names]
        ends = [h for h in held if is_known(h) and kind_of(h) == "integer"]
        short = ends and max(ends) - min(ends) <= LONGEST_SEARCH
        if len(ends) != len(held) or not short or self.depth or may_leave(node.body):
            return False
        if any(isinstance(n, ast.Call | ast.Subscript) for n in ast.walk(node.test)):
            return False  # it is read once in each pass, and may change what is remembered
        aside: list[Statement] = []
        test = self.inside(aside, lambda: self.read(node.test))
        if aside or not is_known(test):
            return False
        self.searching = frozenset(changed) if test else frozenset()
        self.todo[:0] = [*node.body, node] if test else []
        return True

    def passes(self, node: ast.For) -> list[Any] | tuple[Any, Any, int]:
        """What the counter of a short loop is in turn; of any other the start, the stop and the step."""
        if isinstance(node.iter, ast.Tuple):
            return [self.settled(e) for e in node.iter.elts]
        given = counted(node)
        if given is None:
            raise self.outside(node, "a loop goes over range(…)")
        start, stop, step = (self.settled(e) for e in given)
        if any(isinstance(g, tuple) or kind_of(g) != "integer" for g in (start, stop, step)):
            raise self.outside(node, "a range has whole numbers")
        if not is_known(step) or step == 0:
            raise self.outside(node, "the step of a range is known and not 0")
        if not (is_known(start) and is_known(stop)):
            return start, stop, step
        values = list(range(start, stop, step))
        stays = len(values) > MOST_WRITTEN_OUT or (may_leave(node.body) and len(values) > 2)
        return (start, stop, step) if stays else values

    def hold(self, node: ast.For | ast.While) -> list[str]:
        """What the body changes gets a variable before the loop; their names."""
        held = []
        for name in assigned(node.body):
            value = self.names.get(name)
            if value is None or isinstance(value, Changing | Unknown):
                continue
            if not isinstance(value, bool | int | float | Variable):
                raise self.outside(node, f"{name} is no number, and the loop changes it")
            variable = Variable(kind_of(value), name, changes=True)
            self.block.append(set_to(variable, as_operand(value)))
            self.names[name] = Changing(variable)
            held.append(name)
        for name in counters(node.body):  # each loop inside gives its own anew
            self.names[name] = Unknown()
        return held

    def body_of(self, node: ast.For | ast.While, body: list[Statement], held: list[str]) -> None:
        """The body of a loop that stays one."""
        if returns(node.body) and self.done is None:
            self.done = Variable("truth", "done", changes=True)
            self.block.append(set_to(self.done, Constant(False, "truth")))
        before = dict(self.names)
        self.nested += 1
        self.depth += 1
        self.inside(body, lambda: self.run(node.body))
        self.depth -= 1
        self.nested -= 1
        # what the body gave a name for the first time is not there where it runs no time
        self.names = {name: before.get(name, Unknown()) for name in dict.fromkeys([*before, *self.names])}
        for name in held:  # nothing changes them any more
            self.names[name] = before[name].variable

    def behind_loop(self, node: ast.For | ast.While) -> bool | None:
        """What follows a loop that may have returned."""
        if not returns(node.body):
            return None
        assert self.done is not None, "a loop that may return has it"
        if self.depth:  # out of the loop around it as well
            self.block.append(Branch(self.done, [Leave()]))
            return None
        done, self.done, rest = self.done, None, self.todo
        return self.both(done, lambda: _OVER, lambda: self.run(rest), node)
