"""How much of the checker one has to read to trust a kind of document: counted from its imports."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

from zwidth import checker
from zwidth.checker.kinds import KINDS

HOUSE = Path(checker.__file__).parent
SHARED = ("__init__", "__main__", "kinds", "one", "scope", "verdict", "whole")
"""Files that every kind goes through, besides those that they read documents with."""


def files_of(kind: str) -> list[Path]:
    """The files that a kind is checked by, the shared ones among them."""
    registry = ast.parse((HOUSE / "kinds.py").read_text(encoding="utf-8"))
    modules = dict(_imported(registry, HOUSE / "kinds.py"))
    used = {node.id for node in ast.walk(_entry(registry, kind)) if isinstance(node, ast.Name)}
    found: set[Path] = {HOUSE / f"{name}.py" for name in SHARED}
    waiting = [modules[name] for name in used if name in modules]
    waiting += [HOUSE / "document" / f"{name}.py" for name in ("fields", "file")]
    while waiting:
        file = waiting.pop()
        if file not in found:
            found.add(file)
            tree = ast.parse(file.read_text(encoding="utf-8"))
            waiting += [path for _, path in _imported(tree, file)]
    return sorted(found)


def _entry(registry: ast.Module, kind: str) -> ast.expr:
    """What the registry says of a kind."""
    tables = (node.value for node in ast.walk(registry) if isinstance(node, ast.AnnAssign))
    for table in tables:
        if isinstance(table, ast.Dict):
            for key, value in zip(table.keys, table.values, strict=True):
                if isinstance(key, ast.Constant) and key.value == kind:
                    return value
    raise KeyError(kind)


def _imported(tree: ast.Module, file: Path) -> Iterator[tuple[str, Path]]:
    """Names and the files of the checker that they come from; a package's own first page has nothing."""
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and node.level:
            folder = file.parents[node.level - 1]
            for part in (node.module or "").split("."):
                folder = folder / part if part else folder
            for alias in node.names:
                one = folder.with_suffix(".py")
                yield alias.asname or alias.name, one if one.exists() else folder / f"{alias.name}.py"


def lines_in(file: Path) -> int:
    """Lines, blank ones and comments among them."""
    return len(file.read_text(encoding="utf-8").splitlines())


def rows() -> list[tuple[str, str, str, str]]:
    """Kind, files, lines and what they need besides Python, the shortest first."""
    found = []
    for kind in KINDS:
        files = files_of(kind)
        arrays = any(file.parent.name == "storage" for file in files)
        found.append((kind, len(files), sum(map(lines_in, files)), arrays))
    found.sort(key=lambda row: row[2])
    return [
        (f"`{kind}`", str(count), str(lines), "numpy" if arrays else "standard library")
        for kind, count, lines, arrays in found
    ]


def total() -> int:
    """Lines of the whole checker."""
    return sum(map(lines_in, HOUSE.rglob("*.py")))
