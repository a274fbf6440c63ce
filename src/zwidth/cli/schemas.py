"""The JSON Schemas that are shipped with the checker."""

from __future__ import annotations

import json
from importlib.resources import files

from zwidth.errors import InputError
from zwidth.model.specification.table import quoted, suggestion


def schema(kind: str) -> str:
    """What stands in the file of a kind of document, in lines for people."""
    shipped = {
        path.name.removesuffix(".json").replace("-", " "): path
        for path in files("zwidth.checker").joinpath("schemas").iterdir()
    }
    if kind not in shipped:
        raise InputError(f"there is no kind of document {quoted(kind)}; {suggestion(kind, sorted(shipped))}")
    told = json.loads(shipped[kind].read_text(encoding="utf-8"))
    return json.dumps(told, indent=2, ensure_ascii=False)
