"""The types of a step function: numbers, arrays, tuples and named tuples, as its annotations say."""

from __future__ import annotations

import ast
from dataclasses import dataclass, field
from typing import Any, NamedTuple, TypeAlias

from zwidth.native.names import Defined, Expression, Module


@dataclass(frozen=True)
class Number:
    """A double, a whole number of 64 bits, or True and False."""

    kind: str

    @property
    def c(self) -> str:
        return "double" if self.kind == "f" else "int64_t"


REAL, WHOLE, TRUTH = Number("f"), Number("i"), Number("b")


@dataclass(frozen=True)
class Nothing:
    """What a function returns that returns nothing."""

    c = "void"


@dataclass(frozen=True)
class Cells:
    """An array, contiguous, of up to four dimensions."""

    item: str

    @property
    def c(self) -> str:
        return f"zw_{ITEMS[self.item][0]}s"

    @property
    def of(self) -> Number:
        return REAL if self.item == "float64" else WHOLE


ITEMS = {"float64": ("real", "double"), "int64": ("whole", "int64_t"), "uint8": ("byte", "uint8_t")}
"""Of the elements of an array: their name here, and in C."""


@dataclass(frozen=True)
class Several:
    """A tuple; where it is a named one, with the names of its fields."""

    items: tuple[Type, ...]
    names: tuple[str, ...] = ()
    where: str = field(default="", compare=False)
    """Of a named one: module and class."""

    @property
    def c(self) -> str:
        return "zw_" + _spelled(self)


@dataclass(frozen=True)
class Asked:
    """A function that is handed over."""

    takes: tuple[Type, ...]
    returns: Type

    @property
    def c(self) -> str:
        return "zw_" + _spelled(self)


Type: TypeAlias = "Number | Nothing | Cells | Several | Asked"


def _spelled(of: Type) -> str:
    """A name for it in C that two different ones cannot share."""
    if isinstance(of, Number):
        return of.kind
    if isinstance(of, Cells):
        return ITEMS[of.item][0][0].upper()
    if isinstance(of, Several):
        return f"t{len(of.items)}" + "".join(map(_spelled, of.items))
    if isinstance(of, Asked):
        return f"p{len(of.takes)}" + "".join(map(_spelled, (*of.takes, of.returns)))
    return "n"


def joined(a: Type, b: Type) -> Type | None:
    """What can hold both; None if nothing can."""
    if a == b:
        return b
    if isinstance(a, Number) and isinstance(b, Number):
        return REAL if REAL in (a, b) else WHOLE
    return None


_PLAIN: dict[str, Type] = {"float": REAL, "int": WHOLE, "bool": TRUTH}


def annotated(node: ast.expr | None, module: Module) -> Type:
    """What an annotation says."""
    if node is None:
        raise module.outside(ast.Pass(), "a step function says what it takes and returns")
    if isinstance(node, ast.Constant) and node.value is None:
        return Nothing()
    if isinstance(node, ast.Name):
        if node.id in _PLAIN:
            return _PLAIN[node.id]
        found = module.meaning(node.id)
        if isinstance(found, Expression) and found.part is None:
            return annotated(found.node, found.module)
        if isinstance(found, Defined) and isinstance(found.node, ast.ClassDef):
            return fields(found)
    if isinstance(node, ast.Subscript):
        of = ast.unparse(node.value)
        inner = node.slice.elts if isinstance(node.slice, ast.Tuple) else [node.slice]
        if ast.unparse(node) == "tuple[int, ...]":
            return Cells("int64")  # a table that is written out
        if of == "tuple":
            return Several(tuple(annotated(part, module) for part in inner))
        if of == "NDArray" and ast.unparse(node.slice).removeprefix("np.") in ITEMS:
            return Cells(ast.unparse(node.slice).removeprefix("np."))
        if of == "Callable" and len(inner) == 2 and isinstance(inner[0], ast.List):
            takes = tuple(annotated(part, module) for part in inner[0].elts)
            return Asked(takes, annotated(inner[1], module))
    raise module.outside(node, f"a step function cannot take {ast.unparse(node)}")


def fields(of: Defined) -> Several:
    assert isinstance(of.node, ast.ClassDef)
    if [ast.unparse(base) for base in of.node.bases] != ["NamedTuple"]:
        raise of.module.outside(of.node, f"{of.node.name} is no named tuple")
    told = [n for n in of.node.body if isinstance(n, ast.AnnAssign) and isinstance(n.target, ast.Name)]
    names = tuple(n.target.id for n in told if isinstance(n.target, ast.Name))
    where = f"{of.module.name}:{of.node.name}"
    return Several(tuple(annotated(n.annotation, of.module) for n in told), names, where)


def told(of: Type) -> Any:
    """As JSON."""
    if isinstance(of, Number):
        return of.kind
    if isinstance(of, Cells):
        return {"cells": of.item}
    if isinstance(of, Several):
        return {"several": [told(part) for part in of.items], "class": of.where}
    if isinstance(of, Asked):
        return {"asked": [told(part) for part in (*of.takes, of.returns)]}
    return "n"


class Signature(NamedTuple):
    """How a step function is called."""

    name: str
    takes: tuple[tuple[str, Type], ...]
    returns: Type

    def head(self) -> str:
        takes = ", ".join(f"{taken(of)}{name}_{'at' * is_large(of)}" for name, of in self.takes) or "void"
        return f"static {self.returns.c} {self.name}({takes})"


def is_large(of: Type) -> bool:
    """True of what is handed over by its address: by value it would go through memory, word by word."""
    return isinstance(of, Cells) or (isinstance(of, Several) and len(of.items) > 2)


def taken(of: Type) -> str:
    return f"const {of.c} *" if is_large(of) else f"{of.c} "


def address(text: str, of: Type) -> str:
    if not is_large(of):
        return text
    return f"&{text}" if text.replace(".", "").isidentifier() else f"({of.c}[1]){{{text}}}"


def signature_of(of: Defined, name: str) -> Signature:
    """As its annotations say; in C it is called so."""
    node, module, given = of.node, of.module, of.takes()
    assert isinstance(node, ast.FunctionDef)
    takes = tuple((a.arg, annotated(a.annotation, module)) for a in given)
    if _has_cells(returns := annotated(node.returns, module)):
        raise module.outside(node, "a step function fills in an array that it is given, and returns none")
    return Signature(name, takes, returns)


def _has_cells(of: Type) -> bool:
    return isinstance(of, Cells) or (isinstance(of, Several) and any(map(_has_cells, of.items)))
