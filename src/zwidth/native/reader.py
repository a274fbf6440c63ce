"""What all do alike that read step functions: the translation to C, and `firmware`, which specialises them.

A reader has one method for each kind of node that it understands, called as the kind is: `_binop` reads an
`ast.BinOp`.  What it has none for is outside, with file and line.
"""

from __future__ import annotations

import ast
from typing import Any

from zwidth.native.names import Defined, Module, OutsideError

SPELLED: dict[type[ast.AST], str] = {
    ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/", ast.FloorDiv: "//", ast.Mod: "%",
    ast.Lt: "<", ast.LtE: "<=", ast.Eq: "==", ast.NotEq: "!=", ast.Gt: ">", ast.GtE: ">=",
    ast.LShift: "<<", ast.RShift: ">>", ast.BitAnd: "&", ast.BitOr: "|", ast.BitXor: "^",
}  # fmt: skip
"""The operators as Python writes them, all but // and % as C does."""


def by_kind(owner: object, node: object) -> Any:
    """The method for a kind of node; None if there is none."""
    return getattr(owner, f"_{type(node).__name__.lower()}", None)


class Reader:
    """Reads one function."""

    of: Defined

    @property
    def module(self) -> Module:
        """Where it stands."""
        return self.of.module

    def outside(self, node: ast.AST, what: str) -> OutsideError:
        """What cannot be translated, and where it stands."""
        return self.module.outside(node, what)

    def method(self, node: ast.AST) -> Any:
        """The one that reads a node."""
        found = by_kind(self, node)
        if found is None:
            text = ast.unparse(node).splitlines()[0]
            raise self.outside(node, f"{text} is outside what is translated")
        return found

    def _pass(self, node: ast.Pass) -> None:
        pass


def counted(node: ast.For) -> tuple[ast.expr, ast.expr, ast.expr] | None:
    """Start, stop and step of a loop over a range; None of another."""
    if not isinstance(node.iter, ast.Call) or ast.unparse(node.iter.func) != "range":
        return None
    zero, one = (ast.copy_location(ast.Constant(n), node.iter) for n in (0, 1))
    given = node.iter.args if len(node.iter.args) > 1 else [zero, *node.iter.args]
    start, stop, step = [*given, one][:3]
    return start, stop, step
