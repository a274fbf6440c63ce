"""One step function as C: the same operations in the same order, so that it gives the same bits.

What is here is the whole language: numbers, arrays, tuples and named tuples; assignments, conditions, loops
over ranges and over tuples that are written out, calls of other step functions.  Of an array `a[i]` is a
number, `a[i, :]` a row and `a[i:j]` a part, both views.  Everything else is outside, with file and line.
"""

from __future__ import annotations

import ast
import re
from typing import Any, NamedTuple, Protocol

from zwidth.native.names import Defined, Module, is_step_function
from zwidth.native.types import (
    ITEMS,
    REAL,
    TRUTH,
    WHOLE,
    Asked,
    Cells,
    Maybe,
    Nothing,
    Number,
    Several,
    Type,
    annotated,
    fields,
    joined,
)


class Read(NamedTuple):
    """An expression in C, and its type; None while that of a name in it is not known yet."""

    c: str
    type: Type | None


class Signature(NamedTuple):
    """How a step function is called."""

    name: str
    takes: tuple[tuple[str, Type], ...]
    returns: Type
    defaults: dict[str, ast.expr]
    module: Module


class Around(Protocol):
    """What a function needs of the translation that it is part of."""

    def signature(self, of: Defined) -> Signature: ...

    def several(self, of: Several) -> Several: ...

    def constants(self, values: tuple[Any, ...]) -> Read: ...


_OF_C = ("ceil", "sqrt", "sin", "cos", "exp", "expm1", "log1p", "log2")
_LIBRARY = {"floor": "zw_floor", **{name: name for name in _OF_C}}
_ASKED = {"isfinite": "isfinite", "isnan": "isnan"}
_COMPARED = {ast.Lt: "<", ast.Gt: ">", ast.LtE: "<=", ast.GtE: ">=", ast.Eq: "==", ast.NotEq: "!="}
_WRITTEN = {
    ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.LShift: "<<", ast.RShift: ">>", ast.BitAnd: "&",
    ast.BitOr: "|", ast.BitXor: "^",
}  # fmt: skip


