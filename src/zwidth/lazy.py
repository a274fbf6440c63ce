"""Public names written once, in the stub beside a package: found there when they are first used.

Editors and type checkers read the stub; so does this, so that the list cannot differ from what there is.
Libraries that take their time to load are loaded by whoever uses them.
"""

from __future__ import annotations

import ast
import sys
from collections.abc import Callable, Sequence
from functools import cache
from importlib import import_module
from importlib.machinery import ModuleSpec
from pathlib import Path
from types import ModuleType
from typing import Any, cast

ABOVE: dict[str, str] = {}
"""Rooms that those below ask for and never name, such as "plots": the package says here where they are."""


def above(name: str) -> Any:
    """The room of that name above."""
    return import_module(ABOVE[name])


def attach(package: str) -> tuple[Callable[[str], Any], Callable[[], list[str]], list[str]]:
    """`__getattr__`, `__dir__` and `__all__` of a package, from its `__init__.pyi`.

    Each line of the stub is ``from module import name as name``; or one without ``as``, and below the imports
    ``public_name = name``, for type checkers export no other renaming.  What is no name of the module is a
    module in it.  Lines below an ``if`` are found all the same, and not listed.
    """
    module = sys.modules[package]
    stub = Path(str(module.__file__)).with_suffix(".pyi")
    offered = sorted(dict(_places(stub)))
    places = dict(_places(stub, True))

    def get(name: str) -> Any:
        if name not in places:
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        source, inner = places[name]
        found = import_module(f"{source}.{inner}") if source == package else _found(source, inner)
        if isinstance(found, ModuleType):
            _list_its_own(found)
        setattr(module, name, found)
        return found

    return get, lambda: offered, offered


class PublicRooms:  # `importlib.abc` would load half of the library
    """Rooms that a package offers from a floor below: ``import zwidth.rendering`` is the room itself.

    Parameters
    ----------
    package
        Whose stub says where each of them is.
    """

    def __init__(self, package: str) -> None:
        self.package = package
        stub = Path(str(sys.modules[package].__file__)).with_suffix(".pyi")
        self.places = {name: place for name, place in _places(stub, True) if place[0] != package}

    def find_spec(
        self, name: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """Where the first part after the package is offered, and is a room."""
        package, _, rest = name.partition(".")
        room, _, inner = rest.partition(".") if package == self.package else ("", "", "")
        if room not in self.places or not isinstance(_found(*self.places[room]), ModuleType):
            return None
        from importlib.util import find_spec

        where = ".".join((*self.places[room], *filter(None, [inner])))
        return ModuleSpec(name, cast(Any, self), origin=where) if find_spec(where) else None

    def create_module(self, spec: ModuleSpec) -> ModuleType:
        """The room, whose own specification is kept."""
        room = import_module(str(spec.origin))
        spec.loader_state = room.__spec__
        return room

    def exec_module(self, module: ModuleType) -> None:
        """Nothing: it was run under its own name."""
        assert module.__spec__ is not None
        module.__spec__ = module.__spec__.loader_state


@cache
def _places(stub: Path, all_of_them: bool = False) -> list[tuple[str, tuple[str, str]]]:
    """Of each public name its module, and its name there."""
    lines: list[ast.stmt] = []
    for line in ast.parse(stub.read_text(encoding="utf-8")).body:
        lines += line.body if isinstance(line, ast.If) and all_of_them else [line]
    found = {
        alias.asname or alias.name: (str(line.module), alias.name)
        for line in lines
        if isinstance(line, ast.ImportFrom)
        for alias in line.names
    }
    for line in lines:
        if isinstance(line, ast.Assign) and isinstance(line.value, ast.Name):
            found[ast.unparse(line.targets[0])] = found.pop(line.value.id)
    return list(found.items())


def _list_its_own(room: ModuleType) -> None:
    """Have `dir` say what a room offers, and nothing that it imports: its `__all__`, or what it defines."""
    own = vars(room)
    here = [name for name, value in own.items() if getattr(value, "__module__", "") == room.__name__]
    offered = own.get("__all__") or [name for name in here if name[0] != "_"]
    if offered:
        own.setdefault("__dir__", lambda: offered)


def _found(module: str, name: str) -> Any:
    owner = import_module(module)
    return getattr(owner, name) if hasattr(owner, name) else import_module(f"{module}.{name}")
