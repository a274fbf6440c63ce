"""The text of a step function, read as `zwidth.native` reads it, and what is asked of its statements."""

from __future__ import annotations

import ast
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from zwidth.errors import InputError
from zwidth.native.build import PACKAGE
from zwidth.native.names import Defined, Module, Package

_PACKAGE = Package(PACKAGE)


@cache
def source_of(function: Callable[..., Any]) -> Defined:
    """Where a compiled function, or a plain one, stands."""
    plain = getattr(function, "py_func", function)
    path = Path(plain.__code__.co_filename if hasattr(plain, "__code__") else "")
    if not path.is_file():
        raise InputError(f"{function!r} has no source to be read: it cannot be emitted")
    found = (_PACKAGE.module(plain.__module__) or _alone(path)).meaning(plain.__name__)
    if not isinstance(found, Defined) or not isinstance(found.node, ast.FunctionDef):
        raise InputError(f"{function!r} is no function of its own lines: write it with def")
    return found


@cache
def _alone(path: Path) -> Module:
    """A file that is no part of the package."""
    return Module(Package(path.parent), path.stem, path)


@dataclass
class EndOfLoop(ast.stmt):
    """Where `break` of a loop that is written out goes on."""


@dataclass
class NextPass(ast.stmt):
    """Where `continue` of it goes on; and what the counter then is."""

    target: ast.Name
    value: Any


def behind(todo: list[ast.stmt], whole_loop: bool) -> list[ast.stmt] | None:
    """What follows a `break`, or a `continue`, of a loop that is written out; None of one that is not."""
    end = next((k for k, n in enumerate(todo) if isinstance(n, EndOfLoop)), None)
    if end is None:
        return None
    following = next((k for k, n in enumerate(todo[:end]) if isinstance(n, NextPass)), end)
    return todo[end + 1 :] if whole_loop else todo[following:]


def may_leave(body: Sequence[ast.stmt]) -> bool:
    """Whether a block may return, or leave the loop it is in."""
    return any(_leaves(s) for s in body)


def _leaves(node: ast.stmt) -> bool:
    if isinstance(node, ast.Return | ast.Break | ast.Continue):
        return True
    if isinstance(node, ast.If):
        return may_leave([*node.body, *node.orelse])
    return isinstance(node, ast.For | ast.While) and returns(node.body)


def returns(body: Sequence[ast.stmt]) -> bool:
    """Whether a block may return."""
    return any(isinstance(n, ast.Return) for s in body for n in ast.walk(s))


def assigned(body: Sequence[ast.stmt]) -> list[str]:
    """The names that a block gives values, other than as counters of loops; in their order."""
    counting, names = _targets(body), (n for s in body for n in ast.walk(s) if isinstance(n, ast.Name))
    stored = (n for n in names if isinstance(n.ctx, ast.Store) and n not in counting)
    return list(dict.fromkeys(n.id for n in stored))


def counters(body: Sequence[ast.stmt]) -> list[str]:
    """The counters of the loops in a block that are nothing else there."""
    others = set(assigned(body))
    return [name for name in dict.fromkeys(n.id for n in _targets(body)) if name not in others]


def _targets(body: Sequence[ast.stmt]) -> list[ast.Name]:
    loops = (n for s in body for n in ast.walk(s) if isinstance(n, ast.For))
    return [n.target for n in loops if isinstance(n.target, ast.Name)]
