"""One step function as C: the same operations in the same order, so that it gives the same bits.

What is here, and in `expressions`, is the whole language: numbers, arrays, tuples and named tuples;
assignments, conditions, loops over ranges and over tuples that are written out, and calls of other step
functions.  Of an array `a[i]` is a number, `a[i, :]` a row and `a[i:j]` a part, both views.  Everything else
is outside, with file and line.
"""

from __future__ import annotations

import ast
import re

from zwidth.native.expressions import Expressions, NotYet, Read
from zwidth.native.names import Defined
from zwidth.native.reader import counted
from zwidth.native.signature import is_large
from zwidth.native.types import ITEMS, WHOLE, Cells, Nothing, Number, Several, Type, joined


class Function(Expressions):
    """Writes one function."""

    def written(self) -> str:
        """The function in C."""
        assert isinstance(self.of.node, ast.FunctionDef)
        known = None
        while known != self.types:  # a name may be read, in a loop, above where its type is told
            known = dict(self.types)
            self.blank()
            self._block(self.of.node.body)
        self.blank()
        self.is_last = True
        self._block(self.of.node.body)
        given = {name for name, _ in self.own.takes}
        head = [f"  zw_own own{n} = 0;" for n in range(1, self.owned + 1)]
        for name, of in self.types.items():
            if name not in given:
                head.append(f"  {of.c} {name}_ = {'{0}' if isinstance(of, Several | Cells) else '0'};")
        lines = "\n".join([*head, *self.lines])
        for name, of in self.own.takes:
            if is_large(of):  # read where it lies; copied only where the name is given another value
                if re.search(rf"\b{name}_ = ", lines):
                    lines = f"  {of.c} {name}_ = *{name}_at;\n{lines}"
                else:
                    lines = re.sub(rf"\b{name}_\b", f"(*{name}_at)", lines)
        return f"{self.own.head()} {{\n{lines}\n}}"

    def _block(self, body: list[ast.stmt]) -> None:
        self.depth += 1
        for node in body:
            try:
                self.method(node)(node)
            except NotYet:
                continue  # what it gives a name is told the next time
        self.depth -= 1

    def _expr(self, node: ast.Expr) -> None:
        if not isinstance(node.value, ast.Constant):
            self.say(f"{self.read(node.value).c};")

    def _assign(self, node: ast.Assign) -> None:
        if isinstance(node.value, ast.Attribute) and node.value.attr == "shape":
            self._shape(node.targets[0], node.value)
            return
        value = self.read(node.value)
        if len(node.targets) == 1:
            self.bind(node.targets[0], value, node.value)
            return
        name = self.fresh()
        self.say(f"{{ {value.type.c} {name} = {value.c};")
        for target in node.targets:
            self.bind(target, Read(name, value.type), node.value)
        self.say("}")

    def _shape(self, target: ast.expr, node: ast.Attribute) -> None:
        for k, name in enumerate(target.elts if isinstance(target, ast.Tuple) else []):
            self.bind(name, Read(f"{self.read(node.value).c}.n[{k}]", WHOLE), node)

    def _annassign(self, node: ast.AnnAssign) -> None:
        if node.value is None:
            raise self.outside(node, f"{ast.unparse(node)} gives no value")
        self.bind(node.target, self.read(node.value), node.value)

    def _augassign(self, node: ast.AugAssign) -> None:
        calls = (n.func for n in ast.walk(node.target) if isinstance(n, ast.Call))
        if any(isinstance(self.callee(function), Defined) for function in calls):
            raise self.outside(node, "where a number is changed in place, the place is no call")
        whole = ast.copy_location(ast.BinOp(_as_read(node.target), node.op, node.value), node)
        self.bind(node.target, self.read(whole), whole)

    def _return(self, node: ast.Return) -> None:
        if node.value is None or isinstance(self.own.returns, Nothing):
            if node.value is not None and not isinstance(node.value, ast.Constant):
                raise self.outside(node, f"{self.own.name} says that it returns nothing")
            self.say("return;")
        else:
            self.say(f"return {self.cast(self.read(node.value), self.own.returns, node)};")

    def _break(self, node: ast.Break) -> None:
        self.say("break;")

    def _continue(self, node: ast.Continue) -> None:
        self.say("continue;")

    def _if(self, node: ast.If) -> None:
        self.say(f"if ({self.truth(node.test)}) {{")
        self._block(node.body)
        if node.orelse:
            self.say("} else {")
            self._block(node.orelse)
        self.say("}")

    def _while(self, node: ast.While) -> None:
        before = len(self.lines)
        head = f"while ({self.truth(node.test)}) {{"
        if len(self.lines) > before or node.orelse:
            raise self.outside(
                node, "what a loop waits for is told without parts of arrays, and it has no else"
            )
        self.say(head)
        self._block(node.body)
        self.say("}")

    def _for(self, node: ast.For) -> None:
        given = counted(node)
        if node.orelse or (given and not isinstance(node.target, ast.Name)):
            raise self.outside(node, "a range counts one name, and a loop has no else")
        if given is None:
            self._one_by_one(node)
            return
        start, stop, step = (self.cast(self.read(part), WHOLE, part) for part in given)
        at, end, by = self.fresh(), self.fresh(), self.fresh()
        value = self.module.value(given[2], self.types)
        goes_on = f"{by} > 0 ? {at} < {end} : {at} > {end}"
        if value is not None:
            goes_on = f"{at} {'<' if value > 0 else '>'} {end}"
        self.say(f"{{ int64_t {end} = {stop}, {by} = {step};")
        self.say(f"for (int64_t {at} = {start}; {goes_on}; {at} += {by}) {{")
        self.depth += 1
        self.bind(node.target, Read(at, WHOLE), node.iter)
        self.depth -= 1
        self._block(node.body)
        self.say("} }")

    def _one_by_one(self, node: ast.For) -> None:
        known = self.module.value(node.iter, self.types)
        parts = node.iter.elts if isinstance(node.iter, ast.Tuple) else None
        if parts is None and isinstance(known, tuple | range):
            parts = [ast.copy_location(ast.Constant(v), node.iter) for v in known]
        leaves = any(isinstance(n, ast.Break | ast.Continue) for s in node.body for n in ast.walk(s))
        if parts is None or leaves:
            raise self.outside(node, "a loop goes over a range, or over what is written out, to its end")
        for part in parts:
            self.say("{")
            self.bind(node.target, self.read(part), part)
            self._block(node.body)
            self.say("}")

    def bind(self, target: ast.expr, value: Read, node: ast.expr) -> None:
        """Give a name, a place or a part of an array, or several of them their value."""
        if isinstance(target, ast.Name):
            self.types[target.id] = of = self._bound(target, value)
            self.say(f"{target.id}_ = {self.cast(value, of, node)};")
        elif isinstance(target, ast.Tuple):
            if not isinstance(value.type, Several) or len(value.type.items) != len(target.elts):
                raise self.outside(node, f"{ast.unparse(node)} is no tuple of {len(target.elts)}")
            name = self.fresh()
            self.say(f"{{ {value.type.c} {name} = {value.c};")
            for n, (inner, of) in enumerate(zip(target.elts, value.type.items, strict=True)):
                self.bind(inner, Read(f"{name}.f{n}", of), node)
            self.say("}")
        elif isinstance(target, ast.Subscript):
            into = self.read(_as_read(target))
            if not isinstance(target.slice, ast.Slice):
                self.say(f"{into.c} = {self.cast(value, into.type, node)};")
                return
            if not isinstance(into.type, Cells) or not isinstance(value.type, Number | Cells):
                raise self.outside(node, "a part of an array becomes one number, or another part")
            does, to = ("copy", into.type) if isinstance(value.type, Cells) else ("fill", into.type.of)
            self.say(f"zw_{does}_{ITEMS[into.type.item][0]}({into.c}, {self.cast(value, to, node)});")
        else:
            raise self.outside(target, f"{ast.unparse(target)} cannot be given a value")

    def _bound(self, target: ast.Name, value: Read) -> Type:
        before = self.types.get(target.id)
        both = joined(before, value.type) if before else value.type
        if both is None:
            raise self.outside(target, f"{target.id} would be {before} and {value.type}")
        if isinstance(before, Number) and before != both and target.id in dict(self.own.takes):
            raise self.outside(target, f"{target.id} is given as {before} and becomes {both}")
        return both


def _as_read(target: ast.expr) -> ast.expr:
    """A target as what it holds."""
    if isinstance(target, ast.Name):
        return ast.copy_location(ast.Name(target.id, ast.Load()), target)
    if isinstance(target, ast.Subscript):
        return ast.copy_location(ast.Subscript(target.value, target.slice, ast.Load()), target)
    return target
