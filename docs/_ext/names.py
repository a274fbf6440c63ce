"""A block of `{names}` lists what a page documents, a name a line; the docs' build has autodoc write it.

`zwidth.check` stands for what its docstring says; `zwidth.Device.*` for a class with every public member, but
for fields, which stand in its docstring; `zwidth.Pair: replace, margin` for one with these; of a module, for
these.
"""

from __future__ import annotations

import re
from importlib import import_module
from inspect import isclass
from typing import Any

_BLOCK = re.compile(r"^```\{names\}\n(.*?)^```", re.M | re.S)


def documented(line: str) -> str:
    """The directive of autodoc that a line stands for."""
    name, _, members = (part.strip() for part in line.partition(":"))
    bare = name.removesuffix(".*")
    found = _found(bare)
    every = bare != name
    kind = "autoclass" if isclass(found) else "autofunction" if callable(found) else "automodule"
    inside = [found] if isclass(found) else [getattr(found, own.strip(), None) for own in members.split(",")]
    fields = [field for own in inside for field in _fields(own)] if every or kind == "automodule" else []
    told = [f"   :members: {members}"] if members or every else []
    left_out = [f"   :exclude-members: {', '.join(['__new__', *fields])}"] if fields else []
    return "\n".join([f".. {kind}:: {bare}", *told, *left_out])


def _fields(kind: object) -> list[str]:
    """Those of a data class or a named tuple: the docstring of the class lists them."""
    return [*getattr(kind, "__dataclass_fields__", ()), *getattr(kind, "_fields", ())]


def _found(name: str) -> Any:
    """What a dotted name stands for."""
    head, *rest = name.split(".")
    thing = import_module(head)
    for number, part in enumerate(rest):
        try:
            thing = getattr(thing, part)
        except AttributeError:
            thing = import_module(".".join([head, *rest[: number + 1]]))
    return thing


def _read(app: Any, page: str, source: list[str]) -> None:
    def written(block: re.Match[str]) -> str:
        each = "\n\n".join(documented(line) for line in block[1].splitlines() if line.strip())
        return f"```{{eval-rst}}\n{each}\n```"

    source[0] = _BLOCK.sub(written, source[0])


def setup(app: Any) -> dict[str, bool]:
    """Before a page is read."""
    app.connect("source-read", _read)
    return {"parallel_read_safe": True}
