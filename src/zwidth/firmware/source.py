"""The text of a step function, and where in it something stands."""

from __future__ import annotations

import ast
import inspect
import textwrap
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import Any

from zwidth.errors import InputError


@dataclass(frozen=True, eq=False)
class Source:
    """A function of the source.

    Parameters
    ----------
    name
        Its name.
    tree
        What it says.
    known
        The names around it, and what they are.
    file, line
        Where it begins.
    """

    name: str
    tree: ast.FunctionDef
    known: dict[str, Any]
    file: str
    line: int

    @property
    def arguments(self) -> list[str]:
        """Their names, in order."""
        return [a.arg for a in self.tree.args.args]

    def refuse(self, node: ast.AST, what: str) -> InputError:
        """What cannot be emitted, with file and line."""
        line = self.line + getattr(node, "lineno", 1) - 1
        return InputError(
            f"{self.file}:{line}: {what}; what is emitted are numbers, arrays of them, conditions, loops and "
            "functions of the same"
        )


@cache
def source_of(function: Callable[..., Any]) -> Source:
    """The source of a compiled function, or of a plain one.

    Raises
    ------
    InputError
        If it is no function whose source is at hand.
    """
    plain = getattr(function, "py_func", function)
    try:
        lines, line = inspect.getsourcelines(plain)
    except (TypeError, OSError):
        raise InputError(f"{function!r} has no source to be read: it cannot be emitted") from None
    tree = ast.parse(textwrap.dedent("".join(lines))).body[0]
    if not isinstance(tree, ast.FunctionDef):
        raise InputError(f"{function!r} is no function of its own lines: write it with def")
    found = Source(plain.__name__, tree, plain.__globals__, inspect.getsourcefile(plain) or "?", max(line, 1))
    given = tree.args
    if given.vararg or given.kwarg or given.kwonlyargs or given.posonlyargs:
        raise found.refuse(tree, f"{found.name} takes arguments that are not given one by one")
    return found