class Function:
    """Writes one function."""

    def __init__(self, around: Around, of: Defined) -> None:
        assert isinstance(of.node, ast.FunctionDef)
        self.around, self.module, self.tree = around, of.module, of.node
        self.own = around.signature(of)
        self.types: dict[str, Type] = dict(self.own.takes)
        self._blank()

    def _blank(self) -> None:
        self.lines: list[str] = []
        self.depth, self.counted, self.owned = 1, 0, 0

    def written(self) -> str:
        """The function in C."""
        known: dict[str, Type] = {}
        while known != self.types:  # a name may be read, in a loop, above where its type is told
            known = dict(self.types)
            self._blank()
            self._block(self.tree.body)
        self._blank()
        self.is_last = True
        self._block(self.tree.body)
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
        return f"{head_of(self.own)} {{\n{lines}\n}}"

    is_last = False
    """False while types are looked for: a type that is not known is then no fault."""

    # statements

    def _say(self, text: str) -> None:
        self.lines.append("  " * self.depth + text)

    def _fresh(self) -> str:
        self.counted += 1
        return f"t{self.counted}"

    def _block(self, body: list[ast.stmt]) -> None:
        self.depth += 1
        for node in body:
            self._statement(node)
        self.depth -= 1

    def _statement(self, node: ast.stmt) -> None:
        if isinstance(node, ast.Expr):
            if not isinstance(node.value, ast.Constant):
                self._say(f"{self.read(node.value).c};")
        elif isinstance(node, ast.Assign):
            if isinstance(node.value, ast.Attribute) and node.value.attr == "shape":
                self._shape(node.targets[0], node.value)
                return
            value = self.read(node.value)
            if len(node.targets) > 1 and value.type is not None:
                name = self._fresh()
                self._say(f"{{ {value.type.c} {name} = {value.c};")
                value = Read(name, value.type)
            for target in node.targets:
                self._assign(target, value, node.value)
            if len(node.targets) > 1 and value.type is not None:
                self._say("}")
        elif isinstance(node, ast.AnnAssign) and node.value is not None:
            self._assign(node.target, self.read(node.value), node.value)
        elif isinstance(node, ast.AugAssign):
            if any(
                isinstance(self._callee(n.func), Defined)
                for n in ast.walk(node.target)
                if isinstance(n, ast.Call)
            ):
                raise self.module.outside(node, "where a number is changed in place, the place is no call")
            whole = ast.copy_location(ast.BinOp(_as_read(node.target), node.op, node.value), node)
            self._assign(node.target, self.read(whole), whole)
        elif isinstance(node, ast.If):
            self._say(f"if ({self.truth(node.test)}) {{")
            self._block(node.body)
            if node.orelse:
                self._say("} else {")
                self._block(node.orelse)
            self._say("}")
        elif isinstance(node, ast.While) and not node.orelse:
            before = len(self.lines)
            head = f"while ({self.truth(node.test)}) {{"
            if len(self.lines) > before:
                raise self.module.outside(node, "what a loop waits for is told without parts of arrays")
            self._say(head)
            self._block(node.body)
            self._say("}")
        elif isinstance(node, ast.For) and not node.orelse:
            self._loop(node)
        elif isinstance(node, ast.Return):
            self._return(node)
        elif isinstance(node, ast.Break | ast.Continue):
            self._say("break;" if isinstance(node, ast.Break) else "continue;")
        elif not isinstance(node, ast.Pass):
            raise self.module.outside(node, f"{type(node).__name__} is outside what is translated")

    def _return(self, node: ast.Return) -> None:
        if node.value is None or isinstance(self.own.returns, Nothing):
            if node.value is not None and not isinstance(node.value, ast.Constant):
                raise self.module.outside(node, f"{self.own.name} says that it returns nothing")
            self._say("return;")
        else:
            self._say(f"return {self.cast(self.read(node.value), self.own.returns, node)};")

    def _loop(self, node: ast.For) -> None:
        if isinstance(node.iter, ast.Call) and ast.unparse(node.iter.func) == "range":
            told = [self.cast(self.read(a), WHOLE, a) for a in node.iter.args]
            first, last, step = ("0", *told, "1") if len(told) == 1 else (*told, "1")[:3]
            if not isinstance(node.target, ast.Name):
                raise self.module.outside(node, "a range counts one name")
            value = self.module.value(node.iter.args[2], self.types) if len(told) == 3 else 1
            at, end, by = self._fresh(), self._fresh(), self._fresh()
            goes_on = f"{by} > 0 ? {at} < {end} : {at} > {end}"
            if value is not None:
                goes_on = f"{at} {'<' if value > 0 else '>'} {end}"
            self._say(f"{{ int64_t {end} = {last}, {by} = {step};")
            self._say(f"for (int64_t {at} = {first}; {goes_on}; {at} += {by}) {{")
            self.depth += 1
            self._assign(node.target, Read(at, WHOLE), node.iter)
            self.depth -= 1
            self._block(node.body)
            self._say("} }")
            return
        known = self.module.value(node.iter, self.types)
        parts = node.iter.elts if isinstance(node.iter, ast.Tuple) else None
        if parts is None and isinstance(known, tuple | range):
            parts = [ast.copy_location(ast.Constant(v), node.iter) for v in known]
        if parts is None or any(
            isinstance(n, ast.Break | ast.Continue) for s in node.body for n in ast.walk(s)
        ):
            raise self.module.outside(
                node, "a loop goes over a range, or over what is written out, to its end"
            )
        for part in parts:
            self._say("{")
            self._assign(node.target, self.read(part), part)
            self._block(node.body)
            self._say("}")

    def _shape(self, target: ast.expr, node: ast.Attribute) -> None:
        names = target.elts if isinstance(target, ast.Tuple) else []
        for k, name in enumerate(names):
            self._assign(name, Read(f"{self.read(node.value).c}.n[{k}]", WHOLE), node)

    def _assign(self, target: ast.expr, value: Read, node: ast.expr) -> None:
        if value.type is None and self.is_last:
            raise self.module.outside(node, f"what {ast.unparse(node)} is cannot be told")
        if isinstance(target, ast.Name):
            self.types[target.id] = self._bound(target, value)
            if value.type is not None:
                self._say(f"{target.id}_ = {self.cast(value, self.types[target.id], node)};")
        elif isinstance(target, ast.Tuple):
            if value.type is None:
                return
            if not isinstance(value.type, Several) or len(value.type.items) != len(target.elts):
                raise self.module.outside(node, f"{ast.unparse(node)} is no tuple of {len(target.elts)}")
            name = self._fresh()
            self._say(f"{{ {value.type.c} {name} = {value.c};")
            for n, (inner, of) in enumerate(zip(target.elts, value.type.items, strict=True)):
                self._assign(inner, Read(f"{name}.f{n}", of), node)
            self._say("}")
        elif isinstance(target, ast.Subscript) and isinstance(target.slice, ast.Slice):
            into = self.read(target)
            if not isinstance(into.type, Cells) or not isinstance(value.type, Number | Cells):
                raise self.module.outside(node, "a part of an array becomes one number, or another part")
            kind = ITEMS[into.type.item][0]
            if isinstance(value.type, Cells):
                self._say(f"zw_copy_{kind}({into.c}, {self.cast(value, into.type, node)});")
            else:
                self._say(f"zw_fill_{kind}({into.c}, {self.cast(value, into.type.of, node)});")
        elif isinstance(target, ast.Subscript):
            into = self.read(_as_read(target))
            if into.type is not None:
                self._say(f"{into.c} = {self.cast(value, into.type, node)};")
        else:
            raise self.module.outside(target, f"{ast.unparse(target)} cannot be given a value")

    def _bound(self, target: ast.Name, value: Read) -> Any:
        before = self.types.get(target.id)
        both = joined(before, value.type)
        if both is None and before is not None and value.type is not None:
            raise self.module.outside(target, f"{target.id} would be {before} and {value.type}")
        if isinstance(before, Number) and before != both and target.id in dict(self.own.takes):
            raise self.module.outside(target, f"{target.id} is given as {before} and becomes {both}")
        return both if both is not None else before

    # expressions

    def cast(self, value: Read, to: Type, node: ast.AST) -> str:
        """A value where another type is wanted that can hold it."""
        if value.type is None or value.type == to:
            return value.c
        if isinstance(value.type, Number) and isinstance(to, Number) and (to != WHOLE or value.type == TRUTH):
            if to == TRUTH:
                raise self.module.outside(node, "a number stands where True or False is said to")
            return f"(({to.c}){value.c})"
        if isinstance(value.type, Maybe) and to == REAL:
            return f"{value.c}.value"
        if isinstance(to, Maybe) and isinstance(value.type, Number):
            return f"(zw_maybe){{{value.c}, 1}}"
        if (
            isinstance(value.type, Several)
            and isinstance(to, Several)
            and len(to.items) == len(value.type.items)
        ):
            if value.type.items == to.items:
                return value.c
            name = self._fresh()
            self._say(f"{value.type.c} {name} = {value.c};")
            parts = (Read(f"{name}.f{n}", of) for n, of in enumerate(value.type.items))
            told = ", ".join(self.cast(p, of, node) for p, of in zip(parts, to.items, strict=True))
            return f"({to.c}){{{told}}}"
        raise self.module.outside(node, f"{value.type} stands where {to} is wanted")

    def truth(self, node: ast.expr) -> str:
        """An expression that is asked whether it is so."""
        if isinstance(node, ast.BoolOp):
            joint = " && " if isinstance(node.op, ast.And) else " || "
            return "(" + joint.join(self.truth(v) for v in node.values) + ")"
        if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.Not):
            return f"(!{self.truth(node.operand)})"
        value = self.read(node)
        if value.type is not None and not isinstance(value.type, Number):
            raise self.module.outside(node, f"{ast.unparse(node)} is no condition")
        return f"({value.c} != 0)" if value.type == REAL else value.c

    def read(self, node: ast.expr) -> Read:
        """An expression."""
        if not isinstance(node, ast.Tuple):
            known = self.module.value(node, self.types)
            if isinstance(known, bool | int | float):
                return literal(known)
        reader = getattr(self, f"_{type(node).__name__.lower()}", None)
        if reader is None:
            raise self.module.outside(node, f"{ast.unparse(node)} is outside what is translated")
        found: Read = reader(node)
        return found

    def _name(self, node: ast.Name) -> Read:
        if node.id in self.types:
            return Read(f"{node.id}_", self.types[node.id])
        found = self.module.meaning(node.id)
        if isinstance(found, Defined) and is_step_function(found.node):
            to = self.around.signature(found)
            return Read(to.name, Asked(tuple(of for _, of in to.takes), to.returns))
        known = self.module.value(node)
        if isinstance(known, tuple):
            return self.around.constants(known)
        if self.is_last:
            raise self.module.outside(node, f"{node.id} is not known")
        return Read(f"{node.id}_", None)

    def _tuple(self, node: ast.Tuple) -> Read:
        parts = [self.read(e) for e in node.elts]
        if any(p.type is None for p in parts):
            return Read("0", None)
        of = self.around.several(Several(tuple(p.type for p in parts if p.type is not None)))
        return Read(f"(({of.c}){{{', '.join(p.c for p in parts)}}})", of)

    def _binop(self, node: ast.BinOp) -> Read:
        a, b = self._there(node.left), self._there(node.right)
        for part in (a, b):
            if part.type is not None and not isinstance(part.type, Number):
                raise self.module.outside(node, f"{ast.unparse(node)} calculates with {part.type}")
        if isinstance(node.op, ast.Div):
            return Read(f"((double){a.c} / (double){b.c})", REAL)
        both = joined(a.type, b.type)
        of = None if a.type is None or b.type is None else WHOLE if both == TRUTH else both
        kind = "real" if of == REAL else "whole"
        if isinstance(node.op, ast.FloorDiv | ast.Mod | ast.Pow):
            name = {ast.FloorDiv: "over", ast.Mod: "rest", ast.Pow: "power"}[type(node.op)]
            if name == "power" and kind == "real" and self.module.value(node.right, self.types) != 2:
                raise self.module.outside(node, "of a real number only the square is taken by **")
            return Read(f"zw_{name}_{kind}({a.c}, {b.c})", of)
        if type(node.op) not in _WRITTEN:
            raise self.module.outside(node, f"{ast.unparse(node)} is outside what is translated")
        if isinstance(node.op, ast.Sub) and of == REAL and self.module.value(node.left, self.types) == 0:
            return Read(f"zw_opposite({b.c})", of)
        return Read(f"({a.c} {_WRITTEN[type(node.op)]} {b.c})", of)

    def _there(self, node: ast.expr) -> Read:
        """An operand; of what may be None the number."""
        value = self.read(node)
        return Read(f"{value.c}.value", REAL) if isinstance(value.type, Maybe) else value

    def _unaryop(self, node: ast.UnaryOp) -> Read:
        if isinstance(node.op, ast.Not):
            return Read(f"((int64_t)!{self.truth(node.operand)})", TRUTH)
        value = self.read(node.operand)
        sign = {ast.USub: "-", ast.UAdd: "+", ast.Invert: "~"}[type(node.op)]
        return Read(f"({sign}{value.c})", WHOLE if value.type == TRUTH else value.type)

    def _compare(self, node: ast.Compare) -> Read:
        parts, left = [], node.left
        for operator, right in zip(node.ops, node.comparators, strict=True):
            if isinstance(operator, ast.Is | ast.IsNot):
                is_there = self.read(left)
                parts.append(f"({'!' if isinstance(operator, ast.Is) else ''}{is_there.c}.is_there)")
            elif isinstance(operator, ast.In | ast.NotIn):
                known = self.module.value(right, self.types)
                among = right.elts if isinstance(right, ast.Tuple) else [ast.Constant(v) for v in known or ()]
                told = " || ".join(f"({self.read(left).c} == {self.read(a).c})" for a in among)
                parts.append(f"({'!' if isinstance(operator, ast.NotIn) else ''}({told}))")
            else:
                parts.append(f"({self.read(left).c} {_COMPARED[type(operator)]} {self.read(right).c})")
            left = right
            if len(node.ops) > 1 and any(isinstance(n, ast.Call) for n in ast.walk(right)):
                raise self.module.outside(node, "what stands between two comparisons is no call")
        return Read(
            f"((int64_t){' && '.join(parts)})" if len(parts) == 1 else f"((int64_t)({' && '.join(parts)}))",
            TRUTH,
        )

    def _boolop(self, node: ast.BoolOp) -> Read:
        for value in node.values:
            of = self.read(value).type
            if of not in (TRUTH, None):
                raise self.module.outside(node, f"{ast.unparse(value)} is neither True nor False")
        return Read(f"((int64_t){self.truth(node)})", TRUTH)

    def _ifexp(self, node: ast.IfExp) -> Read:
        before = len(self.lines)
        found = self._either(node)
        if any("zw_part_" not in line for line in self.lines[before:]):
            raise self.module.outside(
                node, "of two values one is calculated, so neither wants a line of its own"
            )
        return found

    def _either(self, node: ast.IfExp) -> Read:
        a, b = self.read(node.body), self.read(node.orelse)
        of = joined(a.type, b.type)
        if of is None:
            if self.is_last:
                raise self.module.outside(node, f"{ast.unparse(node)} is of two types")
            return Read("0", None)
        return Read(f"({self.truth(node.test)} ? {self.cast(a, of, node)} : {self.cast(b, of, node)})", of)

    def _attribute(self, node: ast.Attribute) -> Read:
        owner = self.read(node.value)
        if isinstance(owner.type, Several) and node.attr in owner.type.names:
            n = owner.type.names.index(node.attr)
            return Read(f"{owner.c}.f{n}", owner.type.items[n])
        if isinstance(owner.type, Cells) and node.attr == "size":
            return Read(f"zw_size({owner.c}.n)", WHOLE)
        if owner.type is None:
            return Read("0", None)
        raise self.module.outside(node, f"{ast.unparse(node)} is not known")

    def _subscript(self, node: ast.Subscript) -> Read:
        if isinstance(node.value, ast.Attribute) and node.value.attr == "shape":
            array, at = self.read(node.value.value), self.module.value(node.slice)
            return Read(f"{array.c}.n[{at}]", WHOLE)
        owner = self.read(node.value)
        if owner.type is None:
            return Read("0", None)
        if isinstance(owner.type, Several):
            at = self.module.value(node.slice)
            if not isinstance(at, int):
                raise self.module.outside(node, "which part of a tuple is taken is written out")
            at %= len(owner.type.items)
            return Read(f"{owner.c}.f{at}", owner.type.items[at])
        if not isinstance(owner.type, Cells):
            raise self.module.outside(node, f"{ast.unparse(node.value)} is no array")
        places = node.slice.elts if isinstance(node.slice, ast.Tuple) else [node.slice]
        name = self._simple(owner)
        if any(isinstance(p, ast.Slice) for p in places):
            return self._part(Read(name, owner.type), places, node)
        at_c = ""
        for k, place in enumerate(places):
            index = self._index(place, name, k)
            at_c = index if not k else f"({at_c}) * {name}.n[{k}] + {index}"
        return Read(f"{name}.p[ZW_AT({at_c}, {name}.n)]", owner.type.of)

    def _index(self, place: ast.expr, array: str, k: int) -> str:
        known = self.module.value(place, self.types)
        if isinstance(known, int) and known < 0:
            return f"({array}.n[{k}] - {-known})"
        return self.cast(self.read(place), WHOLE, place)

    def _part(self, array: Read, places: list[ast.expr], node: ast.expr) -> Read:
        """Rows, a part of the first dimension, or all."""
        assert isinstance(array.type, Cells)
        k = next(k for k, place in enumerate(places) if isinstance(place, ast.Slice))
        fixed, last, rest = places[:k], places[k], places[k + 1 :]
        if not isinstance(last, ast.Slice) or last.step or any(ast.unparse(p) != ":" for p in rest):
            raise self.module.outside(node, "of an array a part is a[i:j], and a row a[i, :]")
        n, at = f"{array.c}.n", "0"
        for m, place in enumerate(fixed):
            at = f"(({at}) * {n}[{m}] + {self._index(place, array.c, m)})"
        first = self._index(last.lower, array.c, k) if last.lower else "0"
        end = self._index(last.upper, array.c, k) if last.upper else f"{n}[{k}]"
        kind = ITEMS[array.type.item][0]
        return Read(f"zw_part_{kind}({array.c}, {k}, {at}, {first}, {end})", array.type)

    def _simple(self, array: Read) -> str:
        """The name of an array, for an expression that needs it more than once."""
        if array.c.isidentifier() or array.c.replace(".", "").isidentifier():
            return array.c
        name = self._fresh()
        assert array.type is not None
        self._say(f"{array.type.c} {name} = {array.c};")
        return name

    def _call(self, node: ast.Call) -> Read:
        name = ast.unparse(node.func)
        if (
            name in ("min", "max", "abs", "int", "float", "bool", "len", "round")
            and self.module.meaning(name) is None
        ):
            return self._builtin(name, node)
        if isinstance(node.func, ast.Attribute) and name.startswith(("np.", "math.")):
            return self._of_library(node.func.attr, node)
        found = self._callee(node.func)
        if isinstance(found, Defined):
            if isinstance(found.node, ast.ClassDef):
                of = self.around.several(fields(found))
                takes = tuple(zip(of.names, of.items, strict=True))
                return Read(
                    f"(({of.c}){{{', '.join(self._given(node, takes, {}, found.module, False))}}})", of
                )
            if is_step_function(found.node):
                to = self.around.signature(found)
                given = self._given(node, to.takes, to.defaults, to.module)
                return Read(f"{to.name}({', '.join(given)})", to.returns)
            raise self.module.outside(node, f"{name} is no step function: decorate it with compiled")
        if isinstance(found, Asked):
            takes = tuple((str(n), of) for n, of in enumerate(found.takes))
            return Read(f"{name}_({', '.join(self._given(node, takes, {}, self.module))})", found.returns)
        if getattr(found, "__name__", "") in _LIBRARY | _ASKED:
            return self._of_library(found.__name__, node)
        if isinstance(node.func, ast.Attribute):
            return self._method(node.func, node)
        raise self.module.outside(node, f"{name} is not known")

    def _callee(self, node: ast.expr) -> Any:
        if isinstance(node, ast.Name):
            asked = self.types.get(node.id)
            return asked if asked is not None else self.module.meaning(node.id)
        if (
            isinstance(node, ast.Attribute)
            and isinstance(node.value, ast.Name)
            and node.value.id not in self.types
        ):
            owner = self.module.meaning(node.value.id)
            return owner.meaning(node.attr) if isinstance(owner, Module) else None
        return None

    def _given(
        self,
        node: ast.Call,
        takes: tuple[tuple[str, Type], ...],
        defaults: dict[str, ast.expr],
        owner: Module,
        by_address: bool = True,
    ) -> list[str]:
        told: dict[str, tuple[Read, ast.expr]] = {}
        flat: list[tuple[Read, ast.expr]] = []
        for argument in node.args:
            if isinstance(argument, ast.Starred):
                whole = self.read(argument.value)
                if isinstance(whole.type, Several):
                    flat += [(Read(f"{whole.c}.f{n}", of), argument) for n, of in enumerate(whole.type.items)]
            else:
                flat.append((self.read(argument), argument))
        told.update({name: value for (name, _), value in zip(takes, flat, strict=False)})
        told.update({k.arg: (self.read(k.value), k.value) for k in node.keywords if k.arg})
        for name, default in defaults.items():
            if name not in told:
                told[name] = (literal(owner.value(default)), node)
        if len(flat) > len(takes) or set(told) != {name for name, _ in takes}:
            raise self.module.outside(
                node, f"{ast.unparse(node.func)} takes {', '.join(n for n, _ in takes)}"
            )
        return [self._argument(*told[name], of, by_address) for name, of in takes]

    def _argument(self, value: Read, node: ast.expr, of: Type, by_address: bool) -> str:
        known = self.module.value(node, self.types) if isinstance(of, Cells) else None
        text = self.around.constants(known).c if isinstance(known, tuple) else self.cast(value, of, node)
        return address(text, of) if by_address else text

    def _builtin(self, name: str, node: ast.Call) -> Read:
        given = [self.read(a) for a in node.args]
        first = given[0]
        if name == "len":
            return Read(f"{first.c}.n[0]", WHOLE)
        if name == "round":
            return Read(f"((int64_t)rint({first.c}))", WHOLE)
        if name in ("int", "float", "bool"):
            of = {"int": WHOLE, "float": REAL, "bool": TRUTH}[name]
            if of == TRUTH:
                return Read(f"((int64_t)({first.c} != 0))", TRUTH)
            return Read(f"(({of.c}){first.c})", of)
        if any(g.type is not None and not isinstance(g.type, Number) for g in given):
            raise self.module.outside(node, f"{ast.unparse(node)} is not of numbers")
        of_all: Type | None = first.type
        for g in given:
            of_all = None if g.type is None else joined(of_all, g.type)
        if name == "abs":
            return Read(f"{'fabs' if of_all == REAL else 'zw_abs'}({first.c})", of_all)
        text = first.c
        for g in given[1:]:
            text = f"zw_{name}_{'real' if of_all == REAL else 'whole'}({text}, {g.c})"
        return Read(text, of_all)

    def _of_library(self, name: str, node: ast.Call) -> Read:
        from_math = not ast.unparse(node.func).startswith("np.")
        if name in _ASKED:
            return Read(f"((int64_t)({_ASKED[name]}({self.read(node.args[0]).c}) != 0))", TRUTH)
        if name in _LIBRARY:
            text = f"{_LIBRARY[name]}({self.read(node.args[0]).c})"
            return (
                Read(f"((int64_t){text})", WHOLE)
                if from_math and name in ("floor", "ceil")
                else Read(text, REAL)
            )
        if name == "radians":
            return Read(f"({self.read(node.args[0]).c} * {literal(0.017453292519943295).c})", REAL)
        if name in ("empty", "zeros", "full", "arange", "empty_like"):
            return self._allocated(name, node)
        raise self.module.outside(node, f"{ast.unparse(node.func)} is outside what is translated")

    def _allocated(self, name: str, node: ast.Call) -> Read:
        """An array that ends with the function."""
        size, *more = node.args
        filling = more.pop(0) if name == "full" else None
        more += [k.value for k in node.keywords if k.arg == "dtype"]
        kind = "real"
        if more:
            kind = ITEMS[ast.unparse(more[0]).removeprefix("np.")][0]
        elif (filling is not None and self.read(filling).type == WHOLE) or name == "arange":
            kind = "whole"
        shape = size.elts if isinstance(size, ast.Tuple) else [size]
        self.owned += 1
        told = ", ".join(self.cast(self.read(part), WHOLE, part) for part in shape)
        item = next(item for item, (own, _) in ITEMS.items() if own == kind)
        array = f"zw_new_{kind}(&own{self.owned}, {len(shape)}, (int64_t[4]){{{told}}})"
        if filling is not None:
            array = f"zw_filled_{kind}({array}, {self.cast(self.read(filling), Cells(item).of, node)})"
        if name == "arange":
            array = f"zw_counted_whole({array})"
        return Read(array, Cells(item))

    def _method(self, function: ast.Attribute, node: ast.Call) -> Read:
        array = self.read(function.value)
        if array.type is None:
            return Read("0", None)
        if not isinstance(array.type, Cells):
            raise self.module.outside(node, f"{ast.unparse(function)} is outside what is translated")
        kind = ITEMS[array.type.item][0]
        if function.attr == "copy":
            self.owned += 1
            return Read(f"zw_copied_{kind}(&own{self.owned}, {array.c})", array.type)
        if function.attr == "max":
            return Read(f"zw_largest_{kind}({array.c})", array.type.of)
        if function.attr == "reshape":
            shape = node.args[0].elts if isinstance(node.args[0], ast.Tuple) else node.args
            told = ", ".join(self.read(part).c for part in shape)
            return Read(f"zw_shaped_{kind}({array.c}, {len(shape)}, (int64_t[4]){{{told}}})", array.type)
        raise self.module.outside(node, f"{ast.unparse(function)} is outside what is translated")


