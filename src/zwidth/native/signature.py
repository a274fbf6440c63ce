"""How a step function is called, as its annotations say."""

from __future__ import annotations

import ast
from typing import NamedTuple

from zwidth.native.names import Defined, Module
from zwidth.native.types import Cells, Several, Type, annotated


class Signature(NamedTuple):
    """How a step function is called."""

    name: str
    takes: tuple[tuple[str, Type], ...]
    returns: Type
    defaults: dict[str, ast.expr]
    module: Module

    def head(self) -> str:
        """The first line of the function in C."""
        takes = ", ".join(f"{taken(of)}{name}_{'at' * is_large(of)}" for name, of in self.takes) or "void"
        return f"static {self.returns.c} {self.name}({takes})"


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
    """As its annotations say; in C it is called so."""
    node, module, given = of.node, of.module, of.takes()
    assert isinstance(node, ast.FunctionDef)
    takes = tuple((a.arg, annotated(a.annotation, module)) for a in given)
    if _has_cells(returns := annotated(node.returns, module)):
        raise module.outside(node, "a step function fills in an array that it is given, and returns none")
    named = given[len(given) - len(node.args.defaults) :]
    defaults = {a.arg: value for a, value in zip(named, node.args.defaults, strict=True)}
    return Signature(name, takes, returns, defaults, module)


def _has_cells(of: Type) -> bool:
    return isinstance(of, Cells) or (isinstance(of, Several) and any(map(_has_cells, of.items)))
