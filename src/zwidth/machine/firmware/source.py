"""The text of a step function that is there to be called: read as `zwidth.native` reads it."""

from __future__ import annotations

import ast
from collections.abc import Callable
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
