"""JSON Schemas of every kind of document, made from what the kinds declare.

    python -m zwidth.checker.schema

writes them anew into the folder `schemas` beside this file, one for each kind.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from .document.fields import LINEAR, MOST_LETTERS, RATIONAL, ROTARY
from .kinds import KINDS, fields_of
from .one import MOST_CORNERS

FOLDER = Path(__file__).with_name("schemas")
CORNERS = "corners"
DIALECT = "https://json-schema.org/draft/2020-12/schema"
MEANT = (
    'Numbers are exact rationals. One may be written as text, "p/q" or a decimal, and its bounds hold then '
    "as well, which this schema cannot say. A whole number may be written as text in the same way. What must "
    "hold between entries is in docs/json.md; the proof itself is checked by zwidth verify."
)
"""What a schema does not say."""


def schema_of(kind: str) -> dict[str, Any]:
    """The schema of documents of a kind, or of corners."""
    defined = {"rational": RATIONAL}
    if kind == CORNERS:
        body = _corners()
        defined |= {inner: _either(inner) for inner in KINDS}
    else:
        body = _either(kind)
    return {"$schema": DIALECT, "title": kind, "description": MEANT, **body, "$defs": defined}


def _either(kind: str) -> dict[str, Any]:
    """Of a device that slides or one that turns, once where the two are the same."""
    linear, rotary = (fields_of(kind).schema(motion) for motion in (LINEAR, ROTARY))
    if linear == rotary:
        return linear
    return {"anyOf": [{"title": LINEAR, **linear}, {"title": ROTARY, **rotary}]}


def _corners() -> dict[str, Any]:
    one = {"anyOf": [{"$ref": f"#/$defs/{kind.replace(' ', '%20')}"} for kind in KINDS]}
    return {
        "type": "object",
        "properties": {
            "format": {"type": "string", "maxLength": MOST_LETTERS},
            "kind": {"enum": [CORNERS]},
            "corners": {"type": "array", "items": one, "minItems": 1, "maxItems": MOST_CORNERS},
        },
        "required": ["kind", "corners"],
        "additionalProperties": False,
    }


def file_of(kind: str) -> str:
    """The name of its file."""
    return f"{kind.replace(' ', '-')}.json"


def text_of(kind: str) -> str:
    """What stands in its file, in one line."""
    return json.dumps(schema_of(kind), ensure_ascii=False) + "\n"


def write(folder: Path = FOLDER) -> None:
    """Write the schemas of all kinds, and remove any other."""
    folder.mkdir(exist_ok=True)
    kinds = [*KINDS, CORNERS]
    for other in {path.name for path in folder.glob("*.json")} - set(map(file_of, kinds)):
        (folder / other).unlink()
    for kind in kinds:
        (folder / file_of(kind)).write_text(text_of(kind), encoding="utf-8", newline="\n")


if __name__ == "__main__":
    write()
