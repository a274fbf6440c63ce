"""No file, and no folder, needs itself through others: at the top, deferred, for types alone, or by name."""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator, Mapping
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

SOURCE = Path(__file__).resolve().parent.parent / "src"

Imports = Mapping[str, set[str]]


def modules() -> dict[str, Path]:
    """Every file of the package by its dotted name; a folder by that of its first page."""
    found = {}
    for path in sorted((SOURCE / "zwidth").rglob("*.py")):
        parts = path.relative_to(SOURCE).with_suffix("").parts
        found[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path
    return found


def imports_of(name: str, text: str, first_page: bool, known: Iterable[str]) -> set[str]:
    """The files of the package that one file takes something from, wherever in it the import stands."""
    found = set()
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.Call) and ast.unparse(node.func).endswith(("import_module", "find_spec")):
            found |= set(_named(node.args[0]))
        elif isinstance(node, ast.ImportFrom):
            above = name.split(".") if first_page else name.split(".")[:-1]
            start = above[: len(above) - node.level + 1] if node.level else []
            base = ".".join([*start, *([node.module] if node.module else [])])
            inside = {f"{base}.{alias.name}" for alias in node.names}
            found |= {one if one in known else base for one in inside}
    return (found & set(known)) - {name}


def _named(given: ast.expr) -> Iterator[str]:
    """The module that a text names, or the folder that it begins with, what follows being computed."""
    start = given.values[0] if isinstance(given, ast.JoinedStr) else given
    if isinstance(start, ast.Constant) and isinstance(start.value, str):
        yield start.value.rstrip(".")


def imports() -> Imports:
    """Of the whole package, with what the stubs name."""
    files = modules()
    found = {}
    for name, path in files.items():
        pages = [page for page in (path, path.with_suffix(".pyi")) if page.exists()]
        text = "\n".join(page.read_text(encoding="utf-8") for page in pages)
        found[name] = imports_of(name, text, path.name == "__init__.py", files)
    return found


def folded(imported: Imports, folder: str) -> Imports:
    """What the files and folders of one folder take from each other."""
    found: dict[str, set[str]] = {}
    for name, others in imported.items():
        if name.startswith(f"{folder}."):
            here = name.removeprefix(f"{folder}.").split(".")[0]
            inside = (other for other in others if other.startswith(f"{folder}."))
            taken = {other.removeprefix(f"{folder}.").split(".")[0] for other in inside}
            found[here] = found.get(here, set()) | taken - {here}
    return found


def circle(graph: Imports) -> list[str]:
    """Names that need themselves through each other, the first again at the end; nothing if none do."""
    try:
        TopologicalSorter(graph).prepare()
    except CycleError as error:
        return list(error.args[1])
    return []


FOLDERS = [name for name, path in modules().items() if path.name == "__init__.py"]


@pytest.fixture(scope="module")
def imported():
    return imports()


@pytest.mark.parametrize("folder", FOLDERS)
def test_no_folder_has_a_circle(folder, imported):
    """Its files and folders can be put into an order in which each needs the ones before it alone."""
    assert circle(folded(imported, folder)) == []


def test_a_circle_would_be_seen():
    """Of two files that name each other, at the top, in a function or by a text, and of two folders."""
    known = ("p.a", "p.b.c", "p.b.d", "p.b")
    graph = {
        "p.a": imports_of("p.a", "from p.b.c import x", False, known),
        "p.b.c": imports_of("p.b.c", "def f():\n    from .d import y", False, known),
        "p.b.d": imports_of("p.b.d", "if T:\n    from p import a", False, known),
        "p.b": imports_of("p.b", "from . import c", True, known),
    }
    assert graph == {"p.a": {"p.b.c"}, "p.b.c": {"p.b.d"}, "p.b.d": {"p.a"}, "p.b": {"p.b.c"}}
    assert sorted(set(circle(folded(graph, "p")))) == ["a", "b"]
    assert circle(folded(graph, "p.b")) == []
    by_name = 'f(import_module("p.b.c"), import_module(f"p.b.{x}"))'
    assert imports_of("p.a", by_name, False, known) == {"p.b.c", "p.b"}
