"""All step functions of the package as one text in C, and how each is reached from outside."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from itertools import count
from pathlib import Path
from typing import Any

from zwidth.native.expressions import Expressions, NotYet, Read, literal
from zwidth.native.names import Defined, Octets, OutsideError, Package, c_name, counted
from zwidth.native.types import (
    ITEMS,
    REAL,
    WHOLE,
    Asked,
    Cells,
    Nothing,
    Number,
    Several,
    Signature,
    Type,
    address,
    is_large,
    joined,
    signature_of,
    taken,
    told,
)

PRELUDE = Path(__file__).with_name("prelude.c")
BY_HAND = Path(__file__).with_name("system.c")


class Translation:
    """Of the step functions of a package."""

    def __init__(self, root: Path) -> None:
        self.package = Package(root)
        self._signatures: dict[tuple[str, str], Signature] = {}
        self._several: dict[str, Several] = {}
        self._asked: dict[str, Asked] = {}
        self._tables: dict[tuple[Any, ...], str] = {}
        self._by_hand = BY_HAND.read_text(encoding="utf-8")

    def text(self) -> str:
        bodies, faults = list[str](), list[str]()
        own = list(self.package.step_functions())
        for of in own:
            try:
                name = self.signature(of).name
                if f" {name}(" not in self._by_hand:
                    bodies.append(Function(self, of).written())
            except OutsideError as fault:
                faults.append(str(fault))
        if faults:
            raise OutsideError("\n".join(faults))
        heads = [f"{s.head()};" for s in self._signatures.values()]
        own_names = {self.signature(of).name for of in own}
        entries = [_entry(s) for s in self._signatures.values() if s.name in own_names]
        prelude = PRELUDE.read_text(encoding="utf-8")
        before = [prelude, *self._types(), *self._written_tables(), *heads, self._by_hand]
        return "\n".join([*before, *bodies, *entries, ""])

    def table(self) -> dict[str, Any]:
        """What each function takes and returns; after `text`."""
        return {
            s.name: {"takes": [(name, told(of)) for name, of in s.takes], "returns": told(s.returns)}
            for s in self._signatures.values()
        }

    def sources(self) -> list[Path]:
        """The files that the text was made of, those of the translator among them; after `text`."""
        own = (path for path in sorted(PRELUDE.parent.glob("*")) if path.suffix in (".py", ".c"))
        return [*self.package.read(), *own]

    def signature(self, of: Defined) -> Signature:
        key = of.module.name, of.node.name
        if key not in self._signatures:
            found = signature_of(of, c_name(*key))
            for kind in (*(t for _, t in found.takes), found.returns):
                self._declare(kind)
            self._signatures[key] = found
        return self._signatures[key]

    def several(self, of: Several) -> Several:
        self._declare(of)
        return of

    def _declare(self, of: Type) -> None:
        if isinstance(of, Several):
            for part in of.items:
                self._declare(part)
            self._several.setdefault(of.c, of)
        if isinstance(of, Asked):
            self._asked.setdefault(of.c, of)

    def constants(self, values: tuple[Any, ...]) -> Read:
        item = _item(values)
        name = self._tables.setdefault((item, *values), f"zw_table{len(self._tables)}")
        of = Cells(item)
        return Read(f"(({of.c}){{({ITEMS[item][1]} *){name}, {{{len(values)}, 1, 1, 1}}}})", of)

    def _types(self) -> list[str]:
        several = [
            f"typedef struct {{ {' '.join(f'{part.c} f{n};' for n, part in enumerate(of.items))} }} {name};"
            for name, of in self._several.items()
        ]
        asked = [
            f"typedef {of.returns.c} (*{name})({', '.join(map(taken, of.takes))});"
            for name, of in self._asked.items()
        ]
        return several + asked

    def _written_tables(self) -> list[str]:
        tables = []
        for (item, *values), name in self._tables.items():
            numbers = ", ".join(literal(float(v) if item == "float64" else v).c for v in values)
            tables.append(f"static const {ITEMS[item][1]} {name}[] = {{{numbers}}};")
        return tables


def _item(values: tuple[Any, ...]) -> str:
    if isinstance(values, Octets):
        return "uint8"
    return "int64" if all(isinstance(v, int) for v in values) else "float64"


def _entry(signature: Signature) -> str:
    """How it is reached from outside: numbers and arrays in a row of words; what it returns, too."""
    words, back = ((f"w[{k}]" for k in count()) for _ in range(2))
    given = ", ".join(address(_taken(of, words), of) for _, of in signature.takes)
    call = f"{signature.name}({given})"
    lines = [f"ZW_SEEN void zwx_{signature.name}(zw_word *w) {{"]
    if isinstance(signature.returns, Nothing):
        lines.append(f"    (void)w; {call};")
    else:
        lines.append(f"    {signature.returns.c} r = {call};")
        lines += [f"    {text}" for text in _told("r", signature.returns, back)]
    lines.append("}")
    if isinstance(signature.returns, Number) and [of for _, of in signature.takes] == _EXCHANGED:
        lines.append(f"ZW_SEEN void *const zwp_{signature.name} = (void *){signature.name};")
    return "\n".join(lines)


_EXCHANGED = [Cells("float64"), Cells("uint8"), Cells("uint8")]
"""What a function takes that the loop is given: see `servo.connection`."""


def _taken(of: Type, words: Iterator[str]) -> str:
    if isinstance(of, Number):
        return f"{next(words)}.{'f' if of == REAL else 'i'}"
    if isinstance(of, Cells):
        first, n = next(words), ", ".join(f"{next(words)}.i" for _ in range(4))
        return f"({of.c}){{{first}.p, {{{n}}}}}"
    if isinstance(of, Asked):
        return f"({of.c}){next(words)}.p"
    assert isinstance(of, Several)
    return f"({of.c}){{{', '.join(_taken(part, words) for part in of.items)}}}"


def _told(name: str, of: Type, words: Iterator[str]) -> list[str]:
    if isinstance(of, Number):
        return [f"{next(words)}.{'f' if of == REAL else 'i'} = {name};"]
    parts = enumerate(of.items) if isinstance(of, Several) else ()
    return [line for n, part in parts for line in _told(f"{name}.f{n}", part, words)]


# One step function as C: the same operations in the same order, so that it gives the same bits.
#
# What is here, and in `expressions`, is the whole language: numbers, arrays, tuples and named tuples;
# assignments, conditions, loops over ranges and over tuples that are written out, and calls of other step
# functions.  Of an array `a[i]` is a number, `a[i, :]` a row and `a[i:j]` a part, both views.  Everything
# else is outside, with file and line.


class Function(Expressions):
    """Writes one function."""

    def written(self) -> str:
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
        parts = node.iter.elts if isinstance(node.iter, ast.Tuple) else None
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