def head_of(signature: Signature) -> str:
    """The first line of a function in C."""
    takes = ", ".join(f"{taken(of)}{name}_{'at' * is_large(of)}" for name, of in signature.takes) or "void"
    return f"static {signature.returns.c} {signature.name}({takes})"


def is_large(of: Type) -> bool:
    """True of what is handed over by its address: by value it would go through memory, word by word."""
    return isinstance(of, Cells) or (isinstance(of, Several) and len(of.items) > 2)


def taken(of: Type) -> str:
    """A parameter's type in C."""
    return f"const {of.c} *" if is_large(of) else f"{of.c} "


def address(text: str, of: Type) -> str:
    """An argument as it is handed over."""
    if not is_large(of):
        return text
    return f"&{text}" if text.replace(".", "").isidentifier() else f"({of.c}[1]){{{text}}}"


def signature_of(of: Defined, name: str) -> Signature:
    """As its annotations say."""
    node, module = of.node, of.module
    assert isinstance(node, ast.FunctionDef)
    given = node.args
    if given.vararg or given.kwarg or given.kwonlyargs or given.posonlyargs:
        raise module.outside(node, "a step function takes its arguments one by one")
    takes = tuple((a.arg, annotated(a.annotation, module)) for a in given.args)
    named = given.args[len(given.args) - len(given.defaults) :]
    if _has_cells(returns := annotated(node.returns, module)):
        raise module.outside(node, "a step function fills in an array that it is given, and returns none")
    defaults = {a.arg: value for a, value in zip(named, given.defaults, strict=True)}
    return Signature(name, takes, returns, defaults, module)


def _has_cells(of: Type) -> bool:
    return isinstance(of, Cells) or (isinstance(of, Several) and any(map(_has_cells, of.items)))


def literal(value: float) -> Read:
    """A number in C, to the last bit."""
    if isinstance(value, bool):
        return Read("INT64_C(1)" if value else "INT64_C(0)", TRUTH)
    if isinstance(value, int):
        return Read(f"INT64_C({value})" if value >= 0 else f"(-INT64_C({-value}))", WHOLE)
    if value != value:
        return Read("((double)NAN)", REAL)
    if value in (float("inf"), float("-inf")):
        return Read("((double)INFINITY)" if value > 0 else "(-(double)INFINITY)", REAL)
    text = float(value).hex()
    return Read(text if not text.startswith("-") else f"(-{text[1:]})", REAL)


def _as_read(target: ast.expr) -> ast.expr:
    """A target as what it holds."""
    if isinstance(target, ast.Name):
        return ast.copy_location(ast.Name(target.id, ast.Load()), target)
    if isinstance(target, ast.Subscript):
        return ast.copy_location(ast.Subscript(target.value, target.slice, ast.Load()), target)
    return target
