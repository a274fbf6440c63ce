"""One table decides: what it rules out is no name in the source, and no file."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path

ROOT = Path(__file__).parent.parent
PAGE = ROOT / "CONTRIBUTING.md"


@cache
def ruled_out() -> frozenset[str]:
    """The last column of the table "Words of the source"."""
    table = PAGE.read_text(encoding="utf-8").partition("## Words of the source")[2]
    rows = [line.split("|") for line in table.splitlines() if line.startswith("|")]
    return frozenset(word.strip() for row in rows[2:] for word in row[3].split(","))


def names(path: Path) -> Iterator[str]:
    """Of a file, and of the functions, classes, arguments, variables and attributes that it makes."""
    yield path.stem
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
            yield node.name
        elif isinstance(node, ast.arg):
            yield node.arg
        elif isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
            yield node.id
        elif isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Store):
            yield node.attr


def words(name: str) -> list[str]:
    """Of `value_iteration`, `ValueIteration` and `VALUE_ITERATION` the same."""
    return [word.lower() for word in re.findall(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+", name.strip("_"))]


def test_the_table_is_read():
    """It rules something out, in small letters, and nothing that it asks for."""
    assert len(ruled_out()) > 10
    assert all(re.fullmatch("[a-z_]+", word) for word in ruled_out())
    assert words("_ValueIteration") == words("VALUE_ITERATION") == ["value", "iteration"]


def test_names_are_those_of_the_glossary():
    """Names that Python itself gives, such as `__slots__`, are not ours."""
    single = {word for word in ruled_out() if "_" not in word}
    joined = ruled_out() - single
    where = {name: path for path in sorted((ROOT / "src").rglob("*.py")) for name in names(path)}
    found = [
        f"{path.relative_to(ROOT)}: {name}"
        for name, path in where.items()
        if not (name.startswith("__") and name.endswith("__"))
        if single & set(words(name)) or any(word in "_".join(words(name)) for word in joined)
    ]
    assert not found, f"CONTRIBUTING.md has other words for these: {found}"
