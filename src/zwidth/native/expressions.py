"""The expressions of a step function as C, each with its type."""

from __future__ import annotations

import ast
from contextlib import suppress
from typing import Any, NamedTuple, Protocol

from zwidth.native.names import SPELLED, Defined, Module, Reader, is_step_function
from zwidth.native.types import (
    ITEMS,
    REAL,
    TRUTH,
    WHOLE,
    Asked,
    Cells,
    Number,
    Several,
    Signature,
    Type,
    address,
    fields,
    joined,
)


class Read(NamedTuple):
    """An expression in C, and its type."""

    c: str
    type: Type


class NotYet(Exception):
    """A name is read whose type is told further down."""


class Around(Protocol):
    """What a function needs of the translation that it is part of."""

    def signature(self, of: Defined) -> Signature: ...

    def several(self, of: Several) -> Several: ...

    def constants(self, values: tuple[Any, ...]) -> Read: ...


_OF_C = ("ceil", "sqrt", "sin", "cos", "exp", "expm1", "log1p", "log2")
_LIBRARY = {"floor": "zw_floor", **{name: name for name in _OF_C}}
_ASKED = {"isfinite": "isfinite", "isnan": "isnan"}
_BUILTIN = ("min", "max", "abs", "int", "float", "len", "round")


class Expressions(Reader):
    """Reads the expressions of one function."""

    is_last = False
    """False while types are looked for: a type that is not known is then no fault."""

    def __init__(self, around: Around, of: Defined) -> None:
        self.around, self.of = around, of
        self.own = around.signature(of)
        self.types: dict[str, Type] = dict(self.own.takes)
        self.blank()

    def blank(self) -> None:
        self.lines: list[str] = []
        self.depth, self.counted, self.owned = 1, 0, 0

    def say(self, text: str) -> None:
        self.lines.append("  " * self.depth + text)

    def fresh(self) -> str:
        self.counted += 1
        return f"t{self.counted}"

    def cast(self, value: Read, to: Type, node: ast.AST) -> str:
        """A value where another type is wanted that can hold it."""
        if value.type == to:
            return value.c
        if isinstance(value.type, Number) and isinstance(to, Number) and (to != WHOLE or value.type == TRUTH):
            if to == TRUTH:
                raise self.outside(node, "a number stands where True or False is said to")
            return f"(({to.c}){value.c})"
        raise self.outside(node, f"{value.type} stands where {to} is wanted")

    def truth(self, node: ast.expr) -> str:
        """An expression that is asked whether it is so."""
        if isinstance(node, ast.BoolOp):
            joint = " && " if isinstance(node.op, ast.And) else " || "
            return "(" + joint.join(self.truth(v) for v in node.values) + ")"
        if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.Not):
            return f"(!{self.truth(node.operand)})"
        value = self.read(node)
        if not isinstance(value.type, Number):
            raise self.outside(node, f"{ast.unparse(node)} is no condition")
        return f"({value.c} != 0)" if value.type == REAL else value.c

    def read(self, node: ast.expr) -> Read:
        if not isinstance(node, ast.Tuple):
            known = self.module.value(node, self.types)
            if isinstance(known, bool | int | float):
                return literal(known)
        found: Read = self.method(node)(node)
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
            raise self.outside(node, f"{node.id} is not known")
        raise NotYet

    def _tuple(self, node: ast.Tuple) -> Read:
        parts = [self.read(e) for e in node.elts]
        of = self.around.several(Several(tuple(p.type for p in parts)))
        return Read(f"(({of.c}){{{', '.join(p.c for p in parts)}}})", of)

    def _binop(self, node: ast.BinOp) -> Read:
        a, b = self.read(node.left), self.read(node.right)
        for part in (a, b):
            if not isinstance(part.type, Number):
                raise self.outside(node, f"{ast.unparse(node)} calculates with {part.type}")
        if isinstance(node.op, ast.Div):
            return Read(f"((double){a.c} / (double){b.c})", REAL)
        of = REAL if REAL in (a.type, b.type) else WHOLE
        kind = "real" if of == REAL else "whole"
        if isinstance(node.op, ast.FloorDiv | ast.Mod | ast.Pow):
            name = {ast.FloorDiv: "over", ast.Mod: "rest", ast.Pow: "power"}[type(node.op)]
            if name == "power" and kind == "real" and self.module.value(node.right, self.types) != 2:
                raise self.outside(node, "of a real number only the square is taken by **")
            return Read(f"zw_{name}_{kind}({a.c}, {b.c})", of)
        if type(node.op) not in SPELLED:
            raise self.outside(node, f"{ast.unparse(node)} is outside what is translated")
        if isinstance(node.op, ast.Sub) and of == REAL and self.module.value(node.left, self.types) == 0:
            return Read(f"zw_opposite({b.c})", of)
        return Read(f"({a.c} {SPELLED[type(node.op)]} {b.c})", of)

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
                raise self.outside(node, f"{ast.unparse(node)} is outside what is translated")
            if isinstance(operator, ast.In | ast.NotIn):
                known = self.module.value(right, self.types)
                among = right.elts if isinstance(right, ast.Tuple) else [ast.Constant(v) for v in known or ()]
                told = " || ".join(f"({self.read(left).c} == {self.read(a).c})" for a in among)
                parts.append(f"({'!' if isinstance(operator, ast.NotIn) else ''}({told}))")
            else:
                parts.append(f"({self.read(left).c} {SPELLED[type(operator)]} {self.read(right).c})")
            left = right
            if len(node.ops) > 1 and any(isinstance(n, ast.Call) for n in ast.walk(right)):
                raise self.outside(node, "what stands between two comparisons is no call")
        text = " && ".join(parts)
        return Read(f"((int64_t){text if len(parts) == 1 else f'({text})'})", TRUTH)

    def _boolop(self, node: ast.BoolOp) -> Read:
        for value in node.values:
            if self.read(value).type != TRUTH:
                raise self.outside(node, f"{ast.unparse(value)} is neither True nor False")
        return Read(f"((int64_t){self.truth(node)})", TRUTH)

    def _ifexp(self, node: ast.IfExp) -> Read:
        before = len(self.lines)
        arms: list[Read] = []
        for part in (node.body, node.orelse):  # one is enough to tell the type of both for now
            with suppress(NotYet):
                arms.append(self.read(part))
        if not arms:
            raise NotYet
        a, b = arms[0], arms[-1]
        of = joined(a.type, b.type)
        if of is None:
            raise self.outside(node, f"{ast.unparse(node)} is of two types")
        text = f"({self.truth(node.test)} ? {self.cast(a, of, node)} : {self.cast(b, of, node)})"
        if any("zw_part_" not in line for line in self.lines[before:]):
            raise self.outside(node, "of two values one is calculated, so neither wants a line of its own")
        return Read(text, of)

    def _attribute(self, node: ast.Attribute) -> Read:
        owner = self.read(node.value)
        if isinstance(owner.type, Several) and node.attr in owner.type.names:
            n = owner.type.names.index(node.attr)
            return Read(f"{owner.c}.f{n}", owner.type.items[n])
        if isinstance(owner.type, Cells) and node.attr == "size":
            return Read(f"zw_size({owner.c}.n)", WHOLE)
        raise self.outside(node, f"{ast.unparse(node)} is not known")

    def _subscript(self, node: ast.Subscript) -> Read:
        if isinstance(node.value, ast.Attribute) and node.value.attr == "shape":
            array, at = self.read(node.value.value), self.module.value(node.slice)
            return Read(f"{array.c}.n[{at}]", WHOLE)
        owner = self.read(node.value)
        if isinstance(owner.type, Several):
            at = self.module.value(node.slice)
            if not isinstance(at, int):
                raise self.outside(node, "which part of a tuple is taken is written out")
            at %= len(owner.type.items)
            return Read(f"{owner.c}.f{at}", owner.type.items[at])
        if not isinstance(owner.type, Cells):
            raise self.outside(node, f"{ast.unparse(node.value)} is no array")
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
            raise self.outside(node, "of an array a part is a[i:j], and a row a[i, :]")
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
        name = self.fresh()
        self.say(f"{array.type.c} {name} = {array.c};")
        return name

    def _call(self, node: ast.Call) -> Read:
        name = ast.unparse(node.func)
        if name in _BUILTIN and self.module.meaning(name) is None:
            return self._builtin(name, node)
        if isinstance(node.func, ast.Attribute) and name.startswith(("np.", "math.")):
            return self._of_library(node.func.attr, node)
        found = self.callee(node.func)
        if isinstance(found, Defined):
            if isinstance(found.node, ast.ClassDef):
                of = self.around.several(fields(found))
                takes = tuple(zip(of.names, of.items, strict=True))
                given = self._given(node, takes, by_address=False)
                return Read(f"(({of.c}){{{', '.join(given)}}})", of)
            if is_step_function(found.node):
                to = self.around.signature(found)
                return Read(f"{to.name}({', '.join(self._given(node, to.takes))})", to.returns)
            raise self.outside(node, f"{name} is no step function: decorate it with compiled")
        if isinstance(found, Asked):
            takes = tuple((str(n), of) for n, of in enumerate(found.takes))
            return Read(f"{name}_({', '.join(self._given(node, takes))})", found.returns)
        if getattr(found, "__name__", "") in _LIBRARY | _ASKED:
            return self._of_library(found.__name__, node)
        if isinstance(node.func, ast.Attribute):
            return self._method(node.func, node)
        raise self.outside(node, f"{name} is not known")

    def callee(self, node: ast.expr) -> Any:
        """What is called, where that is told by its name."""
        if isinstance(node, ast.Name):
            return self.types.get(node.id) or self.module.meaning(node.id)
        if not isinstance(node, ast.Attribute):
            return None
        owner = self.callee(node.value)
        return owner.meaning(node.attr) if isinstance(owner, Module) else None

    def _given(
        self, node: ast.Call, takes: tuple[tuple[str, Type], ...], by_address: bool = True
    ) -> list[str]:
        told = {name: (self.read(a), a) for (name, _), a in zip(takes, node.args, strict=False)}
        told |= {k.arg: (self.read(k.value), k.value) for k in node.keywords if k.arg}
        if len(node.args) > len(takes) or set(told) != {name for name, _ in takes}:
            raise self.outside(node, f"{ast.unparse(node.func)} takes {', '.join(n for n, _ in takes)}")
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
        if name in ("int", "float"):
            of = {"int": WHOLE, "float": REAL}[name]
            return Read(f"(({of.c}){first.c})", of)
        if not all(isinstance(g.type, Number) for g in given):
            raise self.outside(node, f"{ast.unparse(node)} is not of numbers")
        of_all = first.type
        for g in given[1:]:
            of_all = joined(of_all, g.type) or of_all
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
            is_whole = from_math and name in ("floor", "ceil")
            return Read(f"((int64_t){text})", WHOLE) if is_whole else Read(text, REAL)
        if name == "radians":
            return Read(f"({self.read(node.args[0]).c} * {literal(0.017453292519943295).c})", REAL)
        if name in ("empty", "zeros", "full", "arange", "empty_like"):
            return self._allocated(name, node)
        raise self.outside(node, f"{ast.unparse(node.func)} is outside what is translated")

    def _allocated(self, name: str, node: ast.Call) -> Read:
        """An array that ends with the function."""
        size, *more = node.args
        filling = more.pop(0) if name == "full" else None
        more += [k.value for k in node.keywords if k.arg == "dtype"]
        item = "float64"
        if more:
            item = ast.unparse(more[0]).removeprefix("np.")
        elif (filling is not None and self.read(filling).type == WHOLE) or name == "arange":
            item = "int64"
        kind = ITEMS[item][0]
        shape = size.elts if isinstance(size, ast.Tuple) else [size]
        self.owned += 1
        told = ", ".join(self.cast(self.read(part), WHOLE, part) for part in shape)
        array = f"zw_new_{kind}(&own{self.owned}, {len(shape)}, (int64_t[4]){{{told}}})"
        if filling is not None:
            array = f"zw_filled_{kind}({array}, {self.cast(self.read(filling), Cells(item).of, node)})"
        if name == "arange":
            array = f"zw_counted_whole({array})"
        return Read(array, Cells(item))

    def _method(self, function: ast.Attribute, node: ast.Call) -> Read:
        array = self.read(function.value)
        if not isinstance(array.type, Cells):
            raise self.outside(node, f"{ast.unparse(function)} is outside what is translated")
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
        raise self.outside(node, f"{ast.unparse(function)} is outside what is translated")


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
