"""What both translators do kind by kind: the one for this machine, and that of `firmware`."""

from __future__ import annotations

import ast
from typing import Any

SPELLED: dict[type[ast.AST], str] = {
    ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/", ast.FloorDiv: "//", ast.Mod: "%",
    ast.Lt: "<", ast.LtE: "<=", ast.Eq: "==", ast.NotEq: "!=", ast.Gt: ">", ast.GtE: ">=",
    ast.LShift: "<<", ast.RShift: ">>", ast.BitAnd: "&", ast.BitOr: "|", ast.BitXor: "^",
}  # fmt: skip
"""The operators as Python writes them, all but // and % as C does."""


def by_kind(owner: object, node: object) -> Any:
    """The method for a kind of node, called as the kind is, `_binop` of an `ast.BinOp`; None without one."""
    return getattr(owner, f"_{type(node).__name__.lower()}", None)
